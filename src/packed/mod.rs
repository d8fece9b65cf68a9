//! The scene as packed arrays for the device: pure data, built and checked without a GPU.
//!
//! Orders matter. Lights stand in the order in which the scene names them, so that a random choice picks the same light on the CPU;
//! primitives stand in the order of the hierarchy's leaves, those outside of it behind them.

pub mod blend_weight;
pub mod bvh4;
pub mod environment;
pub mod grid;
pub mod hierarchy;
pub mod light;
pub mod material;
pub mod motion;
pub mod primitive;
pub mod ray_query;
pub mod tables;
pub mod texture;
pub mod tree;
pub mod validate;
pub mod view;
pub mod world;

use rayon::prelude::*;

use crate::scene::Scene;
use environment::PackedEnvironment;
use hierarchy::{Hierarchy, Traversal};
use light::PackedLight;
use material::PackedMaterials;
use primitive::{Primitive, TriangleAttributes};
use tables::Tables;
use texture::PackedTextures;

pub use validate::PackError;
pub use view::View;

/// "No index" in every array.
pub const NONE: u32 = u32::MAX;

/// A scene ready for upload.
#[derive(Debug, Clone, Default)]
pub struct PackedScene {
    /// In leaf order; behind them those that the hierarchy does not hold.
    pub primitives: Vec<Primitive>,
    pub attributes: Vec<TriangleAttributes>,
    pub hierarchy: Hierarchy,
    pub materials: PackedMaterials,
    /// Lights that are sampled; empty where the estimator never asks.
    pub lights: Vec<PackedLight>,
    pub textures: PackedTextures,
    pub environment: PackedEnvironment,
    /// How shapes move ([`motion::PackedMotion::words`]).
    pub motions: Vec<[f32; 4]>,
    pub view: View,
}

impl PackedScene {
    /// Packs a scene for kernels that walk a bounding volume hierarchy.
    ///
    /// # Errors
    /// As [`PackedScene::for_traversal`].
    pub fn new(scene: &Scene) -> Result<Self, PackError> {
        Self::for_traversal(scene, Traversal::Bvh)
    }

    /// Packs a scene, relative to its [center](Scene::center), for rays that find primitives in this way.
    ///
    /// # Errors
    /// [`PackError`] where something is too large for the packed form or came out inconsistent.
    pub fn for_traversal(scene: &Scene, traversal: Traversal) -> Result<Self, PackError> {
        let scene = &*scene.centered();
        for shape in &scene.shapes {
            let fail = |(_, message)| PackError::Motion { shape: shape.label.clone(), message };
            shape.check_motion(scene.camera.shutter).map_err(fail)?;
        }
        let mut world = world::collect(scene);
        let mut materials = PackedMaterials::new(scene, &world.materials())?;
        let mut textures = PackedTextures::new(scene, materials.textures_mut())?;
        let environment = light::environment(scene, &mut textures.texels)?;
        let mut lights = light::collect(scene, &mut world, &environment);
        let places = materials.places(scene);
        world.primitives.iter_mut().for_each(|primitive| primitive.material = places[primitive.material] as usize);
        for light in lights.iter_mut().filter(|light| light.material != NONE) {
            light.material = places[light.material as usize];
        }
        let (hierarchy, order) = tree::build(&world.primitives, &world.motions, traversal)?;
        let packed = Self {
            primitives: order.par_iter().map(|&index| world.primitives[index].pack()).collect(),
            attributes: world.attributes,
            hierarchy,
            materials,
            lights,
            textures,
            environment,
            motions: world.motion_words,
            view: View::new(scene, &environment),
        };
        packed.validate()?;
        Ok(packed)
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
