use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3, I64Vec3};
use proptest::prelude::*;
use sha2::{Digest, Sha256};

use super::*;
use crate::spectrum::Spectrum;

/// A grid whose values are scattered and partly 0.
fn scattered(resolution: [u32; 3], channels: usize, seed: u32) -> VoxelGrid {
    let count = resolution.iter().product::<u32>() as usize * channels;
    let mut state = seed | 1;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state
    };
    // Neighbours differ by orders of magnitude, so that bounds of one cell do not hold in the next.
    let values = (0..count).map(|_| if next() % 3 == 0 { 0.0 } else { ((next() % 100_000) as f32 * 1e-4).powi(4) }).collect();
    VoxelGrid::new(resolution, channels, values).expect("finite values")
}

fn in_unit_box(grid: VoxelGrid, filter: VolumeFilter) -> Volume {
    Volume { filter, ..Volume::in_box(Arc::new(grid), DVec3::ZERO, DVec3::ONE) }
}

#[test]
fn values_stand_in_the_middle_of_voxels() {
    let grid = scattered([3, 4, 5], 1, 7);
    for filter in [VolumeFilter::Nearest, VolumeFilter::Trilinear] {
        let volume = in_unit_box(grid.clone(), filter);
        for (index, &value) in grid.values().iter().enumerate() {
            let voxel = DVec3::new((index % 3) as f64, (index / 3 % 4) as f64, (index / 12) as f64);
            let point = (voxel + 0.5) / DVec3::new(3.0, 4.0, 5.0);
            approx::assert_abs_diff_eq!(volume.value_at(point).r(), f64::from(value), epsilon = 1e-13);
        }
    }
}

#[test]
fn a_trilinear_lookup_is_exact_for_a_product_of_lines() {
    let value = |at: DVec3| (1.0 + 2.0 * at.x) * (3.0 + at.y) * (5.0 - at.z);
    let middles = (0..64).map(|index| DVec3::new((index % 4) as f64, (index / 4 % 4) as f64, (index / 16) as f64) + 0.5);
    let grid = VoxelGrid::new([4; 3], 1, middles.map(|at| value(at) as f32).collect()).expect("positive values");
    let volume = in_unit_box(grid, VolumeFilter::Trilinear);
    for at in [DVec3::splat(0.5), DVec3::new(1.25, 2.9, 0.75), DVec3::new(3.5, 3.1, 3.4)] {
        approx::assert_relative_eq!(volume.value_at_index(at).g(), value(at), max_relative = 1e-12);
    }
    // Beyond the middle of the last voxel the border's value goes on.
    let at = DVec3::new(3.9, 2.0, 2.0);
    approx::assert_relative_eq!(volume.value_at_index(at).g(), value(at.with_x(3.5)), max_relative = 1e-12);
}

#[test]
fn there_is_one_value_outside_or_that_of_the_border() {
    let grid = VoxelGrid::new([2, 1, 1], 3, vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).expect("two voxels");
    let volume = Volume { scale: 2.0, ..in_unit_box(grid, VolumeFilter::Nearest) };
    let far = DVec3::new(7.0, -3.0, 0.5);
    assert_eq!(volume.value_at(far), Spectrum::BLACK);
    assert_eq!(volume.value_at(DVec3::new(0.9, 0.5, 0.5)), Spectrum::new(8.0, 10.0, 12.0));
    assert_eq!(volume.range(), [0.0, 12.0]);
    let of_border = Volume { outside: Outside::Border, ..volume.clone() };
    assert_eq!(of_border.value_at(far), Spectrum::new(8.0, 10.0, 12.0));
    assert_eq!(of_border.range(), [2.0, 12.0]);
    let constant = Volume { outside: Outside::Constant(Spectrum::grey(0.5)), ..volume };
    assert_eq!(constant.value_at(far), Spectrum::WHITE);
    assert_eq!(constant.range(), [1.0, 12.0]);
}

#[test]
fn grids_of_wrong_values_are_refused() {
    let grid = |resolution, channels, values| VoxelGrid::new(resolution, channels, values).expect_err("it is wrong");
    assert_eq!(grid([2, 1, 2], 1, vec![0.0; 3]), "it has 3 values, and not 2 × 1 × 2 = 4");
    assert_eq!(grid([2, 1, 1], 3, vec![0.0; 5]), "it has 5 values, and not 2 × 1 × 1 × 3 channels = 6");
    assert_eq!(grid([2, 0, 1], 1, vec![]), "it is empty: it has 2 × 0 × 1 voxels");
    assert!(grid([1, 1, 1], 2, vec![0.0; 2]).contains("2 channels"));
    assert_eq!(grid([2, 2, 1], 1, vec![0.0, 1.0, f32::NAN, 1.0]), "the value of voxel [0, 1, 0] is no number (NaN)");
    assert_eq!(grid([1, 1, 2], 1, vec![0.0, -1.5]), "the value of voxel [0, 0, 1] is -1.5, and not a number from 0 to 1e18");
    assert!(grid([1, 1, 1], 1, vec![f32::INFINITY]).contains("inf"));
    let huge = grid([1 << 12, 1 << 12, 1 << 12], 1, vec![]);
    assert!(huge.contains("256 GiB") && huge.contains("4 GiB are the most") && huge.contains("resampled"), "{huge}");
    assert!(grid([u32::MAX; 3], 3, vec![]).contains("the most"));
}

