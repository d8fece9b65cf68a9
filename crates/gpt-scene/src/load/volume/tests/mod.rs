//! Files in `files/` were made by the formats' own library (`files/make.py`); others are written here, byte by byte.

mod damage;
mod old_vdb;

use std::io::Read as _;

use flate2::read::GzDecoder;
use glam::{DVec3, I64Vec3};

use super::{PlacedGrid, VolumeError, write_mitsuba};
use crate::scene::VoxelGrid;
use crate::scene::{Outside, Volume, VolumeFilter};
use crate::spectrum::Spectrum;

macro_rules! file {
    ($name:literal) => {
        unpacked(include_bytes!(concat!("files/", $name, ".gz")))
    };
}
use file;

fn unpacked(packed: &[u8]) -> Vec<u8> {
    let mut content = Vec::new();
    GzDecoder::new(packed).read_to_end(&mut content).expect("it is packed by gzip");
    content
}

/// Reads a file of few voxels.
fn read(content: &[u8], name: Option<&str>) -> Result<PlacedGrid, VolumeError> {
    super::read(content, name, 1 << 24)
}

const BACKGROUND: f64 = 0.25;

fn is_active([i, j, k]: [i64; 3]) -> bool {
    (i * 3 + j * 5 + k * 11) % 7 < 3
}

fn value([i, j, k]: [i64; 3]) -> f64 {
    ((i * 7 + j * 13 + k * 29) % 32 + 1) as f64 / 16.0
}

/// The value of a voxel of the scalar grid, as `make.py` has it.
fn scalar(at: [i64; 3]) -> f64 {
    let [i, j, k] = at;
    let total = i + j + k;
    let of_parity = |even: f64, odd: f64| if total % 2 == 0 { even } else { odd };
    match i.div_euclid(8) {
        -1 => 0.75,
        5 => value(at),
        0..5 if is_active(at) => value(at),
        0 => BACKGROUND,
        1 => 0.5,
        2 => of_parity(BACKGROUND, 0.5),
        3 => of_parity(0.5, 2.0),
        4 => (total % 5) as f64 / 4.0,
        6 => 1.5,
        _ if at == [60, 4, 4] => 3.0,
        _ => BACKGROUND,
    }
}

/// The grid as a volume of the file's space.
fn volume(placed: PlacedGrid, filter: VolumeFilter) -> Volume {
    let outside = Outside::Constant(placed.background.unwrap_or(Spectrum::BLACK));
    Volume { grid: placed.grid, to_index: placed.to_index, filter, outside, scale: 1.0 }
}

/// Compares every voxel, up to an error for each value.
fn check_scalar(content: &[u8], name: &str, error: f64) {
    let placed = read(content, None).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(placed.grid.resolution(), [69 + 2, 8 + 2, 8 + 2], "{name}");
    assert_eq!(placed.background, Some(Spectrum::grey(BACKGROUND)), "{name}");
    let volume = volume(placed, VolumeFilter::Nearest);
    for i in -8..=60 {
        for (j, k) in (0..8).flat_map(|j| (0..8).map(move |k| (j, k))) {
            let point = DVec3::new(i as f64, j as f64, k as f64) * 0.5 + DVec3::new(1.0, 2.0, 3.0);
            let (found, expected) = (volume.value_at(point).r(), scalar([i, j, k]));
            assert!((found - expected).abs() <= error, "{name}: {found} and not {expected} at {i}, {j}, {k}");
        }
    }
    for at in [DVec3::new(-9.0, 0.0, 0.0), DVec3::new(61.0, 4.0, 4.0), DVec3::new(0.0, 8.0, 0.0), DVec3::new(3.0, 3.0, -1.0)] {
        assert_eq!(volume.value_at(at * 0.5 + DVec3::new(1.0, 2.0, 3.0)).r(), BACKGROUND, "{name}: the border");
    }
}

#[test]
fn every_way_to_compress_gives_the_values() {
    check_scalar(&file!("scalar.vdb"), "blosc", 0.0);
    check_scalar(&file!("scalar_zip.vdb"), "zip", 0.0);
    check_scalar(&file!("scalar_active.vdb"), "active", 0.0);
    check_scalar(&file!("scalar_none.vdb"), "none", 0.0);
    check_scalar(&file!("half.vdb"), "half, blosc", 0.0);
    check_scalar(&file!("half_zip.vdb"), "half, zip", 0.0);
    check_scalar(&file!("scalar.nvdb"), "NanoVDB, zip", 0.0);
    check_scalar(&file!("scalar_none.nvdb"), "NanoVDB", 0.0);
    check_scalar(&file!("scalar_blosc.nvdb"), "NanoVDB, blosc", 0.0);
}

