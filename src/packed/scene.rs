//! The packed scene, and the order in which it is packed.

use rayon::prelude::*;

use super::attributes::TriangleAttributes;
use super::constants::NONE;
use super::environment::PackedEnvironment;
use super::error::PackError;
use super::hierarchy::{Hierarchy, Traversal};
use super::instance::PackedInstance;
use super::light::PackedLight;
use super::light::profile::PackedProfile;
use super::links::{PackedLinks, split_materials};
use super::material::PackedMaterials;
use super::primitive::Primitive;
use super::texture::PackedTextures;
use super::view::View;
use super::{light, object, tree, world};
use crate::binary_tree::parts::KeptTrees;
use crate::sampling::LightCells;
use crate::sampling::light_tree::LightNode;
use crate::scene::Scene;

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
    /// How many of them stand inside the scene; those at infinity are numbered behind.
    pub local_lights: usize,
    /// The tree by which those inside the scene are chosen, the root first; empty where they are chosen by power.
    pub light_nodes: Vec<LightNode>,
    /// Which lights reach which part of the scene, as a table ([`crate::sampling::light_cells`]); empty where they are chosen otherwise. It knows of nothing
    /// until that is [learned](PackedScene::set_light_cells).
    pub light_cells: Vec<u32>,
    /// Profiles that lights name.
    pub light_profiles: Vec<PackedProfile>,
    /// Which lamps light which objects; nothing where each lights all.
    pub links: PackedLinks,
    pub textures: PackedTextures,
    pub environment: PackedEnvironment,
    /// How shapes move (`PackedMotion::words` of `packed::motion`).
    pub motions: Vec<[f32; 4]>,
    /// Places of shapes ([`super::object`]), of a scene that was made ready for the layer of it; else empty.
    pub objects: Vec<[f32; 4]>,
    /// Groups of meshes in their places. Leaves name them.
    pub instances: Vec<PackedInstance>,
    pub view: View,
    /// From where light arrives, as a table ([`crate::sampling::guide`]); empty until that is learned, and where paths are not guided.
    pub guide: Vec<u32>,
    /// Why lights are chosen as they are; None where nothing was tried to find out.
    pub light_choice: Option<String>,
    /// The reason for the number of light samples; None where the scene states the number.
    pub light_samples: Option<String>,
    /// The reason why directions are drawn by a guide, or are not; None where nobody asked for one.
    pub directions: Option<String>,
    /// Behind the attributes of every triangle stand others whose texture coordinates are its second ones.
    pub second_uvs: bool,
}

impl PackedScene {
    /// Packs a scene for kernels that walk a bounding volume hierarchy.
    ///
    /// # Errors
    /// The errors of [`PackedScene::for_traversal`].
    pub fn new(scene: &Scene) -> Result<Self, PackError> {
        Self::for_traversal(scene, Traversal::Bvh)
    }

    /// Packs a scene, relative to its [center](Scene::center), for rays that find primitives in this way.
    ///
    /// # Errors
    /// [`PackError`] where something is too large for the packed form or came out inconsistent.
    pub fn for_traversal(scene: &Scene, traversal: Traversal) -> Result<Self, PackError> {
        Self::for_frame(scene, traversal, &mut KeptTrees::default())
    }

    /// Packs a frame of an animated scene. Trees that were built for an earlier frame are used where they
    /// fit; those of this frame replace them.
    ///
    /// # Errors
    /// The errors of [`PackedScene::for_traversal`].
    pub fn for_frame(scene: &Scene, traversal: Traversal, kept: &mut KeptTrees) -> Result<Self, PackError> {
        for shape in &scene.shapes {
            let fail = |(_, message)| PackError::Motion { shape: shape.label.clone(), message };
            shape.check_motion(scene.camera.shutter).map_err(fail)?;
        }
        let scene = &*scene.centered();
        let mut world = world::collect(scene);
        let mut materials = PackedMaterials::new(scene, &world.materials())?;
        let mut projected_textures = light::projected_textures(scene);
        let of_lights = projected_textures.iter_mut().filter(|mention| **mention != NONE);
        let grids = materials.media.volumes.grids().to_vec();
        let mut textures = PackedTextures::new(scene, materials.textures_mut().chain(of_lights), &grids)?;
        materials.media.volumes.place(&mut textures)?;
        let environment = light::environment(scene, &mut textures)?;
        let light::SampledLights { mut lights, links, local_count, nodes, cells, profiles } =
            light::collect(scene, &mut world, &environment, &projected_textures, &mut textures)?;
        let places = materials.places(scene);
        world.replace_materials(|material| places[material] as usize);
        let links = if scene.light_links.is_empty() {
            PackedLinks::default()
        } else {
            let receivers = split_materials(scene, &mut world.primitives, &mut materials);
            PackedLinks::new(scene, (&materials, &receivers), links, &world.instances)
        };
        // Surfaces have the same material as lights.
        for primitive in world.primitives.iter().filter(|primitive| primitive.light != NONE) {
            lights[primitive.light as usize].material = primitive.material as u32;
        }
        let (hierarchy, order) = tree::build(&world, traversal, kept)?;
        let packed = Self {
            objects: object::words(scene, &world, &order),
            primitives: order.par_iter().map(|slot| slot.pack(&world)).collect(),
            // Without nodes there are no roots; the plan refuses such a scene.
            instances: world
                .instances
                .par_iter()
                .map(|instance| instance.pack(hierarchy.roots.get(instance.group).copied().unwrap_or(NONE)))
                .collect(),
            attributes: world.attributes,
            hierarchy,
            materials,
            lights,
            local_lights: local_count,
            light_nodes: nodes,
            light_cells: cells,
            light_profiles: profiles,
            links,
            textures,
            environment,
            motions: world.motion_words,
            view: View::new(scene, &environment),
            guide: Vec::new(),
            light_choice: None,
            light_samples: None,
            directions: None,
            second_uvs: world.second_uvs,
        };
        packed.validate()?;
        Ok(packed)
    }

    /// Chooses lights by what was learned of them, where they are chosen by cells.
    ///
    /// # Errors
    /// [`PackError::Inconsistent`] where kernels could not follow it.
    pub fn set_light_cells(&mut self, learned: &LightCells) -> Result<(), PackError> {
        if self.light_cells.is_empty() {
            return Ok(());
        }
        self.light_cells = learned.words().to_vec();
        self.check_light_cells().map_err(PackError::Inconsistent)
    }

    /// Something moves while the shutter is open.
    pub fn moves(&self) -> bool {
        !self.motions.is_empty()
    }

    /// Some primitive carries normals or texture coordinates.
    pub fn has_attributes(&self) -> bool {
        self.moves() || self.primitives.iter().any(|primitive| primitive.attributes != NONE)
    }
}
