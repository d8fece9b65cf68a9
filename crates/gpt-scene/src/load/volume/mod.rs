//! Files of volumes: OpenVDB, NanoVDB, and Mitsuba's `.vol`. They are told apart by their first bytes.
//!
//! - `open_vdb`: `.vdb`; `nano_vdb`: `.nvdb`; `mitsuba`: `.vol`.
//! - `dense`: from the nodes of a sparse tree to a box of voxels.
//! - `number`: the types of values that files have; `blosc`: one way to compress them; `bytes`: what is read from.
//!
//! Readers look at every number before they use it: a file that ends early or contradicts itself is refused, and memory is taken for values alone
//! that are there.

mod blosc;
mod bytes;
mod dense;
mod mitsuba;
mod nano_vdb;
mod number;
mod open_vdb;

use std::fmt;
use std::sync::Arc;

use glam::DAffine3;

pub use mitsuba::write as write_mitsuba;

use crate::scene::VoxelGrid;
use crate::spectrum::Spectrum;

/// Most bytes of a file of a volume.
pub const MOST_VOLUME_BYTES: u64 = 1 << 33;

/// The grid that is read of a file with several, where none is named: most programs call a medium's density so.
const USUAL_NAME: &str = "density";

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

/// The reason why a file gives no grid.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum VolumeError {
    /// A sentence about what is wrong with the file.
    Unreadable(String),
    /// The name that was asked for, and those that the file has.
    NoSuchGrid { wanted: String, names: Vec<String> },
    /// The names of its grids, none of which was asked for.
    WhichGrid { names: Vec<String> },
}

impl From<String> for VolumeError {
    fn from(sentence: String) -> Self {
        Self::Unreadable(sentence)
    }
}

impl fmt::Display for VolumeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(sentence) => f.write_str(sentence),
            Self::NoSuchGrid { wanted, .. } => write!(f, "it has no grid named `{wanted}`"),
            Self::WhichGrid { names } => write!(f, "it has {} grids, and the key `grid` does not say which", names.len()),
        }
    }
}

/// Reads a grid of a file: the one with this name, or where none is given the only one, or that named `density`. It takes at most `memory` bytes.
///
/// # Errors
/// A file that is none of the formats, that ends early or contradicts itself, that has no such grid or needs more memory, or whose values a [`VoxelGrid`] cannot have.
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

/// The place of the grid to read among the names of a file's.
fn choose(names: &[String], wanted: Option<&str>) -> Result<usize, VolumeError> {
    if names.is_empty() {
        return Err("it has no grids".to_owned().into());
    }
    let named = |wanted: &str| names.iter().position(|name| name == wanted);
    match wanted {
        Some(wanted) => named(wanted).ok_or_else(|| VolumeError::NoSuchGrid { wanted: wanted.to_owned(), names: names.to_vec() }),
        None if names.len() == 1 => Ok(0),
        None => named(USUAL_NAME).ok_or_else(|| VolumeError::WhichGrid { names: names.to_vec() }),
    }
}

/// The complaint about values that no medium has, with what is likely the cause.
fn with_cause(reason: String, is_level_set: bool) -> VolumeError {
    if is_level_set {
        let cause = "its grid is a level set, of distances from a surface, and not a density; the program that made it can turn it into a fog volume";
        return format!("{reason}: {cause}").into();
    }
    reason.into()
}

#[cfg(test)]
mod tests;