#[test]
fn quantised_values_are_off_by_half_a_step() {
    // Values of a leaf are between 0 and 3.
    let half_a_step = |bits: u32| 3.0 / f64::from((1 << bits) - 1) / 2.0 * 1.001;
    check_scalar(&file!("fp4.nvdb"), "fp4", half_a_step(4));
    check_scalar(&file!("fp8.nvdb"), "fp8", half_a_step(8));
    check_scalar(&file!("fp16.nvdb"), "fp16", half_a_step(16));
    check_scalar(&file!("fpN.nvdb"), "fpN", half_a_step(7));
    let exact = std::panic::catch_unwind(|| check_scalar(&file!("fp4.nvdb"), "fp4", half_a_step(6)));
    assert!(exact.is_err(), "the control: four bits are not six");
}

#[test]
fn vectors_stand_where_their_matrix_puts_them() {
    for (name, content) in [("vdb", file!("vector.vdb")), ("nvdb", file!("vector.nvdb"))] {
        let placed = read(&content, Some("color")).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(placed.grid.channels(), 3);
        let volume = volume(placed, VolumeFilter::Trilinear);
        for at in [[0, 0, 0], [3, 4, 5], [7, 7, 7], [2, 1, 0]] {
            let [i, j, k] = at.map(|index| index as f64);
            let (x, y) = (i - 4.0, j + 8.0);
            let found = volume.value_at(DVec3::new(5.0 - 2.0 * y, 6.0 + 2.0 * x, 7.0 + k));
            let red = value(at);
            let expected = if is_active(at) { Spectrum::new(red, red / 2.0, red + 1.0) } else { Spectrum::BLACK };
            assert_eq!(found, expected, "{name}: {at:?}");
        }
    }
}

/// The value of the trilinear blend that OpenVDB's sampler has there: between the last voxel and the background beyond it.
#[test]
fn a_blend_ends_at_the_background() {
    let volume = volume(read(&file!("scalar.vdb"), None).expect("a grid"), VolumeFilter::Trilinear);
    let at = |i: f64, j: f64, k: f64| volume.value_at(DVec3::new(i, j, k) * 0.5 + DVec3::new(1.0, 2.0, 3.0)).r();
    approx::assert_relative_eq!(at(-8.25, 4.0, 4.0), 0.75 * 0.75 + 0.25 * BACKGROUND, max_relative = 1e-12);
    approx::assert_relative_eq!(at(60.0, 4.25, 4.0), 0.75 * 3.0 + 0.25 * BACKGROUND, max_relative = 1e-12);
    approx::assert_relative_eq!(at(-0.5, 0.0, 0.0), 0.5 * (0.75 + scalar([0, 0, 0])), max_relative = 1e-12);
    assert_eq!(at(-100.0, 4.0, 4.0), BACKGROUND);
}

#[test]
fn one_of_several_grids_is_read_by_its_name() {
    for (name, content) in [("vdb", file!("several.vdb")), ("nvdb", file!("several.nvdb"))] {
        let grid = |wanted| read(&content, wanted).map(|placed| placed.grid);
        let density = grid(None).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(
            (density.resolution(), density.range()),
            ([3; 3], [0.0, 9.0]),
            "{name}: `density` is meant where nothing is said"
        );
        let temperature = grid(Some("temperature")).expect("it is there");
        assert_eq!((temperature.resolution(), temperature.voxel(I64Vec3::ONE)), ([6; 3], Spectrum::grey(1000.0)));
        let Err(VolumeError::NoSuchGrid { wanted, names }) = grid(Some("Density")) else { panic!("there is no such grid") };
        assert_eq!(wanted, "Density");
        assert!(["density", "temperature", "color"].iter().all(|known| names.iter().any(|name| name == known)), "{names:?}");
    }
    let mask = read(&file!("several.vdb"), Some("mask")).expect_err("masks have no values").to_string();
    assert!(mask.contains("`mask` is of type Tree_bool_5_4_3"), "{mask}");
}

