//! A description in the making.

use std::collections::{HashMap, HashSet};
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;

use glam::DAffine3;

use super::document::Reader;
use super::input::Texels;
use super::met_media::MetMedia;
use super::plugin::Plugin;
use crate::load::error::SceneError;
use crate::load::file::shape::{ShapeEntry, TransformEntry};
use crate::load::file::value::Located;
use crate::load::files::Files;
use crate::load::image_file::EmbeddedFile;
use crate::load::import::{Description, Input};
use crate::load::model::Substitute;
use crate::scene::Mesh;

/// A mesh of a file: the file, its format, and the bits of the mesh's number.
pub type MeshKey = (PathBuf, String, u64);

/// A mesh as its file has it, and what in the file was wrong and has something else in its place.
pub struct ReadMesh {
    pub mesh: Mesh,
    pub mends: Vec<Substitute>,
}

/// A description in the making.
pub struct Converter<'a> {
    pub reader: Reader<'a>,
    pub files: &'a Files,
    pub scene: Description,
    /// By the plugin, whether it is within one that has two sides, and the mesh whose attributes it looks up.
    pub materials: HashMap<(*const Plugin, bool, Option<usize>), usize>,
    pub both_sides: bool,
    /// The sensor, where what it does not see is still to be reported.
    pub clip: Option<Rc<Plugin>>,
    /// Materials that give light, by their keys.
    pub emissive_materials: HashMap<String, String>,
    /// The materials of shapes without a BSDF: without light, with it, and of boundaries of media.
    pub default_materials: [Option<usize>; 3],
    pub textures: HashMap<(*const Plugin, bool, Texels, Option<usize>), Input>,
    /// Pictures that were made of others, by the file, whether its texels are linear and whether they are directions; None where the file says the same.
    pub made_pictures: HashMap<(PathBuf, bool, bool), Option<Arc<EmbeddedFile>>>,
    /// The attributes of the mesh whose material is being made, where it looks any up: by their names as `vertex_color`, and a number of
    /// the mesh.
    pub attributes: Option<(usize, Rc<HashMap<String, Input>>)>,
    /// Attributes of every mesh that was read with them, by its key.
    pub attributes_of_meshes: HashMap<String, (usize, Rc<HashMap<String, Input>>)>,
    pub meshes: HashMap<String, Arc<Mesh>>,
    /// Keys of meshes of which nothing is left.
    pub meshes_without_area: HashSet<String>,
    /// Files of meshes as they stand.
    pub read_meshes: HashMap<MeshKey, Result<ReadMesh, SceneError>>,
    /// Triangles of all shapes, copies counted.
    pub triangles: u64,
    /// How often instances at the top name a group.
    pub copies: HashMap<*const Plugin, usize>,
    /// Groups that instances have named, and the order in which they did first.
    pub groups: HashMap<*const Plugin, StoredGroup>,
    pub group_order: Vec<*const Plugin>,
    pub media: MetMedia,
}

/// A group of shapes that instances name.
pub struct StoredGroup {
    pub plugin: Rc<Plugin>,
    pub shapes: Vec<Located<ShapeEntry>>,
    pub places: Vec<DAffine3>,
    pub is_stored_once: bool,
}

impl Converter<'_> {
    pub fn drop(&mut self, plugin: &Plugin, what: &str, instead: impl Into<String>) {
        self.scene.report.drop(what, plugin.place.to_string(), instead);
    }

    pub fn approximate(&mut self, plugin: &Plugin, what: &str, instead: impl Into<String>) {
        self.scene.report.approximate(what, plugin.place.to_string(), instead);
    }

    /// Names what nothing asked for, in plugins that are part of the picture.
    pub fn report_unused(&mut self, root: &Rc<Plugin>) {
        let mut seen: HashSet<*const Plugin> = Default::default();
        let mut to_visit = vec![root.clone()];
        while let Some(plugin) = to_visit.pop() {
            if !seen.insert(Rc::as_ptr(&plugin)) {
                continue;
            }
            if plugin.visited.get() {
                for property in plugin.properties.iter().filter(|property| !property.used.get()) {
                    let what = format!("{}: `{}`", plugin.title(), property.name);
                    self.scene.report.drop(what, property.place.to_string(), "it has no effect");
                }
                for child in plugin.children.iter().filter(|child| !child.used.get()) {
                    let what = format!("{} in {}", child.plugin.title(), plugin.kind);
                    self.scene.report.drop(what, child.plugin.place.to_string(), "it has no effect");
                }
            }
            to_visit.extend(plugin.children.iter().rev().map(|child| child.plugin.clone()));
        }
    }

    /// The transform of a shape that a map puts into the world.
    pub fn transform(&self, map: &DAffine3, plugin: &Plugin) -> Result<Option<Located<TransformEntry>>, SceneError> {
        plugin.possible(TransformEntry::of_map(map, &plugin.at()))
    }
}
