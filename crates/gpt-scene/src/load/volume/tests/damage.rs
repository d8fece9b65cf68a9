//! Files that end early or are damaged: each is refused or read, and takes neither long nor much memory.

use std::time::{Duration, Instant};

use super::old_vdb::{Style, tiny};
use super::{DVec3, VoxelGrid, file, read, unpacked, write_mitsuba};

/// Files of all formats and ways to compress, by name.
fn files() -> Vec<(&'static str, Vec<u8>)> {
    let grid = VoxelGrid::new([2, 3, 1], 3, vec![0.5; 18]).expect("a grid");
    vec![
        ("tiny, zip", tiny(&Style { version: 224, is_zipped: true })),
        ("tiny", tiny(&Style { version: 221, is_zipped: false })),
        ("OpenVDB, blosc", file!("scalar.vdb")),
        ("OpenVDB, zip, half", file!("half_zip.vdb")),
        ("NanoVDB, zip", file!("fp8.nvdb")),
        ("NanoVDB, blosc", file!("scalar_blosc.nvdb")),
        ("Mitsuba", write_mitsuba(&grid, DVec3::ZERO, DVec3::ONE)),
    ]
}

#[test]
fn every_file_that_ends_early_is_refused() {
    for (name, content) in files() {
        assert!(read(&content, None).is_ok(), "the control: {name}");
        for length in 0..content.len() {
            assert!(read(&content[..length], None).is_err(), "{name}: its first {length} of {} bytes", content.len());
        }
    }
}

/// A part of a NanoVDB file without compression is long; some of its ends have to do.
#[test]
fn blocks_of_memory_that_end_early_are_refused() {
    let content = file!("scalar_none.nvdb");
    for length in (0..content.len()).step_by(997).chain(content.len() - 40..content.len()) {
        assert!(read(&content[..length], None).is_err(), "its first {length} bytes");
    }
}

#[test]
fn damaged_files_take_neither_long_nor_much_memory() {
    let mut state = 0x9e37_79b9_u32;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state as usize
    };
    for (name, content) in files().into_iter().chain([("NanoVDB", file!("scalar_none.nvdb"))]) {
        for _ in 0..300 {
            let mut damaged = content.clone();
            for _ in 0..1 + next() % 3 {
                // Heads are where most can go wrong.
                let end = if next() % 2 == 0 { damaged.len().min(1500) } else { damaged.len() };
                let place = next() % end;
                damaged[place] = [0, 0xff, 0x7f, 0x80, (next() % 256) as u8][next() % 5];
            }
            let start = Instant::now();
            let result = read(&damaged, None);
            assert!(start.elapsed() < Duration::from_secs(20), "{name}: {:?}", result.map(|placed| placed.grid));
        }
    }
}

/// A block of memory whose nodes refer to nodes that come before or nowhere.
#[test]
fn references_of_nodes_are_checked() {
    let content = file!("scalar_none.nvdb");
    // The head of the file, of the description, and the name.
    let grid = 16 + 176 + "density\0".len();
    assert_eq!(&content[grid..grid + 7], b"NanoVDB");
    let root = grid + 672 + 64;
    let first_tile = root + 64;
    for (place, value) in [
        (grid + 672 + 24, i64::MAX),
        (grid + 672 + 24, i64::MIN),
        (first_tile + 8, i64::MAX),
        (first_tile + 8, -4),
        (first_tile + 8, 1 << 40),
    ] {
        let mut damaged = content.clone();
        damaged[place..place + 8].copy_from_slice(&value.to_le_bytes());
        let error = read(&damaged, None).expect_err("it refers to no node").to_string();
        assert!(!error.is_empty());
    }
    // A child that is its own parent.
    let upper = root as i64 + i64::from_le_bytes(content[first_tile + 8..first_tile + 16].try_into().expect("eight bytes"));
    let mut damaged = content;
    let table = upper as usize + 8256;
    damaged[table..table + 8].copy_from_slice(&0_i64.to_le_bytes());
    let _ = read(&damaged, None);
}
