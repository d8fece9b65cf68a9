//! Code that importers of other programs' scenes share.
//!
//! An importer turns a file into a [`Description`]: the entries of a scene file with what the import changed or left out. It is resolved like
//! any scene file.

mod attribute;
mod description;
mod input;
mod maps;
mod mesh;
mod outline;
mod within;

pub use crate::scene::ImportReport;
pub use attribute::Blocks;
pub use description::{Description, pays_as_instances};
pub use input::Input;
pub use maps::{camera_at, is_uniform, world_direction};
pub use mesh::{cylinder, disk, grid_sphere, smooth_by_index, square, unit_cube};
