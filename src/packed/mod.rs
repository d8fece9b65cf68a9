//! The scene as packed arrays for the device: pure data, built and checked without a GPU.
//!
//! Orders matter. Lights stand in the order in which the scene names them, so that a random choice picks the same light on the CPU;
//! primitives stand in the order of the hierarchy's leaves, those outside of it behind them.

pub mod bvh2;
pub mod bvh4;
pub mod cwbvh;
pub mod environment;
pub mod grid;
pub mod heuristic;
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
use hierarchy::{Hierarchy, HierarchyKind};
use light::PackedLight;
use material::PackedMaterials;
use primitive::{Primitive, TriangleAttributes, WorldPrimitive};
use tables::Tables;
use texture::PackedTextures;
use tree::Tree;

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

/// A scene packed but for the form of its hierarchy, and with it the order of its primitives: that depends on the device, which may still
/// be opening.
pub struct Unarranged {
    /// Without primitives and hierarchy.
    rest: PackedScene,
    primitives: Vec<WorldPrimitive>,
    tree: Tree,
}

impl Unarranged {
    /// Packs a scene, relative to its [center](Scene::center).
    ///
    /// # Errors
    /// [`PackError`] where something is too large for the packed form.
    pub fn new(scene: &Scene) -> Result<Self, PackError> {
        Self::for_form(scene, None)
    }

    /// As [`Unarranged::new`], without what a form that is already known does not need.
    ///
    /// # Errors
    /// As [`Unarranged::new`].
    pub fn for_form(scene: &Scene, form: Option<HierarchyKind>) -> Result<Self, PackError> {
        let scene = &*scene.centered();
        for shape in &scene.shapes {
            let fail = |(_, message)| PackError::Motion { shape: shape.label.clone(), message };
            shape.check_motion(scene.camera.shutter).map_err(fail)?;
        }
        let mut world = world::collect(scene);
        let mut materials = PackedMaterials::new(scene, &world.materials())?;
        let mut textures = PackedTextures::new(scene, materials.textures_mut())?;
        let environment = PackedEnvironment::new(scene, &mut textures.texels)?;
        let mut lights = light::collect(scene, &mut world, &environment);
        let places = materials.places(scene);
        world.primitives.iter_mut().for_each(|primitive| primitive.material = places[primitive.material] as usize);
        for light in lights.iter_mut().filter(|light| light.material != NONE) {
            light.material = places[light.material as usize];
        }
        let tree = Tree::build(&world.primitives, &world.motions, form)?;
        let rest = PackedScene {
            attributes: world.attributes,
            materials,
            lights,
            textures,
            environment,
            motions: world.motion_words,
            view: View::new(scene),
            ..PackedScene::default()
        };
        Ok(Self { rest, primitives: world.primitives, tree })
    }

    /// Gives the hierarchy its form.
    ///
    /// # Errors
    /// [`PackError`] where the packed scene came out inconsistent.
    pub fn arrange(self, kind: HierarchyKind) -> Result<PackedScene, PackError> {
        let (hierarchy, order) = self.tree.arrange(kind, &self.primitives)?;
        let primitives = order.par_iter().map(|&index| self.primitives[index].pack()).collect();
        let packed = PackedScene { primitives, hierarchy, ..self.rest };
        packed.validate()?;
        Ok(packed)
    }
}

impl PackedScene {
    /// Packs a scene, with the hierarchy of most devices.
    ///
    /// # Errors
    /// [`PackError`] where something is too large for the packed form or came out inconsistent.
    pub fn new(scene: &Scene) -> Result<Self, PackError> {
        Unarranged::new(scene)?.arrange(HierarchyKind::default())
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
