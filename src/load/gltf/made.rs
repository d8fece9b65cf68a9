//! What materials and primitives became.

use glam::DAffine2;

use crate::load::import::FileReference;

/// Of a material of a primitive.
#[derive(Debug, Clone)]
pub struct MadeMaterial {
    pub name: String,
    /// The set of texture coordinates that its textures use, and what is done to them.
    pub coordinates: Option<Coordinates>,
}

/// Which texture coordinates, and their map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordinates {
    pub set: u64,
    pub map: DAffine2,
}

/// What a primitive became.
#[derive(Debug, Clone)]
pub struct MadePrimitive {
    pub file: FileReference,
    pub material: String,
    pub smooth: bool,
    pub triangles: u64,
}
