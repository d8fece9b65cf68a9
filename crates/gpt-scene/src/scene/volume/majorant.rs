//! Bounds of a grid's values in coarse cells.
//!
//! Cell `c` is the part of index space from `c * s` to `(c + 1) * s` along each axis, where `s` is the side of a cell in voxels; the last one ends
//! where the grid ends. Trilinear lookups in it blend the values of voxels `c * s - 1` to `(c + 1) * s`, one more at either end than the cell has;
//! nearest ones find the values of its own. The bounds are those of all these voxels and of all channels.

use rayon::prelude::*;

use super::grid::{VolumeFilter, VoxelGrid};

/// A blend in single precision may be off by some nine rounding errors (2⁻²⁴ each) of the largest value that it blends, and so be outside of these
/// values. Bounds of cells whose values differ are wider by this share of the largest one, so that no lookup is outside of them on any device;
/// equal values are blended exactly.
const ROUNDING: f64 = 1.0 / (1 << 20) as f64;

/// The smallest and the largest value in each coarse cell of a grid, before they are scaled.
#[derive(Debug, Clone, PartialEq)]
pub struct Majorants {
    side: u32,
    resolution: [u32; 3],
    bounds: Vec<[f32; 2]>,
    overall: [f32; 2],
}

impl Majorants {
    /// The bounds in cells of `side` voxels along each axis, for lookups by this filter.
    ///
    /// # Panics
    /// A side of 0.
    pub fn of(grid: &VoxelGrid, filter: VolumeFilter, side: u32) -> Self {
        assert!(side > 0, "a cell has at least one voxel");
        let resolution = grid.resolution().map(|voxels| voxels.div_ceil(side));
        let [columns, rows, _] = resolution.map(|cells| cells as usize);
        let bounds = |index: usize| {
            let cell = [index % columns, index / columns % rows, index / columns / rows].map(|cell| cell as u32);
            bounds_of_cell(grid, filter, side, cell)
        };
        let count = resolution.iter().map(|&cells| cells as usize).product();
        let bounds: Vec<[f32; 2]> = (0..count).into_par_iter().map(bounds).collect();
        let [low, high] = [0, 1].map(|end| bounds.iter().map(move |bounds| bounds[end]));
        let overall = [low.fold(f32::INFINITY, f32::min), high.fold(0.0, f32::max)];
        Self { side, resolution, bounds, overall }
    }

    /// Side of a cell in voxels.
    pub fn side(&self) -> u32 {
        self.side
    }

    /// Cells along x, y and z.
    pub fn resolution(&self) -> [u32; 3] {
        self.resolution
    }

    /// The smallest and the largest value of each cell; x grows fastest, then y, then z.
    pub fn bounds(&self) -> &[[f32; 2]] {
        &self.bounds
    }

    /// The bounds of one cell.
    pub fn of_cell(&self, [x, y, z]: [u32; 3]) -> [f32; 2] {
        let [columns, rows, _] = self.resolution.map(|cells| cells as usize);
        self.bounds[(z as usize * rows + y as usize) * columns + x as usize]
    }

    /// The bounds of all cells.
    pub fn overall(&self) -> [f32; 2] {
        self.overall
    }
}

/// The smallest and the largest value that lookups in a cell find.
fn bounds_of_cell(grid: &VoxelGrid, filter: VolumeFilter, side: u32, cell: [u32; 3]) -> [f32; 2] {
    let reach = match filter {
        VolumeFilter::Nearest => 0,
        VolumeFilter::Trilinear => 1,
    };
    let ranges: [_; 3] = std::array::from_fn(|axis| {
        let (voxels, low) = (grid.resolution()[axis] as usize, cell[axis] as usize * side as usize);
        low.saturating_sub(reach)..(low + side as usize + reach).min(voxels)
    });
    let [x, y, z] = ranges;
    let [columns, rows, _] = grid.resolution().map(|voxels| voxels as usize);
    let channels = grid.channels();
    let [mut low, mut high] = [f32::INFINITY, 0.0_f32];
    for z in z {
        for y in y.clone() {
            let row = (z * rows + y) * columns;
            for &value in &grid.values()[(row + x.start) * channels..(row + x.end) * channels] {
                low = low.min(value);
                high = high.max(value);
            }
        }
    }
    if low == high || filter == VolumeFilter::Nearest {
        return [low, high];
    }
    let margin = f64::from(high) * ROUNDING;
    let (lower, higher) = ((f64::from(low) - margin) as f32, (f64::from(high) + margin) as f32);
    // Next to 0 the margin may round to nothing.
    [lower.min(low.next_down()).max(0.0), higher.max(high.next_up())]
}
