//! Code that importers of other programs' scenes share.
//!
//! An importer turns a file into a [`Description`]: the entries of a scene file with what the import changed or left out. It is resolved like
//! any scene file.

mod attribute;
mod description;
mod enclosures;
pub mod handedness;
mod input;
mod maps;
pub mod measured_media;
mod mesh;
mod relief;
mod triangle_memory;
mod within;

pub use crate::scene::ImportReport;
pub use attribute::Blocks;
pub use description::{Description, mesh_of, pays_as_instances};
pub use enclosures::{Enclosures, Sides};
pub use input::Input;
pub use maps::{camera_at, is_uniform, world_direction};
pub use mesh::{
    barycentric_coordinates, cylinder, disk, grid_sphere, sheet, smooth_by_index, square, turn_inside_out, unit_cube,
};
pub use relief::Relief;
pub use triangle_memory::triangles_fit;

/// Most shapes of a scene, instances counted.
pub const MOST_SHAPES: usize = 1 << 20;