#[test]
fn places_and_factors_are_checked() {
    let volume = in_unit_box(scattered([2; 3], 1, 1), VolumeFilter::Nearest);
    assert_eq!(volume.check(), Ok(()));
    let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
    assert!(Volume { to_index: flat, ..volume.clone() }.check().is_err());
    assert!(Volume { scale: -1.0, ..volume.clone() }.check().is_err());
    assert!(Volume { scale: f64::NAN, ..volume.clone() }.check().is_err());
    assert!(Volume { outside: Outside::Constant(Spectrum::grey(-1.0)), ..volume }.check().is_err());
}

#[test]
fn every_value_counts_in_the_fingerprint() {
    let digest = |resolution, channels, values: &[f32]| {
        let mut hash = Sha256::new();
        VoxelGrid::new(resolution, channels, values.to_vec()).expect("a grid").hash_into(&mut hash);
        hash.finalize()
    };
    let first = digest([3, 1, 1], 1, &[1.0, 2.0, 3.0]);
    assert_eq!(digest([3, 1, 1], 1, &[1.0, 2.0, 3.0]), first);
    let others =
        [digest([3, 1, 1], 1, &[1.0, 2.0, 3.5]), digest([1, 3, 1], 1, &[1.0, 2.0, 3.0]), digest([1, 1, 1], 3, &[1.0, 2.0, 3.0])];
    assert!(others.iter().all(|other| *other != first));
}

#[test]
fn the_box_of_a_grid_is_where_it_was_put() {
    let (low, high) = (DVec3::new(-1.0, 2.0, 3.0), DVec3::new(1.0, 5.0, 3.5));
    let volume = Volume::in_box(Arc::new(scattered([2, 3, 4], 1, 3)), low, high);
    let (corner, edges) = volume.corner_and_edges();
    assert!(corner.abs_diff_eq(low, 1e-12));
    assert!((edges[0] + edges[1] + edges[2]).abs_diff_eq(high - low, 1e-12));
}

#[test]
fn equal_values_have_bounds_without_margin() {
    let grid = VoxelGrid::new([4; 3], 1, vec![0.7; 64]).expect("a grid");
    assert_eq!(Majorants::of(&grid, VolumeFilter::Trilinear, 2).overall(), [0.7; 2]);
}

#[test]
fn a_cell_is_bounded_by_what_its_lookups_blend_and_nothing_else() {
    let mut values = vec![0.0; 8];
    values[5] = 1.0;
    let grid = VoxelGrid::new([8, 1, 1], 1, values).expect("a grid");
    let highest = |filter| {
        let majorants = Majorants::of(&grid, filter, 2);
        (0..4).map(|cell| majorants.of_cell([cell, 0, 0])[1].round()).collect::<Vec<_>>()
    };
    assert_eq!(highest(VolumeFilter::Nearest), [0.0, 0.0, 1.0, 0.0]);
    assert_eq!(highest(VolumeFilter::Trilinear), [0.0, 0.0, 1.0, 1.0]);
}

#[test]
fn a_ray_along_an_axis_crosses_its_row_of_cells() {
    let volume = in_unit_box(scattered([5, 2, 2], 1, 9), VolumeFilter::Nearest);
    let majorants = Majorants::of(&volume.grid, volume.filter, 2);
    let ray = [DVec3::new(-1.0, 0.75, 0.25), DVec3::X];
    let segments: Vec<_> = volume.crossing(&majorants, ray, [0.0, f64::INFINITY]).collect();
    let cells: Vec<_> = segments.iter().map(|segment| segment.cell).collect();
    assert_eq!(cells, [None, Some([0, 0, 0]), Some([1, 0, 0]), Some([2, 0, 0]), None]);
    let ends: Vec<_> = segments.iter().map(|segment| segment.exit).collect();
    for (end, expected) in ends.iter().zip([1.0, 1.4, 1.8, 2.0]) {
        approx::assert_abs_diff_eq!(*end, expected, epsilon = 1e-12);
    }
    assert_eq!(ends[4], f64::INFINITY);
    let [missing] = volume.crossing(&majorants, [ray[0], DVec3::Y], [0.0, 9.0]).collect::<Vec<_>>()[..] else {
        panic!("one segment")
    };
    assert_eq!(missing, Segment { entry: 0.0, exit: 9.0, minimum: 0.0, maximum: 0.0, cell: None });
}

