//! glTF in both forms.

mod image_based;
mod materials;
mod meshes;
mod motion;
mod older;
mod sides;
mod tangents;
mod textures;

use base64::Engine as _;
use gpt::load::LoadOptions;
use gpt::scene::{
    Attenuation, Channel, ChannelInput, ColorInput, Geometry, Light, MaterialKind, Mesh, Phase, PhaseKind, Projection, Scene,
};
use gpt::spectrum::Spectrum;
use serde_json::{Value, json};

use super::{Folder, picture, refusal, report};

/// A file in the making: data are put one after the other into its only buffer.
pub struct File {
    pub root: Value,
    data: Vec<u8>,
}

impl File {
    /// A triangle of a diffuse material, a camera and a light.
    pub fn new() -> Self {
        let mut file = Self { root: json!({}), data: Vec::new() };
        let positions = file.accessor("VEC3", &[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.5], [0.0, 1.0, 0.0]].concat());
        file.root = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": [0, 1, 2] }],
            "nodes": [
                { "mesh": 0 },
                { "name": "eye", "camera": 0, "translation": [0.0, 0.0, 4.0] },
                { "extensions": { "KHR_lights_punctual": { "light": 0 } }, "translation": [1.0, 2.0, 3.0] },
            ],
            "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1, "aspectRatio": 2.0 } }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "material": 0 }] }],
            "materials": [{
                "pbrMetallicRoughness": { "baseColorFactor": [0.7, 0.2, 0.1, 1.0], "metallicFactor": 0.0 },
                "extensions": { "KHR_materials_specular": { "specularFactor": 0.0 } },
                "doubleSided": true,
            }],
            "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_specular"],
            "extensions": { "KHR_lights_punctual": { "lights": [{ "type": "point", "color": [1.0, 0.5, 0.25], "intensity": 40.0 }] } },
            "accessors": [positions],
            "bufferViews": [{ "buffer": 0, "byteOffset": 0, "byteLength": 36 }],
        });
        file
    }

    /// Appends numbers and gives an accessor of them, without entering it.
    fn accessor(&mut self, kind: &str, numbers: &[f32]) -> Value {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let width = match kind {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let view = self.root.get("bufferViews").and_then(Value::as_array).map_or(0, Vec::len);
        self.bytes(&bytes);
        json!({ "bufferView": view, "componentType": 5126, "type": kind, "count": numbers.len() / width })
    }

    /// Appends bytes with a view of them; its index.
    pub fn bytes(&mut self, bytes: &[u8]) -> usize {
        let start = self.data.len();
        self.data.extend(bytes);
        let Some(views) = self.root.get_mut("bufferViews").and_then(Value::as_array_mut) else { return 0 };
        views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": bytes.len() }));
        views.len() - 1
    }

    /// Appends numbers with an accessor of them; its index.
    pub fn add(&mut self, kind: &str, numbers: &[f32]) -> usize {
        let accessor = self.accessor(kind, numbers);
        self.enter(accessor)
    }

    pub fn enter(&mut self, accessor: Value) -> usize {
        let accessors = self.root["accessors"].as_array_mut().expect("a list");
        accessors.push(accessor);
        accessors.len() - 1
    }

    /// Gives the first primitive's three vertices colours.
    pub fn paint(&mut self) {
        let colours = self.add("VEC3", &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5, 1.0]);
        self.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colours);
    }

    /// The file as JSON with the data in it.
    pub fn text(&self) -> Vec<u8> {
        let mut root = self.root.clone();
        let data = base64::engine::general_purpose::STANDARD.encode(&self.data);
        root["buffers"] =
            json!([{ "byteLength": self.data.len(), "uri": format!("data:application/octet-stream;base64,{data}") }]);
        root.to_string().into_bytes()
    }

    /// The file in binary form.
    pub fn binary(&self) -> Vec<u8> {
        let mut root = self.root.clone();
        root["buffers"] = json!([{ "byteLength": self.data.len() }]);
        let mut text = root.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut data = self.data.clone();
        data.resize(data.len().next_multiple_of(4), 0);
        let mut bytes = b"glTF".to_vec();
        for number in [2, 28 + text.len() + data.len(), text.len()] {
            bytes.extend((number as u32).to_le_bytes());
        }
        bytes.extend(b"JSON");
        bytes.extend(text);
        bytes.extend((data.len() as u32).to_le_bytes());
        bytes.extend(b"BIN\0");
        bytes.extend(data);
        bytes
    }

    pub fn read(&self) -> Scene {
        Folder::new(&[("a.gltf", &self.text())]).valid("a.gltf")
    }

    pub fn refused(&self) -> String {
        refusal(Folder::new(&[("a.gltf", &self.text())]).load("a.gltf"))
    }
}

pub fn mesh(scene: &Scene, index: usize) -> &Mesh {
    match &scene.shapes[index].geometry {
        Geometry::Mesh(mesh) => mesh,
        other => panic!("{other:?}"),
    }
}

