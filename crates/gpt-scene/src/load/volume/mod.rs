//! Files of volumes: OpenVDB, NanoVDB, and Mitsuba's `.vol`. They are told apart by their first bytes.
//!
//! - `open_vdb`: `.vdb`; `nano_vdb`: `.nvdb`; `mitsuba`: `.vol`.
//! - `placed_grid`: what they give; `choice`: which of several grids, and why there is none.
//! - `dense`: from the nodes of a sparse tree to a box of voxels.
//! - `number`: the types of values that files have; `blosc`: one way to compress them; `bytes`: what is read from.
//!
//! Readers look at every number before they use it: a file that ends early or contradicts itself is refused, and memory is taken for values alone
//! that are there.

mod blosc;
mod bytes;
mod choice;
mod dense;
mod mitsuba;
mod nano_vdb;
mod number;
mod open_vdb;
mod placed_grid;

pub use choice::VolumeError;
pub use mitsuba::write as write_mitsuba;
pub use placed_grid::PlacedGrid;

/// Most bytes of a file of a volume.
pub const MOST_VOLUME_BYTES: u64 = 1 << 33;

/// Reads a grid of a file: the one with this name, or where none is given the only one, or that named `density`. It takes at most `memory` bytes.
///
/// # Errors
/// A file that is none of the formats, that ends early or contradicts itself, that has no such grid or needs more memory, or whose values a [`VoxelGrid`](crate::scene::VoxelGrid) cannot have.
pub fn read(content: &[u8], name: Option<&str>, memory: u64) -> Result<PlacedGrid, VolumeError> {
    if open_vdb::is_signature(content) {
        open_vdb::read(content, name, memory)
    } else if nano_vdb::is_signature(content) {
        nano_vdb::read(content, name, memory)
    } else if mitsuba::is_signature(content) {
        mitsuba::read(content, name)
    } else {
        let what = if content.is_empty() { "it is empty" } else { "it does not begin as such a file does" };
        Err(format!("{what}: a volume is read from OpenVDB (.vdb), NanoVDB (.nvdb) and Mitsuba (.vol, version 3)").into())
    }
}

#[cfg(test)]
mod tests;