fn vector(range: std::ops::Range<f64>) -> impl Strategy<Value = DVec3> {
    proptest::array::uniform3(range).prop_map(DVec3::from_array)
}

/// Directions of which some run along axes and planes, or nearly so.
fn direction() -> impl Strategy<Value = DVec3> {
    let component = prop_oneof![4 => -1.0..1.0, 1 => Just(0.0), 1 => Just(1e-17), 1 => Just(-1.0)];
    proptest::array::uniform3(component)
        .prop_map(DVec3::from_array)
        .prop_filter("a direction has a length", |direction| direction.length() > 1e-3)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Segments tile the ray's interval, and nowhere in one is a value out of its bounds.
    #[test]
    fn segments_tile_a_ray_and_bound_its_values(
        resolution in proptest::array::uniform3(1_u32..12),
        (channels, side, seed) in (prop_oneof![Just(1_usize), Just(3)], 1_u32..6, any::<u32>()),
        (turn, shift) in (vector(-3.0..3.0), vector(-2.0..2.0)),
        (target, direction, distance) in (vector(-0.1..1.1), direction(), 0.0..3.0),
        (is_trilinear, outside) in (any::<bool>(), prop_oneof![Just(None), Just(Some(0.0)), Just(Some(3.0))]),
        exit in prop_oneof![Just(f64::INFINITY), 0.1..10.0],
    ) {
        let filter = if is_trilinear { VolumeFilter::Trilinear } else { VolumeFilter::Nearest };
        let volume = in_unit_box(scattered(resolution, channels, seed), filter);
        let turn = DAffine3::from_mat3_translation(DMat3::from_quat(DQuat::from_scaled_axis(turn)), shift);
        // The ray passes the target, which is in the box or near it.
        let origin = turn.inverse().transform_point3(target - distance * direction);
        let direction = turn.inverse().transform_vector3(direction);
        let outside = outside.map_or(Outside::Border, |value| Outside::Constant(Spectrum::grey(value)));
        let volume = Volume { to_index: volume.to_index * turn, outside, scale: 1.7, ..volume };
        let majorants = Majorants::of(&volume.grid, filter, side);
        let mut at = 0.0;
        let mut cells = 0;
        for segment in volume.crossing(&majorants, [origin, direction], [0.0, exit]) {
            prop_assert_eq!(segment.entry, at, "a gap");
            prop_assert!(segment.exit > segment.entry);
            prop_assert!(segment.minimum <= segment.maximum);
            at = segment.exit;
            cells += 1;
            let length = (segment.exit - segment.entry).min(10.0);
            for share in [1e-6, 0.1, 0.37, 0.5, 0.9, 1.0 - 1e-6] {
                // A point within rounding of a plane may be looked up on the other side of it.
                if length < 1e-6 {
                    continue;
                }
                let value = volume.value_at(origin + direction * (segment.entry + share * length));
                prop_assert!(value.max_component() <= segment.maximum, "{value:?} at {share} of {segment:?}");
                prop_assert!(value.min_component() >= segment.minimum, "{value:?} at {share} of {segment:?}");
            }
        }
        prop_assert_eq!(at, exit);
        let most: u32 = majorants.resolution().iter().sum::<u32>() + 2;
        prop_assert!(cells <= most, "{cells} segments");
    }
}

/// Blends in single precision exceed what they blend, by rounding; bounds hold all the same.
#[test]
fn bounds_hold_for_blends_in_single_precision() {
    let lerp = |a: f32, b: f32, share: f32| a + (b - a) * share;
    let [mut below, mut above] = [0; 2];
    for seed in 1..2000 {
        let values = scattered([2; 3], 1, seed).values().iter().map(|value| value + 0.001).collect();
        let grid = VoxelGrid::new([2; 3], 1, values).expect("positive values");
        let [low, high] = Majorants::of(&grid, VolumeFilter::Trilinear, 2).overall();
        let corner = |x: i64, y: i64, z: i64| grid.voxel(I64Vec3::new(x, y, z)).r() as f32;
        for corners in 0..8_u8 {
            // A share may round to 1, and each corner then is the result but for rounding.
            let near = |axis: u8| if corners >> axis & 1 == 1 { 1.0_f32 } else { 0.0 };
            let along_x = |y, z| lerp(corner(0, y, z), corner(1, y, z), near(0));
            let along_y = |z| lerp(along_x(0, z), along_x(1, z), near(1));
            let value = lerp(along_y(0), along_y(1), near(2));
            assert!((low..=high).contains(&value), "{value} of {low}..{high}");
            let [smallest, largest] = grid.range();
            below += u32::from(value < smallest);
            above += u32::from(value > largest);
        }
    }
    assert!(below > 0 && above > 0, "the control: {below} blends are below bounds without a margin, and {above} above");
}
