//! Streams written by hand after the specification.

use super::*;

fn packed(mode: &str, count: u64, stride: u64, filter: Option<&str>) -> Packed {
    Packed { mode: mode.to_owned(), count, byte_stride: stride, filter: filter.map(str::to_owned), ..Packed::default() }
}

/// Two triangles that share the edge from vertex 2 to vertex 1, as meshoptimizer packs them: one of new vertices by the table of frequent
/// codes, one at the last edge with a new vertex.
fn two_triangles() -> Vec<u8> {
    let mut bytes = vec![0xe1, 0xf0, 0x10];
    bytes.extend([0x00, 0x76, 0x87, 0x56, 0x67, 0x78, 0xa9, 0x86, 0x65, 0x89, 0x68, 0x98, 0x01, 0x69, 0x00, 0x00]);
    bytes
}

#[test]
fn triangles_share_edges_with_those_before() {
    let unpacked = unpack(&packed("TRIANGLES", 6, 2, None), &two_triangles()).unwrap();
    let indices: Vec<u8> = unpacked.iter().step_by(2).copied().collect();
    assert_eq!(indices, [0, 1, 2, 2, 1, 3]);
    let wide = unpack(&packed("TRIANGLES", 6, 4, None), &two_triangles()).unwrap();
    assert_eq!(wide.len(), 24);
}

#[test]
fn attributes_are_differences_in_groups() {
    // Three elements of four bytes: the first and third byte stay, the second grows by 1, the fourth jumps by raw bytes.
    let mut bytes = vec![0xa0];
    bytes.push(0b00);
    bytes.push(0b01);
    // Zigzag of +1 is 2: the pattern 10 in two bits, and 0 for the first element.
    bytes.extend([0b0010_1000, 0, 0, 0]);
    bytes.push(0b00);
    bytes.push(0b11);
    let mut raw = [0_u8; 16];
    raw[..3].copy_from_slice(&[0, 200, 1]);
    bytes.extend(raw);
    // The tail: the element before the first, in the last bytes of 32.
    bytes.extend([0; 28]);
    bytes.extend([7, 10, 9, 50]);
    let unpacked = unpack(&packed("ATTRIBUTES", 3, 4, None), &bytes).unwrap();
    assert_eq!(unpacked, [7, 10, 9, 50, 7, 11, 9, 150, 7, 12, 9, 149]);
}

#[test]
fn escapes_are_followed_by_their_byte() {
    let mut bytes = vec![0xa0, 0b10];
    bytes.extend([0xf2, 0, 0, 0, 0, 0, 0, 0, 40]);
    bytes.extend([0, 0, 0]);
    bytes.extend([0; 32]);
    let unpacked = unpack(&packed("ATTRIBUTES", 2, 4, None), &bytes).unwrap();
    assert_eq!(unpacked, [20, 0, 0, 0, 21, 0, 0, 0]);
}

#[test]
fn indices_follow_one_of_two() {
    // +1 after the first line of indices, +100 after the second one, +1 after the first.
    let mut bytes = vec![0xd1];
    let number = |difference: u32, line: u32| (((difference << 1) << 1) | line) as u16;
    for value in [number(1, 0), number(100, 1), number(1, 0)] {
        if value < 128 { bytes.push(value as u8) } else { bytes.extend([(value & 127) as u8 | 128, (value >> 7) as u8]) }
    }
    bytes.extend([0; 4]);
    let unpacked = unpack(&packed("INDICES", 3, 4, None), &bytes).unwrap();
    let indices: Vec<u32> = unpacked.as_chunks::<4>().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect();
    assert_eq!(indices, [1, 100, 2]);
}

#[test]
fn filters_give_directions_rotations_and_numbers() {
    // Straight along +Z, and folded over to -Z.
    let mut directions = [0, 0, 127, 5, 127, 127, 127, 0].map(|value: i16| value as i8 as u8);
    octahedral_8(&mut directions);
    assert_eq!(directions.map(|byte| byte as i8), [0, 0, 127, 5, 0, 0, -127, 0]);
    let mut rotation: Vec<u8> = [0_i16, 0, 0, 0x7ffc | 3].iter().flat_map(|value| value.to_le_bytes()).collect();
    quaternions(&mut rotation);
    assert_eq!(shorts(rotation.as_chunks::<8>().0.first().unwrap()), [0, 0, 0, 32_767]);
    let mut number = ((-2_i32 << 24) | 3).to_le_bytes().to_vec();
    exponential(&mut number);
    assert_eq!(number, 0.75_f32.to_le_bytes());
}

#[test]
fn whatever_ends_early_is_refused() {
    let whole = two_triangles();
    for length in 0..whole.len() {
        assert!(unpack(&packed("TRIANGLES", 6, 2, None), &whole[..length]).is_err(), "{length}");
    }
    assert!(unpack(&packed("TRIANGLES", 7, 2, None), &whole).is_err());
    assert!(unpack(&packed("ATTRIBUTES", 1 << 40, 4, None), &[0xa0; 64]).is_err());
    assert!(unpack(&packed("INDICES", 1 << 40, 4, None), &[0xd1; 64]).is_err());
}
