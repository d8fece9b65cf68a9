//! Scenes of Mitsuba, versions 0.4 to 3, in XML.
//!
//! `document` reads the file into plugins (`plugin`) with properties (`property`), with its `parameters` filled in and what older `versions` wrote
//! brought up to date; the other modules say in the terms of scene files what each kind of plugin means. Whatever no module asked for ends up in the
//! report.

mod bitmap;
mod bsdf;
mod colour;
mod converter;
mod document;
mod emitter;
mod input;
mod limits;
mod media;
mod mesh_file;
mod met_media;
mod metals;
mod meter;
mod nesting;
mod number;
mod parameters;
mod plugin;
mod property;
mod references;
mod sensor;
mod serialized;
mod shape;
mod spectrum;
mod texture;
mod transform;
mod versions;

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::rc::Rc;

use self::converter::Converter;
use self::document::Reader;
use self::met_media::MetMedia;
use self::plugin::Plugin;
use super::error::SceneError;
use super::files::Files;
use super::import::{Description, handedness};
use super::printable::short_list;

/// The parts of a file to read.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Values of `$key`.
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
        materials: HashMap::new(),
        both_sides: false,
        clip: None,
        emissive_materials: HashMap::new(),
        default_materials: [None; 3],
        textures: HashMap::new(),
        made_pictures: HashMap::new(),
        attributes: None,
        attributes_of_meshes: HashMap::new(),
        meshes: HashMap::new(),
        meshes_without_area: HashSet::new(),
        read_meshes: HashMap::new(),
        triangles: 0,
        copies: HashMap::new(),
        groups: HashMap::new(),
        group_order: Vec::new(),
        media: MetMedia::default(),
    };
    converter.scene(&root, options)?;
    converter.report_unused(&root);
    converter.read_meshes.clear();
    let Converter { reader, mut scene, .. } = converter;
    scene.report.append(reader.report);
    handedness::turn_mirrored(&mut scene);
    Ok(scene)
}

impl Converter<'_> {
    fn scene(&mut self, root: &Rc<Plugin>, options: &Options) -> Result<(), SceneError> {
        root.visited.set(true);
        for integrator in root.children_of("integrator") {
            self.integrator(integrator)?;
        }
        let sensor = self.choose_sensor(root, options)?;
        if let Some(sensor) = &sensor {
            self.sensor(sensor)?;
        }
        for meter in root.children_of("sensor").into_iter().filter(|sensor| meter::is_meter(sensor)) {
            self.meter(meter)?;
        }
        self.read_side_by_side(root);
        self.count_copies(root);
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
                "bsdf" | "texture" | "spectrum" | "sensor" | "medium" | "phase" | "volume" => child.used.set(true),
                _ => {}
            }
        }
        self.finish_groups()?;
        let enclosures = std::mem::take(&mut self.media.enclosures);
        root.possible(enclosures.settle(&mut self.scene))?;
        self.report_clipped()
    }

    fn choose_sensor(&self, root: &Rc<Plugin>, options: &Options) -> Result<Option<Rc<Plugin>>, SceneError> {
        let sensors: Vec<&Rc<Plugin>> =
            root.children_of("sensor").into_iter().filter(|sensor| !meter::is_meter(sensor)).collect();
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
}
