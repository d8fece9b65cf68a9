//! OpenVDB files of versions that no program writes any more, and of trees as small as the format allows.

use flate2::Compression;
use flate2::write::ZlibEncoder;
use glam::DVec3;
use std::io::Write as _;

use super::{read, volume};
use crate::scene::VolumeFilter;

/// How such a file is written.
pub struct Style {
    pub version: u32,
    pub is_zipped: bool,
}

fn text(file: &mut Vec<u8>, text: &str) {
    file.extend((text.len() as u32).to_le_bytes());
    file.extend(text.as_bytes());
}

fn values(file: &mut Vec<u8>, style: &Style, values: &[f32]) {
    if style.version >= 222 {
        file.push(6);
    }
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    if !style.is_zipped {
        file.extend(bytes);
        return;
    }
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(&bytes).expect("writing to memory");
    let zipped = encoder.finish().expect("writing to memory");
    file.extend((zipped.len() as i64).to_le_bytes());
    file.extend(zipped);
}

/// A tree whose root has a child of 2 × 2 × 2 nodes, of which the first is a leaf of as many voxels with the values 1 to 8, and the last an active
/// tile of value 9. Its voxels are of size 2.
pub fn tiny(style: &Style) -> Vec<u8> {
    let mut file = b" BDV\0\0\0\0".to_vec();
    file.extend([style.version, 3, 0].into_iter().flat_map(u32::to_le_bytes));
    file.push(1);
    if style.version < 222 {
        file.push(u8::from(style.is_zipped));
    }
    file.extend([b'0'; 36]);
    file.extend(0_u32.to_le_bytes());
    file.extend(1_u32.to_le_bytes());
    for word in ["density", "Tree_float_1_1", ""] {
        text(&mut file, word);
    }
    let places = file.len();
    file.extend([0; 24]);
    let start = file.len() as u64;
    if style.version >= 222 {
        file.extend(u32::from(style.is_zipped).to_le_bytes());
    }
    file.extend(1_u32.to_le_bytes());
    for word in ["class", "string"] {
        text(&mut file, word);
    }
    text(&mut file, "fog volume");
    text(&mut file, "UniformScaleMap");
    file.extend([2.0_f64; 15].into_iter().flat_map(f64::to_le_bytes));
    // The number of buffers, the background, and the numbers of tiles and children.
    file.extend(1_u32.to_le_bytes());
    file.extend(0.0_f32.to_le_bytes());
    file.extend([0_u32, 1].into_iter().flat_map(u32::to_le_bytes));
    file.extend([0; 12]);
    file.extend([0b0000_0001, 0b1000_0000]);
    let tiles = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 9.0];
    values(&mut file, style, if style.version < 222 { &tiles[1..] } else { &tiles });
    file.push(0xff);
    let blocks = file.len() as u64;
    file.push(0xff);
    if style.version < 222 {
        file.extend([0; 12]);
        file.push(1);
    }
    values(&mut file, style, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
    let end = file.len() as u64;
    file[places..places + 24].copy_from_slice([start, blocks, end].map(u64::to_le_bytes).as_flattened());
    file
}

#[test]
fn old_versions_are_read() {
    for (version, is_zipped) in [(220, false), (220, true), (221, true), (222, false), (223, true), (225, true)] {
        let placed = read(&tiny(&Style { version, is_zipped }), Some("density"));
        let placed = placed.unwrap_or_else(|error| panic!("version {version}: {error}"));
        assert_eq!(placed.grid.resolution(), [6; 3]);
        let volume = volume(placed, VolumeFilter::Nearest);
        let at = |x: f64, y: f64, z: f64| volume.value_at(DVec3::new(x, y, z) * 2.0).r();
        assert_eq!(
            [at(0.0, 0.0, 0.0), at(0.0, 0.0, 1.0), at(0.0, 1.0, 0.0), at(1.0, 0.0, 0.0)],
            [1.0, 2.0, 3.0, 5.0],
            "{version}"
        );
        assert_eq!([at(2.0, 2.0, 2.0), at(3.0, 3.0, 3.0), at(2.0, 0.0, 0.0)], [9.0, 9.0, 0.0], "{version}");
    }
    let error = read(&tiny(&Style { version: 219, is_zipped: false }), None).expect_err("it is too old").to_string();
    assert!(error.contains("219, is too old"), "{error}");
}
