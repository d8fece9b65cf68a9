//! Scenes of Mitsuba, versions 0.4 to 3, in XML.
//!
//! `document` reads the file into plugins with properties (`plugin`); the other modules say in the terms of scene files what each kind of
//! plugin means. Whatever no module asked for ends up in the report.

mod bsdf;
mod colour;
mod document;
mod emitter;
mod mesh_file;
mod metals;
mod number;
mod plugin;
mod sensor;
mod serialized;
mod shape;
mod spectrum;
mod texture;
mod transform;
mod write;

use std::collections::HashMap;
use std::path::Path;
use std::rc::Rc;

use glam::DAffine3;

use self::document::Reader;
use self::plugin::Plugin;
use self::texture::{Input, Texels};
use super::error::SceneError;
use super::files::Files;
use super::import::{Description, Keys};
use super::printable::short_list;
pub use write::{WrittenMitsuba, write};

/// What to read of a file.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// What `$key` stands for.
    pub definitions: Vec<(String, String)>,
    /// The id of the sensor; the first one where none is named.
    pub camera: Option<String>,
}

/// Reads a scene.
pub fn load(files: &Files, path: &Path, options: &Options) -> Result<Description, SceneError> {
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let mut reader = Reader::new(files, folder, &options.definitions);
    let root = reader.scene(path)?;
    let mut converter = Converter {
        reader,
        files,
        scene: Description::default(),
        world: DAffine3::IDENTITY,
        materials: HashMap::new(),
        both_sides: false,
        lamps: HashMap::new(),
        default_material: None,
        textures: HashMap::new(),
        meshes: HashMap::new(),
        read_meshes: HashMap::new(),
        triangles: 0,
    };
    converter.scene(&root, options)?;
    converter.report_unused(&root);
    converter.read_meshes.clear();
    let Converter { reader, mut scene, .. } = converter;
    scene.report.append(reader.report);
    Ok(scene)
}

/// A description in the making.
struct Converter<'a> {
    reader: Reader<'a>,
    files: &'a Files,
    scene: Description,
    /// What all of the scene is turned by, so that its environment stands upright.
    world: DAffine3,
    /// By the plugin, and whether it is within one that has two sides.
    materials: HashMap<(*const Plugin, bool), bsdf::Made>,
    both_sides: bool,
    /// Materials that give light, by their keys.
    lamps: HashMap<String, String>,
    /// That of shapes without a BSDF.
    default_material: Option<usize>,
    textures: HashMap<(*const Plugin, bool, Texels), Input>,
    meshes: HashMap<String, super::import::FileReference>,
    /// Files of meshes as they stand.
    read_meshes: HashMap<mesh_file::MeshKey, Result<crate::scene::Mesh, SceneError>>,
    /// Of all shapes, copies counted.
    triangles: u64,
}

impl Converter<'_> {
    fn scene(&mut self, root: &Rc<Plugin>, options: &Options) -> Result<(), SceneError> {
        root.visited.set(true);
        for integrator in root.children_of("integrator") {
            self.integrator(integrator)?;
        }
        let sensor = self.choose_sensor(root, options)?;
        self.find_world(root, sensor.as_ref())?;
        if let Some(sensor) = &sensor {
            self.sensor(sensor)?;
        }
        self.read_side_by_side(root);
        for child in &root.children {
            let plugin = &child.plugin;
            match plugin.kind.as_str() {
                "shape" => {
                    child.used.set(true);
                    self.shape(plugin)?;
                }
                "emitter" => {
                    child.used.set(true);
                    self.emitter(plugin)?;
                }
                // They count where shapes name them.
                "bsdf" | "texture" | "spectrum" | "sensor" => child.used.set(true),
                _ => {}
            }
        }
        Ok(())
    }

    fn choose_sensor(&self, root: &Rc<Plugin>, options: &Options) -> Result<Option<Rc<Plugin>>, SceneError> {
        let sensors = root.children_of("sensor");
        let Some(wanted) = &options.camera else { return Ok(sensors.first().map(|sensor| (*sensor).clone())) };
        let ids: Vec<&str> = sensors.iter().map(|sensor| sensor.id.as_str()).filter(|id| !id.is_empty()).collect();
        match sensors.iter().find(|sensor| sensor.id == *wanted) {
            Some(sensor) => Ok(Some((*sensor).clone())),
            None => {
                let error = root.error(format!("there is no sensor with the id `{wanted}`"));
                Err(if ids.is_empty() { error } else { error.with_help(format!("there are {}", short_list(&ids))) })
            }
        }
    }

    fn drop(&mut self, plugin: &Plugin, what: &str, instead: impl Into<String>) {
        self.scene.report.drop(what, plugin.place.to_string(), instead);
    }

    fn approximate(&mut self, plugin: &Plugin, what: &str, instead: impl Into<String>) {
        self.scene.report.approximate(what, plugin.place.to_string(), instead);
    }

    /// Names what nothing asked for, in plugins that are part of the picture.
    fn report_unused(&mut self, root: &Rc<Plugin>) {
        let mut seen: std::collections::HashSet<*const Plugin> = Default::default();
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

    /// The keys of a transform that puts something into the world.
    fn placed(&self, map: &DAffine3, keys: Keys) -> Keys {
        keys.with_some("transform", super::import::matrix_value(&(self.world * *map)))
    }
}