#[test]
fn grids_that_no_medium_has_are_refused() {
    let refused = |content: &[u8]| read(content, None).expect_err("it is refused").to_string();
    let level_set = refused(&file!("level_set.vdb"));
    assert!(level_set.contains("level set") && level_set.contains("fog volume"), "{level_set}");
    assert!(refused(&file!("nan.vdb")).contains("NaN"));
    let wide = refused(&file!("wide.vdb"));
    assert!(wide.contains("20003 × 20003 × 20003 voxels") && wide.contains("resampled"), "{wide}");
    let little = super::read(&file!("scalar.vdb"), None, 1 << 10).expect_err("it needs more").to_string();
    assert!(little.contains("memory"), "{little}");
    let little = super::read(&file!("scalar.nvdb"), None, 1 << 10).expect_err("it needs more").to_string();
    assert!(little.contains("memory"), "{little}");
    assert_eq!(refused(&file!("empty.vdb")), "its grid has no active voxels");
    assert!(refused(b"").contains("it is empty"));
    assert!(refused(b"# a scene\n").contains("OpenVDB (.vdb), NanoVDB (.nvdb) and Mitsuba (.vol, version 3)"));
    let mut newer = file!("scalar.vdb");
    newer[8..12].copy_from_slice(&300_u32.to_le_bytes());
    assert!(refused(&newer).contains("300, is too new"));
}

/// Values by Mitsuba 3.9.1: `mi.VolumeGrid(np.arange(24, dtype=float32).reshape(4, 3, 2) / 8)`, written, and looked up by `gridvolume` with
/// `use_grid_bbox`.
#[test]
fn files_of_mitsuba_are_looked_up_as_it_does() {
    let grid = VoxelGrid::new([2, 3, 4], 1, (0..24_u8).map(|value| f32::from(value) / 8.0).collect()).expect("a grid");
    let content = write_mitsuba(&grid, DVec3::ZERO, DVec3::ONE);
    assert_eq!(content[..20], [b'V', b'O', b'L', 3, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0]);
    assert_eq!(content.len(), 48 + 4 * 24);
    let placed = read(&content, None).expect("it was written here");
    assert_eq!((&*placed.grid, placed.background), (&grid, None));
    let volume = |filter| Volume { outside: Outside::Border, ..volume(placed.clone(), filter) };
    let points = [[0.5, 0.5, 0.5], [0.1, 0.9, 0.3], [0.26, 0.4, 0.99], [0.75, 0.2, 0.63], [1.5, 0.5, 0.5]];
    let trilinear = [1.437_499_9, 1.025, 2.427_499_8, 1.664_999_7, 1.499_999_9];
    for (point, expected) in points.into_iter().zip(trilinear) {
        approx::assert_relative_eq!(volume(VolumeFilter::Trilinear).value_at(point.into()).r(), expected, max_relative = 1e-6);
    }
    for (point, expected) in points[1..4].iter().zip([1.25, 2.5, 1.625]) {
        assert_eq!(volume(VolumeFilter::Nearest).value_at((*point).into()).r(), expected);
    }
    let refused = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut content = content.clone();
        change(&mut content);
        read(&content, None).expect_err("it is refused").to_string()
    };
    assert!(refused(&|content| content[3] = 4).contains("version 4; version 3 is read"));
    assert!(refused(&|content| content[4] = 2).contains("encoding 2"));
    assert!(refused(&|content| content[20] = 2).contains("2 channels"));
    assert!(refused(&|content| content[36..40].copy_from_slice(&0.0_f32.to_le_bytes())).contains("bounding box"));
    assert!(read(&content, Some("density")).expect_err("it has no names").to_string().contains("`grid` has to be left out"));
}

#[test]
fn colours_of_mitsuba_come_back() {
    let grid = VoxelGrid::new([1, 2, 1], 3, vec![0.1, 0.2, 0.3, 1.0, 2.0, 3.0]).expect("a grid");
    let placed = read(&write_mitsuba(&grid, DVec3::new(-1.0, -2.0, 0.0), DVec3::new(1.0, 2.0, 4.0)), None).expect("it is read");
    assert_eq!(*placed.grid, grid);
    assert_eq!(volume(placed, VolumeFilter::Nearest).value_at(DVec3::new(0.9, 1.5, 3.0)), Spectrum::new(1.0, 2.0, 3.0));
}
