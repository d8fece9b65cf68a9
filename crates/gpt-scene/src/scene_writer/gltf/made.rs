//! Materials and meshes that are written.

use crate::scene::{MaterialId, TextureId};

/// A material of the file.
#[derive(Debug, Clone)]
pub struct Made {
    pub index: usize,
    /// The texture of colours of vertices by which its base colour is multiplied.
    pub paint: Option<TextureId>,
    /// The vertices' alpha multiplies its opacity.
    pub paints_alpha: bool,
    /// The sets of texture coordinates that it uses.
    pub uses_sets: [bool; 2],
    /// Its microfacets are wider in a direction, or its coat is bent along one, that no normal map says.
    pub needs_tangents: bool,
}

/// The properties that tell meshes apart: those of a shape, or of a group with a material in place of its own ones.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum MeshKey {
    /// The address of a mesh in memory, and the shape's material.
    Shared(usize, MaterialId),
    Group(usize, Option<MaterialId>),
}
