//! The scene as packed arrays for the device: pure data, built and checked without a GPU.
//!
//! Orders matter. Lights stand in the order in which the scene names them, so that a random choice picks the same light on the CPU;
//! primitives stand in the order of the hierarchy's leaves, those outside of it behind them.

pub mod bvh4;
pub mod environment;
pub mod heuristic;
pub mod light;
pub mod material;
pub mod motion;
pub mod primitive;
pub mod tables;
pub mod texture;
pub mod validate;
pub mod view;
pub mod world;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::scene::Scene;
use bvh4::Bvh4;
use environment::FlatEnvironment;
use light::FlatLight;
use material::FlatMaterials;
use primitive::{Primitive, TriangleAttributes};
use tables::Tables;
use texture::FlatTextures;

pub use validate::FlatError;
pub use view::View;

/// "No index" in every array.
pub const NONE: u32 = u32::MAX;

/// A scene ready for upload.
#[derive(Debug, Clone, Default)]
pub struct FlatScene {
    /// In leaf order; behind them those that the hierarchy does not hold.
    pub primitives: Vec<Primitive>,
    pub attributes: Vec<TriangleAttributes>,
    pub bvh: Bvh4,
    pub materials: FlatMaterials,
    /// Lights that are sampled; empty where the estimator never asks.
    pub lights: Vec<FlatLight>,
    pub textures: FlatTextures,
    pub environment: FlatEnvironment,
    /// How shapes move ([`motion::FlatMotion::words`]).
    pub motions: Vec<[f32; 4]>,
    pub view: View,
}

impl FlatScene {
    /// Packs a scene, relative to its [center](Scene::center).
    ///
    /// # Errors
    /// [`FlatError`] where something is too large for the packed form or came out inconsistent.
    pub fn new(scene: &Scene) -> Result<Self, FlatError> {
        let scene = &*scene.centered();
        for shape in &scene.shapes {
            let fail = |(_, message)| FlatError::Motion { shape: shape.label.clone(), message };
            shape.check_motion(scene.camera.shutter).map_err(fail)?;
        }
        let mut world = world::collect(scene);
        let mut textures = FlatTextures::new(scene)?;
        let environment = FlatEnvironment::new(scene, &mut textures.texels)?;
        let lights = light::collect(scene, &mut world, &environment);
        let (bvh, order) = Bvh4::build(&world.primitives, &world.motions)?;
        let primitives: Vec<Primitive> = order.par_iter().map(|&index| world.primitives[index].pack()).collect();
        let flat = Self {
            primitives,
            attributes: world.attributes,
            bvh,
            materials: FlatMaterials::new(scene)?,
            lights,
            textures,
            environment,
            motions: world.motion_words,
            view: View::new(scene),
        };
        flat.validate()?;
        Ok(flat)
    }

    /// Something moves while the shutter is open.
    pub fn moves(&self) -> bool {
        !self.motions.is_empty()
    }

    /// All that shading looks up, as one array of vec4.
    pub fn tables(&self) -> Tables {
        Tables::new(self)
    }
}

/// Rounded to f32, and grown by two rounding errors on every side.
pub(crate) fn outward(min: DVec3, max: DVec3) -> (Vec3, Vec3) {
    let margin = min.abs().max(max.abs()) * 2.4e-7;
    ((min - margin).as_vec3(), (max + margin).as_vec3())
}
