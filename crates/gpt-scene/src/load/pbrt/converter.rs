//! A description in the making.

use std::collections::{HashMap, HashSet};
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;

use glam::DAffine3;

use super::graphics_state::{Maps, MaterialName};
use super::infinite_lights::InfiniteLights;
use super::named_spectra::NamedMetal;
use super::parameter::Entity;
use super::text::Spot;
use super::texture_node::TextureNode;
use super::world::World;
use crate::load::error::SceneError;
use crate::load::file::shape::TransformEntry;
use crate::load::file::value::Located;
use crate::load::files::Files;
use crate::load::import::{Description, Enclosures, Input, triangles_fit};
use crate::load::model::Substitute;
use crate::scene::{ConductorFresnel, Mesh};
use crate::spectrum::Spectrum;

/// A mesh as its file has it, and what in the file was wrong and has something else in its place.
pub struct ReadMesh {
    pub mesh: Mesh,
    pub mends: Vec<Substitute>,
}

/// A description in the making.
pub struct Converter<'a> {
    pub files: &'a Files,
    /// Paths are relative to the folder of the scene's first file.
    pub folder: PathBuf,
    pub world: Rc<World>,
    pub scene: Description,
    /// The film's exposure, by which all light is multiplied.
    pub exposure: f64,
    /// Names of materials as they are without light, openings and media.
    pub materials: HashMap<MaterialName, String>,
    /// Materials that are being made, the outermost first: mixtures name others.
    pub materials_within: Vec<MaterialName>,
    /// Materials that are others with something besides, by what they say.
    pub variants: HashMap<String, String>,
    /// For each material of the description: it, or a part of it, looks up a texture, or has normals that are bent.
    pub looks: HashMap<String, MaterialLooks>,
    pub float_textures: HashMap<String, Rc<TextureNode>>,
    pub spectrum_textures: HashMap<String, Rc<TextureNode>>,
    /// Textures that are in the description, by what they are made of.
    pub made_textures: HashMap<String, Input>,
    pub media: HashMap<String, String>,
    /// How reports call the integrator, if that goes through media as if they were empty.
    pub blind: Option<String>,
    pub enclosures: Enclosures,
    pub meshes: HashMap<String, Arc<Mesh>>,
    /// Files of meshes as they stand.
    pub read_meshes: HashMap<PathBuf, Result<ReadMesh, SceneError>>,
    /// Triangles of all shapes, copies counted.
    pub triangles: u64,
    pub infinite: InfiniteLights,
    /// Directives whose parameters without effect are reported already.
    reported: HashSet<*const Entity>,
}

/// The part of a material that decides how its shapes are made.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct MaterialLooks {
    pub is_textured: bool,
    pub is_bent: bool,
    /// Light goes straight through.
    pub is_nothing: bool,
    /// Light that goes through goes into a body.
    pub tells_sides: bool,
}

impl<'a> Converter<'a> {
    pub fn new(files: &'a Files, folder: PathBuf, world: World) -> Self {
        Self {
            files,
            folder,
            world: Rc::new(world),
            scene: Description::default(),
            exposure: 1.0,
            materials: HashMap::new(),
            materials_within: Vec::new(),
            variants: HashMap::new(),
            looks: HashMap::new(),
            float_textures: HashMap::new(),
            spectrum_textures: HashMap::new(),
            made_textures: HashMap::new(),
            media: HashMap::new(),
            blind: None,
            enclosures: Enclosures::default(),
            meshes: HashMap::new(),
            read_meshes: HashMap::new(),
            triangles: 0,
            infinite: InfiniteLights::default(),
            reported: HashSet::new(),
        }
    }

    /// Converts all of the world.
    ///
    /// # Errors
    /// Something that cannot be.
    pub fn all(&mut self) -> Result<(), SceneError> {
        let world = self.world.clone();
        self.integrator()?;
        self.sampler()?;
        self.camera()?;
        self.read_side_by_side();
        for light in &world.lights {
            self.light(light)?;
            self.report_unused(&light.entity);
        }
        for shape in &world.shapes {
            self.shape(shape)?;
        }
        self.instances()?;
        self.finish_infinite_lights()?;
        let enclosures = std::mem::take(&mut self.enclosures);
        enclosures.settle(&mut self.scene).map_err(|message| SceneError::in_file("media", message))
    }

    pub fn drop(&mut self, spot: &Spot, what: impl Into<String>, instead: impl Into<String>) {
        self.scene.report.drop(what, spot.to_string(), instead);
    }

    pub fn approximate(&mut self, spot: &Spot, what: impl Into<String>, instead: impl Into<String>) {
        self.scene.report.approximate(what, spot.to_string(), instead);
    }

    /// Names the parameters of a directive for which nothing asked.
    pub fn report_unused(&mut self, entity: &Entity) {
        if !self.reported.insert(std::ptr::from_ref(entity)) {
            return;
        }
        for parameter in entity.unused() {
            let what = format!("{}: `{}`", entity.title(), parameter.name);
            self.scene.report.drop(what, parameter.spot.to_string(), "it has no effect");
        }
    }

    /// The transform of a shape that a map puts into the world.
    pub fn transform(&self, map: &DAffine3, spot: &Spot) -> Result<Option<Located<TransformEntry>>, SceneError> {
        spot.possible(TransformEntry::of_map(map, &spot.place()))
    }

    /// Counts triangles, which must be there.
    pub fn counted(&mut self, spot: &Spot, faces: u64) -> Result<(), SceneError> {
        self.triangles += faces;
        triangles_fit(self.triangles).map_err(|message| spot.error(message))
    }

    /// n and k of a metal.
    pub fn constants_of(&self, metal: NamedMetal) -> (Spectrum, Spectrum) {
        match metal {
            NamedMetal::Constants { eta, k } => (eta, k),
            NamedMetal::Preset(preset) => match preset.fresnel() {
                ConductorFresnel::Complex { eta, k } => (eta, k),
                ConductorFresnel::Reflectance(_) => (Spectrum::WHITE, Spectrum::BLACK),
            },
        }
    }
}

/// The map flattens what it places, or leaves the range of numbers.
pub fn is_flat(maps: &Maps) -> bool {
    !maps.iter().all(|map| map.is_finite() && map.matrix3.determinant().abs() > 0.0)
}
