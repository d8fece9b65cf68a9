//! Which surface, and what it is part of.

use crate::scene::MaterialId;

/// Which of the world's surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurfaceId {
    /// Place in the hierarchy's leaf order.
    Primitive(usize),
    /// Places in the leaf orders of all instances, and of the group.
    Instanced {
        instance: usize,
        triangle: usize,
    },
    Infinite(usize),
}

/// The origin of a primitive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Owner {
    /// Index into the scene's shapes.
    pub shape: usize,
    /// Face of a mesh, face of a box (−x +x −y +y −z +z); 0 for shapes of one primitive.
    pub part: usize,
    pub material: MaterialId,
}