#[test]
fn both_forms_and_their_likeness_make_the_same_picture() {
    let file = File::new();
    let same = format!(
        "[film]\nsize = [512, 256]\n[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\nvfov = {}\n\
         [[material]]\nname = \"red\"\ntype = \"diffuse\"\nreflectance = [0.7, 0.2, 0.1]\n\
         [[shape]]\ntype = \"mesh\"\nmaterial = \"red\"\npositions = [[-1, -1, 0], [1, -1, 0.5], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n\
         [[light]]\ntype = \"point\"\nposition = [1, 2, 3]\nintensity = [40, 20, 10]\n",
        0.7_f64.to_degrees()
    );
    let other = same.replace("0.5], [0, 1", "0.51], [0, 1");
    let folder = Folder::new(&[
        ("a.gltf", &file.text()),
        ("a.glb", &file.binary()),
        ("b.toml", same.as_bytes()),
        ("c.toml", other.as_bytes()),
    ]);
    let expected = picture(&folder.valid("b.toml"));
    let scene = folder.valid("a.gltf");
    assert_eq!(scene.film.size, [512, 256]);
    assert_eq!(picture(&scene), expected);
    assert_eq!(picture(&folder.valid("a.glb")), expected);
    assert_eq!(picture(&folder.written("a.glb")), expected);
    // The control: a vertex a little further away.
    assert_ne!(picture(&folder.valid("c.toml")), expected);
}

#[test]
fn what_has_no_camera_and_no_light_is_framed_as_a_model() {
    let mut file = File::new();
    file.root["scenes"] = json!([{ "nodes": [0] }]);
    let object = "v -1 -1 0\nv 1 -1 0.5\nv 0 1 0\nf 1 2 3\n";
    let folder = Folder::new(&[("a.glb", &file.binary()), ("b.obj", object.as_bytes())]);
    let (scene, model) = (folder.valid("a.glb"), folder.valid("b.obj"));
    assert_eq!((&scene.camera.position, &scene.camera.projection), (&model.camera.position, &model.camera.projection));
    assert_eq!((scene.shapes.len(), scene.lights.len()), (model.shapes.len(), model.lights.len()));
    assert_eq!(picture(&scene), picture(&folder.written("a.glb")));
}

/// Surfaces that merely glow, as the labels and lamps of many models do, are lit as well; a lamp of another
/// strength lights by itself.
#[test]
fn what_glows_is_lit() {
    let lights = |factor: [f64; 3], strength: Option<f64>| {
        let mut file = File::new();
        file.root["scenes"] = json!([{ "nodes": [0, 1] }]);
        file.root["materials"][0]["emissiveFactor"] = json!(factor);
        if let Some(strength) = strength {
            file.root["materials"][0]["extensions"] =
                json!({ "KHR_materials_emissive_strength": { "emissiveStrength": strength } });
        }
        file.read().lights.len()
    };
    assert_eq!(lights([1.0, 0.5, 0.0], None), 1);
    assert_eq!(lights([1.0, 0.5, 0.0], Some(1.0)), 1);
    assert_eq!(lights([1.0, 0.5, 0.0], Some(1.5)), 0);
    assert_eq!(lights([0.0; 3], Some(1.5)), 1, "the control: it is dark");
}

#[test]
fn cameras_are_chosen_by_their_name() {
    let mut file = File::new();
    file.root["nodes"].as_array_mut().expect("a list").push(json!({ "camera": 1 }));
    file.root["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    file.root["cameras"].as_array_mut().expect("a list").push(json!({
        "name": "plan", "type": "orthographic", "orthographic": { "xmag": 3.0, "ymag": 1.5, "zfar": 9.0, "znear": 0.0 },
    }));
    let folder = Folder::new(&[("a.gltf", &file.text())]);
    let of = |name: &str| folder.load_as("a.gltf", &LoadOptions { camera: Some(name.to_owned()), ..LoadOptions::default() });
    let plan = of("plan").unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((plan.camera.projection, plan.film.size), (Projection::Orthographic { height: 3.0 }, [512, 256]));
    assert!(matches!(of("eye").map(|scene| scene.camera.projection), Ok(Projection::Perspective { .. })));
    let message = refusal(of("absent"));
    assert!(message.contains("absent") && message.contains("eye") && message.contains("plan"), "{message}");
}

#[test]
fn nodes_stand_within_each_other() {
    let mut file = File::new();
    file.root["nodes"][0] = json!({ "translation": [5.0, 0.0, 0.0], "children": [3] });
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let nodes = file.root["nodes"].as_array_mut().expect("a list");
    nodes.push(json!({ "rotation": [0.0, half, 0.0, half], "scale": [2.0, 2.0, 2.0], "mesh": 0 }));
    let map = file.read().shapes[0].transform.to_affine();
    assert!(map.transform_point3(glam::DVec3::Z).abs_diff_eq(glam::DVec3::new(7.0, 0.0, 0.0), 1e-12), "{map:?}");
    file.root["nodes"][3]["children"] = json!([0]);
    assert!(file.refused().contains("its own ancestor"));
    file.root["nodes"][3]["children"] = json!([]);
    file.root["nodes"][3]["scale"] = json!([0.0, 0.0, 1.0]);
    file.root["nodes"][2]["mesh"] = json!(0);
    assert!(report(&file.read()).contains("mesh without extent"));
}

