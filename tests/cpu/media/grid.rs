//! Integrals along lines through grids, against densities whose integral is known and against adaptive quadrature.

use std::sync::Arc;

use glam::DVec3;
use gpt::scene::volume::{Volume, VolumeFilter, VoxelGrid};

use crate::common::media::grid::{Grid, Interpolation, Outside};
use crate::common::media::quadrature::integrate;
use crate::statistics::random::SplitMix64;

fn grid_of(size: [usize; 3], interpolation: Interpolation, outside: Outside, value: &mut dyn FnMut([f64; 3]) -> f64) -> Grid {
    let mut values = Vec::new();
    for k in 0..size[2] {
        for j in 0..size[1] {
            for i in 0..size[0] {
                values.push(value([i as f64, j as f64, k as f64]));
            }
        }
    }
    Grid { size, values, interpolation, outside }
}

/// A density that is linear along each axis is what trilinear interpolation makes of its values.
#[test]
fn a_product_of_linear_densities_has_the_integral_of_its_polynomial() {
    let density = |[x, y, z]: [f64; 3]| (1.0 + 0.5 * x) * (2.0 - 0.3 * y) * (0.2 + z);
    let grid = grid_of([5, 4, 6], Interpolation::Trilinear, Outside::Clamped, &mut |point| density(point));
    let (origin, direction) = ([0.3, 2.7, 0.1], [0.8, -0.6, 1.1]);
    let range = [0.1, 3.9];
    let exact =
        integrate(&|t| density(std::array::from_fn(|axis| origin[axis] + t * direction[axis])), range[0], range[1], 1e-13);
    let found = grid.integral(origin, direction, range);
    assert!((found - exact).abs() < 1e-12 * exact, "{found} is not {exact}");
}

#[test]
fn nearest_values_are_summed_by_the_length_in_each_cell() {
    let grid = grid_of([3, 1, 1], Interpolation::Nearest, Outside::Zero, &mut |[x, _, _]| 1.0 + x * x);
    // From within the first cell, through the second, to beyond the third.
    let found = grid.integral([0.25, 0.1, -0.2], [1.0, 0.0, 0.0], [0.0, 9.0]);
    assert!((found - (0.25 + 2.0 + 5.0)).abs() < 1e-12, "{found}");
    let clamped = Grid { outside: Outside::Clamped, ..grid };
    let found = clamped.integral([0.25, 0.1, -0.2], [1.0, 0.0, 0.0], [0.0, 9.0]);
    assert!((found - (0.25 + 2.0 + 5.0 * (9.0 - 1.25))).abs() < 1e-12, "{found}");
}

#[test]
fn random_grids_agree_with_adaptive_quadrature() {
    let mut random = SplitMix64::new(7);
    for outside in [Outside::Clamped, Outside::Zero] {
        for interpolation in [Interpolation::Trilinear, Interpolation::Nearest] {
            let grid = grid_of([4, 5, 3], interpolation, outside, &mut |_| random.uniform());
            let (origin, direction) = ([-1.3, 4.2, 0.4], [0.9, -0.7, 0.31]);
            let along = |t: f64| grid.density(std::array::from_fn(|axis| origin[axis] + t * direction[axis]));
            let by_quadrature = integrate(&along, 0.0, 7.0, 1e-9);
            let found = grid.integral(origin, direction, [0.0, 7.0]);
            assert!((found - by_quadrature).abs() < 1e-7, "{interpolation:?}, {outside:?}: {found} is not {by_quadrature}");
            // The control: another value of one voxel on the way is noticed.
            let mut other = grid.clone();
            other.values.iter_mut().for_each(|value| *value *= 1.001);
            assert!((other.integral(origin, direction, [0.0, 7.0]) - by_quadrature).abs() > 1e-4);
        }
    }
}

/// The grids that scenes have are looked up as these are; there, values stand half a voxel farther on.
#[test]
fn volumes_of_scenes_are_looked_up_alike() {
    let mut random = SplitMix64::new(3);
    for (filter, interpolation) in
        [(VolumeFilter::Nearest, Interpolation::Nearest), (VolumeFilter::Trilinear, Interpolation::Trilinear)]
    {
        let grid = grid_of([4, 5, 3], interpolation, Outside::Clamped, &mut |_| f64::from(random.uniform() as f32));
        let values = grid.values.iter().map(|&value| value as f32).collect();
        let voxels = Arc::new(VoxelGrid::new([4, 5, 3], 1, values).expect("there is a value for each voxel"));
        let volume = Volume { filter, ..Volume::in_box(voxels, DVec3::ZERO, DVec3::new(4.0, 5.0, 3.0)) };
        for _ in 0..200 {
            let point = DVec3::new(4.0 * random.uniform(), 5.0 * random.uniform(), 3.0 * random.uniform());
            let (found, expected) = (volume.value_at(point).to_rgb()[0], grid.density((point - 0.5).to_array()));
            assert!((found - expected).abs() < 1e-12, "{filter:?}, {point}: {found} is not {expected}");
        }
    }
}
