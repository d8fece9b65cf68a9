//! EXT_meshopt_compression: attributes, triangles and indices as meshoptimizer packs them.
//!
//! The formats are those of the extension's specification, appendices A and B. All but what is said to be there is an error.

use super::json::Packed;

/// Unpacks a view. The error is a sentence.
pub fn unpack(packed: &Packed, bytes: &[u8]) -> Result<Vec<u8>, String> {
    let (count, stride) = (packed.count as usize, packed.byte_stride as usize);
    let mut unpacked = match packed.mode.as_str() {
        "ATTRIBUTES" if stride.is_multiple_of(4) && (4..=256).contains(&stride) => attributes(bytes, count, stride)?,
        "TRIANGLES" if count.is_multiple_of(3) => written(&triangles(bytes, count)?, stride)?,
        "INDICES" => written(&indices(bytes, count)?, stride)?,
        mode => return Err(format!("elements of {stride} bytes cannot be in mode {mode}")),
    };
    match packed.filter.as_deref().unwrap_or("NONE") {
        "NONE" => {}
        "OCTAHEDRAL" if stride == 4 => octahedral_8(&mut unpacked),
        "OCTAHEDRAL" if stride == 8 => octahedral_16(&mut unpacked),
        "QUATERNION" if stride == 8 => quaternions(&mut unpacked),
        "EXPONENTIAL" => exponential(&mut unpacked),
        filter => return Err(format!("elements of {stride} bytes cannot be filtered by {filter}")),
    }
    Ok(unpacked)
}

fn ends() -> String {
    "the data end early".to_owned()
}

/// Bytes that are read one after the other.
struct Reader<'b> {
    bytes: &'b [u8],
    at: usize,
}

impl<'b> Reader<'b> {
    fn take(&mut self, count: usize) -> Result<&'b [u8], String> {
        let end = self.at.checked_add(count).filter(|end| *end <= self.bytes.len()).ok_or_else(ends)?;
        let taken = &self.bytes[self.at..end];
        self.at = end;
        Ok(taken)
    }

    fn byte(&mut self) -> Result<u8, String> {
        self.take(1).map(|bytes| bytes[0])
    }

    /// Seven bits a byte, the lowest first.
    fn number(&mut self) -> Result<u32, String> {
        let mut number = 0;
        for shift in [0, 7, 14, 21, 28] {
            let byte = self.byte()?;
            number |= u32::from(byte & 127).wrapping_shl(shift);
            if byte < 128 {
                break;
            }
        }
        Ok(number)
    }

    fn index(&mut self, last: u32) -> Result<u32, String> {
        let number = self.number()?;
        Ok(last.wrapping_add((number >> 1) ^ (number & 1).wrapping_neg()))
    }
}

const GROUP: usize = 16;

