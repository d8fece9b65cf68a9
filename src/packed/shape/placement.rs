//! The transform of a shape, and the facts on which its packing depends.

use glam::{DAffine3, DVec3};

use crate::scene::Shape;

pub struct Placement<'a> {
    pub shape: &'a Shape,
    pub to_world: DAffine3,
    /// By material: it depends on texture coordinates.
    pub textured: &'a [bool],
}

impl<'a> Placement<'a> {
    pub fn new(shape: &'a Shape, textured: &'a [bool]) -> Self {
        Self { shape, to_world: shape.transform.to_affine(), textured }
    }

    pub fn point(&self, point: DVec3) -> DVec3 {
        self.to_world.transform_point3(point)
    }

    pub fn vector(&self, vector: DVec3) -> DVec3 {
        self.to_world.transform_vector3(vector)
    }

    pub fn normal(&self, normal: DVec3) -> DVec3 {
        (self.to_world.matrix3.inverse().transpose() * normal).normalize()
    }

    /// The factor along every axis of a round shape, which is scaled evenly.
    pub fn scale(&self) -> f64 {
        self.to_world.matrix3.determinant().abs().cbrt()
    }

    /// The material of a face depends on texture coordinates.
    pub fn is_textured(&self, face: usize) -> bool {
        self.textured[self.shape.face_material(face)]
    }
}
