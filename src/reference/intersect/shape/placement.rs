//! The placement of a shape.

use glam::{DAffine3, DVec3};

use crate::scene::Shape;

/// A shape, and where it stands.
pub struct Placement<'a> {
    pub shape: &'a Shape,
    pub to_world: DAffine3,
    /// The factor along every axis of a round shape; 1 for others.
    pub scale: f64,
}

impl<'a> Placement<'a> {
    /// The scene has been validated: what is round is scaled evenly.
    pub fn new(shape: &'a Shape) -> Self {
        let scale = shape.transform.uniform_scale().unwrap_or(1.0);
        Self { shape, to_world: shape.transform.to_affine(), scale }
    }

    /// A normal of the shape in the world: by the inverse transpose, so that it stays perpendicular and on its side.
    pub fn normal(&self, normal: DVec3) -> DVec3 {
        (self.to_world.matrix3.inverse().transpose() * normal).normalize()
    }
}
