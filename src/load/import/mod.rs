//! What importers of other programs' scenes share.
//!
//! An importer turns a file into a [`Description`]: a scene file of ours in the making, with the meshes and pictures that have no file of
//! their own. It is read like any scene file, so what an import shows is what the written scene file shows, bit for bit.

mod attribute;
mod description;
mod keys;
mod mesh;
mod outline;
mod place_file;
mod placed;
mod ply_file;
mod text;
mod within;

pub use crate::scene::ImportReport;
pub use attribute::Blocks;
pub use description::{Description, Entry, HeldContent};
pub use keys::{FileReference, Keys, Value, list};
pub use mesh::{cylinder, disk, grid_sphere, smooth_by_index, square, unit_cube};
pub use place_file::{PLACE_NUMBERS, PlaceFormat, pays_as_instances, place_rows, write_places};
pub use placed::{camera_keys, is_uniform, matrix_of, matrix_value, world_direction};
pub use ply_file::write_ply;
pub use text::{PlacedText, Text};