/// Appendix A, mode 0. Bytes of one place of all elements stand together, as differences from the element before.
fn attributes(bytes: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, String> {
    let tail = stride.max(32);
    let header = *bytes.first().ok_or_else(ends)?;
    if header != 0xa0 {
        return Err(format!("attributes begin with the byte a0, not {header:02x}"));
    }
    let body_end = bytes.len().checked_sub(tail).filter(|end| *end >= 1).ok_or_else(ends)?;
    let mut reader = Reader { bytes: &bytes[..body_end], at: 1 };
    let mut last = bytes[bytes.len() - stride..].to_vec();
    // Sixty-four elements take a byte for each of theirs at least, so that no file of few bytes takes much memory.
    count.div_ceil(64).checked_mul(stride).filter(|least| *least <= body_end).ok_or_else(ends)?;
    let mut unpacked = vec![0; count * stride];
    let most = ((8192 / stride) & !(GROUP - 1)).min(256);
    for block in unpacked.chunks_mut(most * stride) {
        let elements = block.len() / stride;
        for place in 0..stride {
            let mut value = last[place];
            let groups = elements.div_ceil(GROUP);
            let control = reader.take(groups.div_ceil(4))?;
            for group in 0..groups {
                let bits = (control[group / 4] >> (2 * (group % 4))) & 3;
                let differences = byte_group(&mut reader, bits)?;
                for (offset, difference) in differences.into_iter().enumerate() {
                    let element = group * GROUP + offset;
                    if element < elements {
                        value = value.wrapping_add((difference >> 1) ^ (difference & 1).wrapping_neg());
                        block[element * stride + place] = value;
                    }
                }
            }
            last[place] = value;
        }
    }
    if reader.at == body_end { Ok(unpacked) } else { Err("there are data behind the last element".to_owned()) }
}

/// Sixteen bytes of 0, 2, 4 or 8 bits each; the largest value of few bits says that the byte follows behind.
fn byte_group(reader: &mut Reader, bits: u8) -> Result<[u8; GROUP], String> {
    let mut group = [0; GROUP];
    let width = match bits {
        0 => return Ok(group),
        3 => {
            group.copy_from_slice(reader.take(GROUP)?);
            return Ok(group);
        }
        bits => 2 * usize::from(bits),
    };
    let packed = reader.take(GROUP * width / 8)?;
    let escape = (1_u8 << width) - 1;
    for (index, byte) in group.iter_mut().enumerate() {
        let at = index * width;
        let value = (packed[at / 8] >> (8 - width - at % 8)) & escape;
        *byte = if value == escape { reader.byte()? } else { value };
    }
    Ok(group)
}

/// The last sixteen edges and vertices.
#[derive(Default)]
struct Recent {
    edges: [[u32; 2]; 16],
    edge: usize,
    vertices: [u32; 16],
    vertex: usize,
}

impl Recent {
    fn push_edge(&mut self, a: u32, b: u32) {
        self.edges[self.edge] = [a, b];
        self.edge = (self.edge + 1) & 15;
    }

    fn push_vertex(&mut self, vertex: u32) {
        self.vertices[self.vertex] = vertex;
        self.vertex = (self.vertex + 1) & 15;
    }

    /// 0 is the last one.
    fn edge(&self, back: usize) -> [u32; 2] {
        self.edges[self.edge.wrapping_sub(1 + back) & 15]
    }

    fn vertex(&self, back: usize) -> u32 {
        self.vertices[self.vertex.wrapping_sub(1 + back) & 15]
    }
}

/// The next vertex that was not met before.
fn fresh(next: &mut u32) -> u32 {
    let vertex = *next;
    *next = next.wrapping_add(1);
    vertex
}

/// Appendix A, mode 1: triangles that mostly share an edge with one before.
fn triangles(bytes: &[u8], count: usize) -> Result<Vec<u32>, String> {
    let header = *bytes.first().ok_or_else(ends)?;
    let version = header & 0x0f;
    if header & 0xf0 != 0xe0 || version > 1 {
        return Err(format!("triangles begin with the byte e1, not {header:02x}"));
    }
    let body_end = bytes.len().checked_sub(16).ok_or_else(ends)?;
    let table = &bytes[body_end..];
    let mut reader = Reader { bytes: &bytes[..body_end], at: 1 };
    let codes = reader.take(count / 3)?;
    let nearby = if version == 1 { 13 } else { 15 };
    let mut recent = Recent { edges: [[u32::MAX; 2]; 16], vertices: [u32::MAX; 16], ..Recent::default() };
    let (mut next, mut last) = (0_u32, 0_u32);
    let mut unpacked = Vec::with_capacity(count);
    for &code in codes {
        let (high, low) = (usize::from(code >> 4), usize::from(code & 15));
        if high < 15 {
            let [a, b] = recent.edge(high);
            let c = if low == 0 {
                fresh(&mut next)
            } else if low < nearby {
                recent.vertex(low)
            } else {
                // 13 and 14 are one before and one behind the last.
                last = match low {
                    13 => last.wrapping_sub(1),
                    14 => last.wrapping_add(1),
                    _ => reader.index(last)?,
                };
                last
            };
            unpacked.extend([a, b, c]);
            if low == 0 || low >= nearby {
                recent.push_vertex(c);
            }
            recent.push_edge(c, b);
            recent.push_edge(a, c);
            continue;
        }
        let of_table = low < 14;
        let pair = if of_table { table[low] } else { reader.byte()? };
        let (second, third) = (usize::from(pair >> 4), usize::from(pair & 15));
        if !of_table && pair == 0 {
            next = 0;
        }
        let mut a = if of_table || low == 14 { fresh(&mut next) } else { 0 };
        let corner = |how: usize, next: &mut u32| if how == 0 { fresh(next) } else { recent.vertex(how.wrapping_sub(1)) };
        let mut b = corner(second, &mut next);
        let mut c = corner(third, &mut next);
        if !of_table {
            if low == 15 {
                last = reader.index(last)?;
                a = last;
            }
            if second == 15 {
                last = reader.index(last)?;
                b = last;
            }
            if third == 15 {
                last = reader.index(last)?;
                c = last;
            }
        }
        unpacked.extend([a, b, c]);
        let is_new = |how: usize| how == 0 || (!of_table && how == 15);
        recent.push_vertex(a);
        if is_new(second) {
            recent.push_vertex(b);
        }
        if is_new(third) {
            recent.push_vertex(c);
        }
        recent.push_edge(b, a);
        recent.push_edge(c, b);
        recent.push_edge(a, c);
    }
    if reader.at == body_end { Ok(unpacked) } else { Err("there are data behind the last triangle".to_owned()) }
}

/// Appendix A, mode 2: differences from one of two indices before.
fn indices(bytes: &[u8], count: usize) -> Result<Vec<u32>, String> {
    let header = *bytes.first().ok_or_else(ends)?;
    if header & 0xf0 != 0xd0 || header & 0x0f > 1 {
        return Err(format!("indices begin with the byte d1, not {header:02x}"));
    }
    let body_end = bytes.len().checked_sub(4).ok_or_else(ends)?;
    let mut reader = Reader { bytes: &bytes[..body_end], at: 1.min(body_end) };
    let mut last = [0_u32; 2];
    let mut unpacked = Vec::with_capacity(count.min(bytes.len()));
    for _ in 0..count {
        let number = reader.number()?;
        let of = &mut last[(number & 1) as usize];
        let difference = number >> 1;
        *of = of.wrapping_add((difference >> 1) ^ (difference & 1).wrapping_neg());
        unpacked.push(*of);
    }
    if reader.at == body_end { Ok(unpacked) } else { Err("there are data behind the last index".to_owned()) }
}

/// Indices as integers of two or four bytes.
fn written(indices: &[u32], stride: usize) -> Result<Vec<u8>, String> {
    match stride {
        2 => Ok(indices.iter().flat_map(|index| (*index as u16).to_le_bytes()).collect()),
        4 => Ok(indices.iter().flat_map(|index| index.to_le_bytes()).collect()),
        _ => Err(format!("indices have 2 or 4 bytes, not {stride}")),
    }
}

/// A direction by two coordinates on the octahedron (appendix B): the third one says what stands for 1.
fn octahedral([x, y, one]: [f32; 3], largest: f32) -> [f32; 3] {
    let z = one - x.abs() - y.abs();
    let fold = z.min(0.0);
    let x = x + if x >= 0.0 { fold } else { -fold };
    let y = y + if y >= 0.0 { fold } else { -fold };
    let length = (x * x + y * y + z * z).sqrt();
    let scale = if length > 0.0 { largest / length } else { 0.0 };
    [x, y, z].map(|value| (value * scale).round())
}

fn octahedral_8(bytes: &mut [u8]) {
    for element in bytes.as_chunks_mut::<4>().0 {
        let decoded = octahedral([element[0], element[1], element[2]].map(|byte| f32::from(byte as i8)), 127.0);
        for (byte, value) in element.iter_mut().zip(decoded) {
            *byte = (value as i8) as u8;
        }
    }
}

fn shorts(element: &[u8; 8]) -> [i16; 4] {
    std::array::from_fn(|at| i16::from_le_bytes([element[2 * at], element[2 * at + 1]]))
}

fn octahedral_16(bytes: &mut [u8]) {
    for element in bytes.as_chunks_mut::<8>().0 {
        let [x, y, one, rest] = shorts(element);
        let [x, y, z] = octahedral([x, y, one].map(f32::from), 32_767.0).map(|value| value as i16);
        element.copy_from_slice(&[x, y, z, rest].map(i16::to_le_bytes).concat());
    }
}

/// Rotations without their largest component, whose place is in the last two bits.
fn quaternions(bytes: &mut [u8]) {
    for element in bytes.as_chunks_mut::<8>().0 {
        let stored = shorts(element);
        let scale = std::f32::consts::FRAC_1_SQRT_2 / f32::from(stored[3] | 3);
        let [x, y, z] = [stored[0], stored[1], stored[2]].map(|value| f32::from(value) * scale);
        let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
        let largest = (stored[3] & 3) as usize;
        let mut rotation = [0_i16; 4];
        for (step, value) in [x, y, z, w].into_iter().enumerate() {
            rotation[(largest + 1 + step) % 4] = (value * 32_767.0).round() as i16;
        }
        element.copy_from_slice(&rotation.map(i16::to_le_bytes).concat());
    }
}

/// Mantissas of 24 bits with exponents of 8.
fn exponential(bytes: &mut [u8]) {
    for element in bytes.as_chunks_mut::<4>().0 {
        let stored = i32::from_le_bytes(*element);
        let (mantissa, exponent) = ((stored << 8) >> 8, stored >> 24);
        *element = ((f64::from(mantissa) * 2.0_f64.powi(exponent)) as f32).to_le_bytes();
    }
}

#[cfg(test)]
mod tests;
