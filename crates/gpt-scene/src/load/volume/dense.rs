//! From the nodes of a sparse tree to a box of voxels.
//!
//! Trees of OpenVDB and NanoVDB hold values at whole numbers of their index space: leaves with a value for each voxel, and tiles, cubes with one
//! value. Voxels are active or not; the box is that of all active ones, and a border of one voxel around them that has the background's value.

use glam::{DAffine3, DMat3, DVec3};

use super::number::Value;
use super::placed_grid::PlacedGrid;
use crate::scene::VoxelGrid;
use crate::scene::volume::grid::value_count;
use crate::spectrum::Spectrum;

/// An end of a tree.
pub enum Node<L> {
    Tile(Tile),
    Leaf { origin: [i64; 3], content: L },
}

/// A cube of voxels with one value.
pub struct Tile {
    pub origin: [i64; 3],
    pub side: i64,
    pub value: Value,
    pub is_active: bool,
}

/// The least box that has all active voxels, its upper corner being beyond the last ones.
#[derive(Debug, Clone, Copy)]
pub struct ActiveBox {
    low: [i64; 3],
    high: [i64; 3],
}

impl Default for ActiveBox {
    fn default() -> Self {
        Self { low: [i64::MAX; 3], high: [i64::MIN; 3] }
    }
}

impl ActiveBox {
    /// Adds a cube of voxels.
    fn add_cube(&mut self, origin: [i64; 3], side: i64) {
        self.low = std::array::from_fn(|axis| self.low[axis].min(origin[axis]));
        self.high = std::array::from_fn(|axis| self.high[axis].max(origin[axis] + side));
    }

    /// Adds a tile that is active.
    pub fn add_tile(&mut self, tile: &Tile) {
        if tile.is_active {
            self.add_cube(tile.origin, tile.side);
        }
    }

    /// Adds the voxels of a leaf that are active, by the bits of its mask.
    pub fn add_leaf(&mut self, origin: [i64; 3], side: usize, mask: &[u8]) {
        for (index, byte) in mask.iter().enumerate().filter(|(_, byte)| **byte != 0) {
            for bit in (0..8).filter(|bit| byte >> bit & 1 == 1) {
                let [x, y, z] = place_in_node(index * 8 + bit, side);
                self.add_cube([origin[0] + x, origin[1] + y, origin[2] + z], 1);
            }
        }
    }
}

/// The voxel or child of a node with this number: x changes most slowly.
pub fn place_in_node(number: usize, side: usize) -> [i64; 3] {
    [number / (side * side), number / side % side, number % side].map(|index| index as i64)
}

/// Voxels that are being filled in.
pub struct Dense {
    active: ActiveBox,
    resolution: [usize; 3],
    channels: usize,
    values: Vec<f32>,
    background: Value,
}

impl Dense {
    /// A box of voxels with the background's value.
    ///
    /// # Errors
    /// A sentence about a tree without active voxels, or with more than so many bytes of memory hold.
    pub fn new(active: ActiveBox, channels: usize, background: Value, memory: u64) -> Result<Self, String> {
        let ActiveBox { low, high } = active;
        if low > high {
            return Err("its grid has no active voxels".to_owned());
        }
        let resolution: [u64; 3] = std::array::from_fn(|axis| (high[axis] - low[axis] + 2) as u64);
        let count = value_count(resolution, channels).map_err(|reason| format!("as a box of all active voxels, {reason}"))?;
        if count * 4 > memory {
            let [needed, memory] = [count * 4, memory].map(|bytes| bytes >> 20);
            return Err(format!("the box of its active voxels takes {needed} MiB, and there are {memory} MiB of memory for it"));
        }
        let count = count as usize;
        let mut values = Vec::new();
        values.try_reserve_exact(count).map_err(|_| "there is not enough memory for its active voxels".to_owned())?;
        if channels == 1 {
            values.resize(count, background[0]);
        } else {
            values.extend(background.iter().cycle().take(count));
        }
        Ok(Self { active, resolution: resolution.map(|side| side as usize), channels, values, background })
    }

    /// The active box's part of a cube.
    fn part(&self, origin: [i64; 3], side: i64) -> Option<[std::ops::Range<i64>; 3]> {
        let ActiveBox { low, high } = self.active;
        let ranges = std::array::from_fn(|axis| origin[axis].max(low[axis])..(origin[axis] + side).min(high[axis]));
        ranges.iter().all(|range: &std::ops::Range<i64>| range.start < range.end).then_some(ranges)
    }

    /// The first value of a voxel in the active box.
    fn index(&self, [x, y, z]: [i64; 3]) -> usize {
        let low = self.active.low;
        // One voxel of border comes first.
        let [x, y, z] = [x - low[0] + 1, y - low[1] + 1, z - low[2] + 1].map(|index| index as usize);
        ((z * self.resolution[1] + y) * self.resolution[0] + x) * self.channels
    }

    /// Gives all voxels of a tile its value.
    pub fn fill(&mut self, &Tile { origin, side, value, .. }: &Tile) {
        if value == self.background {
            return;
        }
        let Some([x, y, z]) = self.part(origin, side) else { return };
        for z in z {
            for y in y.clone() {
                let (start, end) = (self.index([x.start, y, z]), self.index([x.end, y, z]));
                for voxel in self.values[start..end].chunks_exact_mut(self.channels) {
                    voxel.copy_from_slice(&value[..self.channels]);
                }
            }
        }
    }

    /// Gives the voxels of a leaf their values, of which z changes fastest.
    pub fn set_leaf(&mut self, origin: [i64; 3], side: usize, values: &[Value]) {
        let Some([x, y, z]) = self.part(origin, side as i64) else { return };
        for z in z {
            for y in y.clone() {
                for x in x.clone() {
                    let [i, j, k] = [x - origin[0], y - origin[1], z - origin[2]].map(|index| index as usize);
                    let index = self.index([x, y, z]);
                    self.values[index..index + self.channels]
                        .copy_from_slice(&values[(i * side + j) * side + k][..self.channels]);
                }
            }
        }
    }

    /// The grid, by the map from the tree's index space to the file's space.
    ///
    /// # Errors
    /// A sentence about a map that flattens the grid, and about values that a grid cannot have.
    pub fn into_grid(self, to_space: DAffine3) -> Result<PlacedGrid, String> {
        let to_tree = to_space.inverse();
        if !(to_space.is_finite() && to_tree.is_finite()) {
            return Err("its transform flattens the grid, or is not finite".to_owned());
        }
        let low = DVec3::from_array(self.active.low.map(|index| index as f64));
        // The voxel `low` follows the border, and its middle is half a voxel on.
        let to_index = DAffine3::from_translation(DVec3::splat(1.5) - low) * to_tree;
        let grid = VoxelGrid::new(self.resolution.map(|side| side as u32), self.channels, self.values)?;
        Ok(PlacedGrid { grid: grid.into(), to_index, background: Some(Spectrum::from_f32(self.background)), border: 1 })
    }
}

/// A map whose matrix is given row by row.
pub fn map_of_rows(rows: [f64; 9], translation: [f64; 3]) -> DAffine3 {
    DAffine3 { matrix3: DMat3::from_cols_array(&rows).transpose(), translation: DVec3::from_array(translation) }
}
