//! Shapes to primitives in world space, in the order in which the scene names them.

use std::collections::BTreeSet;

use glam::{Vec2, Vec3};

use super::attributes::TriangleAttributes;
use super::constants::NONE;
use super::motion::PackedMotion;
use super::primitive::WorldPrimitive;
use super::shape::{self, Placement};
use crate::scene::{MaterialId, MaterialKind, Scene};

/// All primitives of a scene, and the attributes of those that have some.
#[derive(Debug, Default)]
pub struct WorldGeometry {
    pub primitives: Vec<WorldPrimitive>,
    pub attributes: Vec<TriangleAttributes>,
    /// Windows that directions to the environment are sampled through; rays do not meet them.
    pub portals: Vec<WorldPrimitive>,
    /// Of the shapes that move, and the same as the device reads them.
    pub motions: Vec<PackedMotion>,
    pub motion_words: Vec<[f32; 4]>,
}

/// Surfaces made of `pass` are left out: to every ray they are not there.
pub fn collect(scene: &Scene) -> WorldGeometry {
    let mut world = WorldGeometry::default();
    let textured = scene.materials_that(|material| material.uses_texture() || material.is_anisotropic());
    for (index, shape) in scene.shapes.iter().enumerate() {
        let first = world.primitives.len();
        shape::add(&Placement::new(shape, &textured), &mut |geometry, attributes, face| {
            let primitive = WorldPrimitive { shape: index, ..WorldPrimitive::new(geometry, shape.face_material(face)) };
            world.add(scene, primitive, attributes);
        });
        // What no ray meets, a shape of `pass` or a mesh without faces, need not move.
        let met = world.primitives.len() > first;
        if let Some(motion) = PackedMotion::new(shape, scene.camera.shutter).filter(|_| met) {
            world.set_in_motion(first, motion);
        }
    }
    world
}

impl WorldGeometry {
    /// What its surfaces are made of.
    pub fn materials(&self) -> BTreeSet<MaterialId> {
        self.primitives.iter().map(|primitive| primitive.material).collect()
    }

    fn add(&mut self, scene: &Scene, mut primitive: WorldPrimitive, attributes: Option<TriangleAttributes>) {
        if matches!(scene.materials[primitive.material].kind, MaterialKind::Pass) {
            if scene.shapes[primitive.shape].portal && !primitive.is_infinite() && primitive.area() > 0.0 {
                self.portals.push(primitive);
            }
            return;
        }
        if let Some(attributes) = attributes {
            primitive.attributes = self.attributes.len() as u32;
            self.attributes.push(attributes);
        }
        self.primitives.push(primitive);
    }

    /// Moves the primitives from `first` on. Their attributes say how.
    fn set_in_motion(&mut self, first: usize, motion: PackedMotion) {
        let word = self.motion_words.len() as u32;
        self.motion_words.extend(motion.words());
        for primitive in &mut self.primitives[first..] {
            primitive.motion = self.motions.len() as u32;
            if primitive.attributes == NONE {
                primitive.attributes = self.attributes.len() as u32;
                // Texture coordinates that interpolate to themselves.
                self.attributes.push(TriangleAttributes::new([Vec3::ZERO; 3], [Vec2::ZERO, Vec2::X, Vec2::Y]));
            }
            self.attributes[primitive.attributes as usize].motion = word;
        }
        self.motions.push(motion);
    }
}