fn report_or_refusal(file: &File) -> String {
    match Folder::new(&[("a.gltf", &file.text())]).load("a.gltf") {
        Ok(scene) => report(&scene),
        Err(error) => error.to_string(),
    }
}

#[test]
fn lights_shine_along_their_nodes() {
    let mut file = File::new();
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = json!([
        { "type": "spot", "spot": { "outerConeAngle": 0.5 } }, { "type": "directional", "intensity": 3.0 }, { "type": "area" },
    ]);
    let scene = file.read();
    let Light::Spot(spot) = &scene.lights[0] else { panic!("no spot") };
    assert_eq!((spot.direction, spot.position), (glam::DVec3::NEG_Z, glam::DVec3::new(1.0, 2.0, 3.0)));
    file.root["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = json!(1);
    assert!(matches!(&file.read().lights[0], Light::Directional(light) if light.irradiance.r() == 3.0));
    file.root["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = json!(2);
    let message = report_or_refusal(&file);
    assert!(message.contains("light of type `area`"), "{message}");
}

#[test]
fn what_cannot_be_read_is_refused_by_name() {
    let mut file = File::new();
    for (extension, said) in [
        ("KHR_draco_mesh_compression", "gltf-transform"),
        ("KHR_texture_basisu", "gltf-transform"),
        ("EXT_unknown", "EXT_unknown"),
    ] {
        file.root["extensionsRequired"] = json!([extension]);
        let folder = Folder::new(&[("a.gltf", &file.text())]);
        let error = folder.load("a.gltf").expect_err("it is refused");
        assert!(format!("{error} {}", error.help_text().unwrap_or_default()).contains(said), "{error}");
    }
    file.root["extensionsRequired"] = json!([]);
    file.root["extensionsUsed"] = json!(["EXT_unknown"]);
    assert!(report(&file.read()).contains("EXT_unknown"));
    // Packed positions that have an accessor without data, as every file has them that can be read by Draco alone without saying so.
    let mut packed = File::new();
    packed.root["meshes"][0]["primitives"][0]["extensions"] = json!({ "KHR_draco_mesh_compression": { "bufferView": 0 } });
    packed.read();
    packed.root["accessors"][0].as_object_mut().expect("an object").remove("bufferView");
    assert!(packed.refused().contains("Draco"), "{}", packed.refused());
    // Lists were objects once.
    let mut old = File::new();
    old.root["asset"]["version"] = json!("1.0");
    old.root["nodes"] = json!({ "node": {} });
    assert!(old.refused().contains("is glTF of version 1.0; version 2.0 is read"), "{}", old.refused());
}

/// Faults as they stand in collections of malformed files.
#[test]
fn malformed_files_are_refused_in_a_sentence() {
    let rows: [(&str, Value, &str); 16] = [
        ("/asset/version", json!("1.0"), "version 1.0"),
        ("/asset/version", json!(7), "is glTF of version 7; version 2.0 is read"),
        ("/asset/version", json!(1), "is glTF of version 1; version 2.0 is read"),
        ("/scene", json!(9), "no scenes[9]"),
        ("/scenes/0/nodes", json!([9]), "no nodes[9]"),
        ("/scenes/0/nodes", json!([-1]), "is not valid glTF"),
        ("/nodes/0/mesh", json!(9), "no meshes[9]"),
        ("/meshes/0/primitives/0/attributes/POSITION", json!(9), "no accessors[9]"),
        ("/meshes/0/primitives/0/attributes/POSITION", json!("x"), "POSITION names no accessor"),
        ("/meshes/0/primitives/0/material", json!(9), "no materials[9]"),
        ("/accessors/0/count", json!(1_000_000_000_000_u64), "do not fit"),
        ("/accessors/0/componentType", json!(1), "no componentType 1"),
        ("/accessors/0/type", json!("VEC2"), "type VEC2"),
        ("/accessors/0/bufferView", json!(9), "no bufferViews[9]"),
        ("/bufferViews/0/byteLength", json!(1_000_000), "beyond the end"),
        ("/bufferViews/0/buffer", json!(9), "no buffers[9]"),
    ];
    for (place, value, said) in rows {
        let mut file = File::new();
        *file.root.pointer_mut(place).unwrap_or_else(|| panic!("{place}")) = value;
        let message = file.refused();
        assert!(message.contains(said) && message.lines().count() == 1, "{place}: {message}");
    }
    let binary = File::new().binary();
    for length in [0, 4, 11, 12, 20, 30, binary.len() - 40] {
        refusal(Folder::new(&[("a.glb", &binary[..length])]).load("a.glb"));
    }
    for text in ["", "{}", "[]", "null", "{\"asset\":{}}", &"[".repeat(100_000)] {
        refusal(Folder::new(&[("a.gltf", text.as_bytes())]).load("a.gltf"));
    }
}
