//! A scene as one of glTF 2.0, as far as it can be said there.
//!
//! Candela, lux and nits are taken for watts, as the importer takes them. Shapes are triangles there, in the space that they have here: the nodes
//! have the transforms. Materials are the principled one of here, or the one of its kind that is nearest.

mod buffer;
mod camera;
mod container;
mod draft;
mod light;
mod made;
mod material;
mod mesh;
mod nearest;
mod node;
mod packing;
mod paint;
mod tangents;
mod texture;
mod volume;

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;

use serde_json::{Map, Value, json};

use self::buffer::Buffer;
use self::made::{Made, MeshKey};
use super::flat_camera::with_flat_camera;
use super::losses::Losses;
use super::surroundings::with_media_below_surfaces;
use super::written::WrittenScene;
use crate::load::file::writer::{Names, SideFiles};
use crate::scene::{LightProfile, MaterialId, Scene};

/// A scene as one of glTF 2.0 that is to be written to `target`: binary where that ends in `.glb`, else JSON, beside which its data and pictures lie
/// in the folder `NAME.files`. `name` is how reports call the scene.
pub fn as_gltf(scene: &Scene, name: &str, target: &Path) -> WrittenScene {
    let mut losses = Losses::of(name);
    losses.drop_links(scene);
    let scene = &with_flat_camera(scene, &mut losses, |_| false);
    let scene = &with_media_below_surfaces(scene);
    let mut writer = Writer {
        scene,
        is_binary: target.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("glb")),
        losses,
        files: SideFiles::beside(target),
        materials: Names::unique(scene.materials.iter().map(|material| material.name.as_str()), "material"),
        buffer: Buffer::default(),
        lists: Lists::default(),
        made_materials: HashMap::new(),
        made_meshes: HashMap::new(),
        made_textures: HashMap::new(),
        made_profiles: HashMap::new(),
        extensions: BTreeSet::new(),
        uses_sets: [false; 2],
        round: BTreeMap::new(),
    };
    writer.all();
    writer.finish()
}

/// The lists of the file.
#[derive(Default)]
struct Lists {
    cameras: Vec<Value>,
    images: Vec<Value>,
    lights: Vec<Value>,
    materials: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
    profiles: Vec<Value>,
    samplers: Vec<Value>,
    textures: Vec<Value>,
}

struct Writer<'w> {
    scene: &'w Scene,
    is_binary: bool,
    losses: Losses,
    files: SideFiles,
    materials: Names,
    buffer: Buffer,
    lists: Lists,
    made_materials: HashMap<MaterialId, Option<Made>>,
    made_meshes: HashMap<MeshKey, Option<usize>>,
    /// Indices of textures and images, by what they are made from.
    made_textures: HashMap<String, usize>,
    /// Indices of lights' profiles.
    made_profiles: HashMap<*const LightProfile, usize>,
    extensions: BTreeSet<&'static str>,
    /// The sets of texture coordinates that the material in the making uses.
    uses_sets: [bool; 2],
    /// Round shapes by their kinds: the places, and the largest distance of triangles from them.
    round: BTreeMap<&'static str, (Vec<String>, f64)>,
}

impl Writer<'_> {
    fn all(&mut self) {
        for index in 0..self.scene.meters.len() {
            self.drop("meter", &format!("meter[{index}]"), "it is not written");
        }
        self.report_settings();
        self.camera();
        self.shapes();
        self.instances();
        self.lights();
        for (kind, (places, deviation)) in std::mem::take(&mut self.round) {
            let instead = format!("it is made of triangles, {deviation:.1e} of the scene's units off at most");
            places.iter().for_each(|place| self.approximate(format!("shape `{kind}`"), place, instead.clone()));
        }
    }

    /// Reports what concerns the whole scene.
    fn report_settings(&mut self) {
        let scene = self.scene;
        if scene.animation.frames().is_some() {
            self.drop("keyframes", "animation", "the scene is written as it is at rest");
        }
        if scene.camera_medium.is_some() {
            self.drop("medium around the camera", "camera.medium", "nothing is around it");
        }
    }

    fn drop(&mut self, what: impl Into<String>, place: &str, instead: impl Into<String>) {
        self.losses.drop(what, place, instead);
    }

    fn approximate(&mut self, what: impl Into<String>, place: &str, instead: impl Into<String>) {
        self.losses.approximate(what, place, instead);
    }

    /// Notes that the file uses an extension; its name.
    fn uses(&mut self, extension: &'static str) -> &'static str {
        self.extensions.insert(extension);
        extension
    }

    fn finish(mut self) -> WrittenScene {
        let mut root = Map::new();
        root.insert("asset".to_owned(), json!({ "version": "2.0", "generator": "gpt" }));
        root.insert("scene".to_owned(), json!(0));
        let nodes: Vec<usize> = (0..self.lists.nodes.len()).collect();
        // A list without entries is not allowed.
        let scene = if nodes.is_empty() { json!({}) } else { json!({ "nodes": nodes }) };
        root.insert("scenes".to_owned(), json!([scene]));
        let lights = [
            ("KHR_lights_punctual", std::mem::take(&mut self.lists.lights)),
            ("EXT_lights_ies", std::mem::take(&mut self.lists.profiles)),
        ];
        let of_root = lights.into_iter().filter(|(_, lights)| !lights.is_empty());
        let of_root: Map<String, Value> =
            of_root.map(|(name, lights)| (self.uses(name).to_owned(), json!({ "lights": lights }))).collect();
        if !of_root.is_empty() {
            root.insert("extensions".to_owned(), Value::Object(of_root));
        }
        let (data, views, accessors) = self.buffer.into_parts();
        let lists = [
            ("cameras", self.lists.cameras),
            ("images", self.lists.images),
            ("materials", self.lists.materials),
            ("meshes", self.lists.meshes),
            ("nodes", self.lists.nodes),
            ("samplers", self.lists.samplers),
            ("textures", self.lists.textures),
            ("bufferViews", views),
            ("accessors", accessors),
            ("extensionsUsed", self.extensions.iter().map(|name| json!(name)).collect()),
        ];
        for (name, list) in lists.into_iter().filter(|(_, list)| !list.is_empty()) {
            root.insert(name.to_owned(), Value::Array(list));
        }
        let content = if self.is_binary {
            if !data.is_empty() {
                root.insert("buffers".to_owned(), json!([{ "byteLength": data.len() }]));
            }
            container::binary(&Value::Object(root), data)
        } else {
            if !data.is_empty() {
                let length = data.len();
                let uri = container::uri(&self.files.add_file("data.bin", data));
                root.insert("buffers".to_owned(), json!([{ "byteLength": length, "uri": uri }]));
            }
            container::text(&Value::Object(root))
        };
        WrittenScene { content, files: self.files.into_files(), report: self.losses.into_report() }
    }
}

#[cfg(test)]
mod tests;
