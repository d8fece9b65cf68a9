//! A grid as a file gives it.

use std::sync::Arc;

use glam::DAffine3;

use crate::scene::VoxelGrid;
use crate::spectrum::Spectrum;

/// A grid of a file, in the place that the file says.
#[derive(Debug, Clone)]
pub struct PlacedGrid {
    /// The values.
    pub grid: Arc<VoxelGrid>,
    /// From the file's space to index space.
    pub to_index: DAffine3,
    /// The value outside of the grid, where the format has one.
    pub background: Option<Spectrum>,
    /// Voxels on each side of the grid that are not the file's own and have the background's value.
    pub border: u32,
}
