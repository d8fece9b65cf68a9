//! Values in space: the density, the albedo or the temperature of a medium that is not the same everywhere.
//!
//! - [`grid`]: the values, a box of voxels.
//! - [`majorant`]: bounds of the values in coarse cells, by which free paths are tracked.
//! - [`crossing`]: the coarse cells that a ray crosses.
//! - [`placed`]: a grid in a medium's space, and how it is looked up.
//!
//! # Index space
//!
//! In index space a voxel is a cube of side 1: voxel `i` reaches from `i` to `i + 1` along each axis, its value stands in the middle, at `i + 0.5`,
//! and a grid of `n` voxels fills the box from 0 to `n`. This is how Mitsuba's `gridvolume` places values in its box, `(i + 0.5) / n` of the way.
//! OpenVDB's and NanoVDB's values stand at whole numbers of their own index space; their readers add the half.
//!
//! Within the box a lookup blends eight values, those of voxels beyond the border being the values at the border. Readers of sparse formats add a
//! border of one voxel with the background's value, so that the blend ends at the background where the box ends, as it does in OpenVDB.
//! Outside of the box there is the value of [`Outside`].

pub mod crossing;
pub mod grid;
pub mod majorant;
pub mod placed;

pub use crossing::{Crossing, Segment};
pub use grid::{VolumeFilter, VoxelGrid};
pub use majorant::Majorants;
pub use placed::{Outside, Volume};

#[cfg(test)]
mod tests;
