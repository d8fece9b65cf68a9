//! glTF in both forms.

use base64::Engine as _;
use glam::DVec3;
use gpt::load::LoadOptions;
use gpt::scene::{Attenuation, Channel, ChannelInput, ColorInput, Geometry, Light, MaterialKind, Mesh, Projection, Scene};
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

    /// As JSON with the data in it.
    pub fn text(&self) -> Vec<u8> {
        let mut root = self.root.clone();
        let data = base64::engine::general_purpose::STANDARD.encode(&self.data);
        root["buffers"] =
            json!([{ "byteLength": self.data.len(), "uri": format!("data:application/octet-stream;base64,{data}") }]);
        root.to_string().into_bytes()
    }

    /// As a binary file.
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

/// What merely glows, as the labels and lamps of many models do, is lit as well; a lamp of another strength lights by itself.
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
    file.root["nodes"][3]["scale"] = json!([0.0, 1.0, 1.0]);
    file.root["nodes"][2]["mesh"] = json!(0);
    assert!(report(&file.read()).contains("mesh without extent"));
}

#[test]
fn copies_of_instances_stand_where_they_say() {
    let mut file = File::new();
    let translations = file.add("VEC3", &[1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0]);
    file.root["nodes"][0]["extensions"] = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": translations } } });
    let scene = file.read();
    let places: Vec<glam::DVec3> = scene.shapes.iter().map(|shape| shape.origin()).collect();
    assert_eq!(places, [glam::DVec3::X, glam::DVec3::Y * 2.0, glam::DVec3::Z * 3.0]);
}

/// Many copies of a mesh, by an extension and by nodes, are stored once; a mesh that gives light is not.
#[test]
fn meshes_that_stand_in_many_places_become_instances() {
    let mut file = File::new();
    let places: Vec<f32> = (0..1002).flat_map(|index| [index as f32, 0.0, 0.5]).collect();
    let translations = file.add("VEC3", &places);
    file.root["nodes"][0]["extensions"] = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": translations } } });
    let nodes = file.root["nodes"].as_array_mut().expect("a list");
    nodes.push(json!({ "mesh": 0, "scale": [-2.0, 1.0, 1.0] }));
    file.root["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    let scene = file.read();
    assert_eq!((scene.shapes.len(), scene.groups.len(), scene.instance_count()), (0, 1, 1003));
    let maps: Vec<glam::DAffine3> = scene.instances[0].maps().collect();
    assert_eq!(maps[7].translation, glam::DVec3::new(7.0, 0.0, 0.5));
    assert_eq!(maps[1002].matrix3.determinant(), -2.0);
    file.root["materials"][0]["emissiveFactor"] = json!([1.0, 1.0, 1.0]);
    let lamps = file.read();
    assert_eq!((lamps.shapes.len(), lamps.instance_count()), (1003, 0));
}

#[test]
fn strips_indices_and_sparse_values_are_read() {
    let mut file = File::new();
    let indices = file.bytes(&[0, 0, 1, 0, 2, 0, 0, 0]);
    let indices = file.enter(json!({ "bufferView": indices, "componentType": 5123, "type": "SCALAR", "count": 3 }));
    file.root["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    file.root["meshes"][0]["primitives"][0]["mode"] = json!(5);
    let places = file.bytes(&[2, 0, 0, 0]);
    let values: Vec<u8> = [0.0_f32, 5.0, 0.0].iter().flat_map(|number| number.to_le_bytes()).collect();
    let values = file.bytes(&values);
    file.root["accessors"][0]["sparse"] = json!({
        "count": 1, "indices": { "bufferView": places, "componentType": 5121 }, "values": { "bufferView": values },
    });
    let scene = file.read();
    assert_eq!(mesh(&scene, 0).positions[2], glam::Vec3::new(0.0, 5.0, 0.0));
    assert_eq!(mesh(&scene, 0).faces, [[0, 1, 2]]);
    file.root["accessors"][0]["sparse"]["count"] = json!(2);
    assert!(file.refused().contains("do not fit"));
}

#[test]
fn quantized_numbers_are_fractions() {
    let mut file = File::new();
    let bytes = file.bytes(&[0, 0, 0, 0, 0xff, 0x7f, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0x7f, 0, 0, 0, 0]);
    file.root["bufferViews"][bytes]["byteStride"] = json!(8);
    let quantized = json!({ "bufferView": bytes, "componentType": 5122, "type": "VEC3", "count": 2, "normalized": true });
    file.root["accessors"][0] = quantized;
    // Two vertices are too few for a triangle.
    assert!(report_or_refusal(&file).contains("nothing to render"));
    let bytes = file.bytes(&[0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0]);
    file.root["bufferViews"][bytes]["byteStride"] = json!(4);
    file.root["accessors"][0] =
        json!({ "bufferView": bytes, "componentType": 5120, "type": "VEC3", "count": 3, "normalized": true });
    assert_eq!(mesh(&file.read(), 0).positions, [glam::Vec3::ZERO, glam::Vec3::X, glam::Vec3::Y]);
}

fn report_or_refusal(file: &File) -> String {
    match Folder::new(&[("a.gltf", &file.text())]).load("a.gltf") {
        Ok(scene) => report(&scene),
        Err(error) => error.to_string(),
    }
}

#[test]
fn morph_targets_and_skins_bend_meshes() {
    let mut file = File::new();
    let target = file.add("VEC3", &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0]);
    file.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": target }]);
    file.root["meshes"][0]["weights"] = json!([0.5]);
    assert_eq!(mesh(&file.read(), 0).positions[2], glam::Vec3::new(0.0, 2.0, 0.0));
    let joints = file.bytes(&[0; 12]);
    let joints = file.enter(json!({ "bufferView": joints, "componentType": 5121, "type": "VEC4", "count": 3 }));
    let weights = file.add("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(3));
    let attributes = &mut file.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(joints);
    attributes["WEIGHTS_0"] = json!(weights);
    file.root["skins"] = json!([{ "joints": [3] }]);
    file.root["nodes"][0]["skin"] = json!(0);
    file.root["nodes"][0]["translation"] = json!([100.0, 0.0, 0.0]);
    file.root["nodes"].as_array_mut().expect("a list").push(json!({ "translation": [0.0, 0.0, 7.0] }));
    file.root["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    let scene = file.read();
    assert_eq!(mesh(&scene, 0).positions[2], glam::Vec3::new(0.0, 2.0, 7.0));
    assert_eq!(scene.shapes[0].origin(), glam::DVec3::ZERO);
    let times = file.add("SCALAR", &[0.0, 1.0]);
    let places = file.add("VEC3", &[0.0, 0.0, 7.0, 0.0, 0.0, 9.0]);
    let counts = file.add("SCALAR", &[0.5, 1.5]);
    let sampler = |output: usize| json!({ "input": times, "output": output });
    let channel = |sampler: u64, node: u64, path: &str| json!({ "sampler": sampler, "target": { "node": node, "path": path } });
    let channels = [channel(0, 3, "translation"), channel(1, 0, "weights")];
    file.root["animations"] = json!([{ "channels": channels, "samplers": [sampler(places), sampler(counts)] }]);
    let scene = file.read();
    assert_eq!(report(&scene), "");
    // Without a time it is as the nodes have it.
    assert_eq!(mesh(&scene, 0).positions[2], glam::Vec3::new(0.0, 2.0, 7.0));
    for (seconds, expected) in [(0.0, [2.0, 7.0]), (0.5, [3.0, 8.0]), (9.0, [4.0, 9.0])] {
        let at = scene.at_frame(seconds * 24.0).expect("it can be rendered");
        assert_eq!(mesh(&at, 0).positions[2], glam::Vec3::new(0.0, expected[0], expected[1]), "{seconds}");
    }
}

/// Where a corner of the first shape is at a time in seconds.
fn corner(scene: &Scene, seconds: f64) -> glam::Vec3 {
    let scene = scene.at_frame(seconds * scene.animation.frames_per_second).expect("it can be rendered");
    scene.shapes[0].world_positions()[0]
}

/// A mesh below a node that turns, below one that stands still, below one that moves; each kind of interpolation. By hand.
#[test]
fn animations_become_keyframes() {
    let mut file = File::new();
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let times = file.add("SCALAR", &[1.0, 3.0]);
    let turn = file.add("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half]);
    let moves = file.add("VEC3", &[0.0, 0.0, 0.0, 10.0, 0.0, 0.0]);
    let spline = file.add("VEC3", &[[0.0; 3], [0.0; 3], [0.0; 3], [0.0; 3], [10.0, 0.0, 0.0], [0.0; 3]].concat());
    file.root["nodes"] = json!([
        { "mesh": 0, "name": "hand" },
        { "name": "eye", "camera": 0, "translation": [0.0, 0.0, 4.0] },
        { "extensions": { "KHR_lights_punctual": { "light": 0 } }, "translation": [1.0, 2.0, 3.0] },
        { "name": "body", "children": [4] },
        { "name": "shoulder", "translation": [0.0, 5.0, 0.0], "children": [0, 1, 2] },
    ]);
    file.root["scenes"][0]["nodes"] = json!([3]);
    let rest = file.read();
    let sampler =
        |output: usize, interpolation: &str| json!({ "input": times, "output": output, "interpolation": interpolation });
    let channel = |sampler: u64, node: u64, path: &str| json!({ "sampler": sampler, "target": { "node": node, "path": path } });
    for (interpolation, output, at_two) in [("LINEAR", moves, 5.0), ("STEP", moves, 0.0), ("CUBICSPLINE", spline, 5.0)] {
        file.root["animations"] = json!([{
            "channels": [channel(0, 0, "rotation"), channel(1, 3, "translation")],
            "samplers": [sampler(turn, "LINEAR"), sampler(output, interpolation)],
        }]);
        let scene = file.read();
        // Without a frame nothing changes.
        let corners = |scene: &Scene| scene.shapes[0].world_positions();
        assert_eq!((corners(&scene), &scene.camera), (corners(&rest), &rest.camera));
        assert_eq!(report(&scene).contains("straight pieces"), interpolation == "CUBICSPLINE");
        // The body takes the light along.
        let light = |scene: &Scene| scene.lights[0].delta().expect("a light with a place").position;
        assert!(!report(&scene).contains("animation of a light"), "{}", report(&scene));
        assert!((light(&scene) - glam::DVec3::new(1.0, 7.0, 3.0)).length() < 1e-5, "{}", light(&scene));
        let at_three = scene.at_frame(72.0).expect("it can be rendered");
        assert!((light(&at_three) - glam::DVec3::new(11.0, 7.0, 3.0)).length() < 1e-5, "{}", light(&at_three));
        // The corner (-1, -1, 0) is turned by 0, 45 and 90 degrees about the shoulder's place, which the body moves.
        let near = |found: glam::Vec3, expected: [f32; 3]| {
            assert!((found - glam::Vec3::from(expected)).length() < 1e-4, "{interpolation} {found}")
        };
        near(corner(&scene, 0.0), [-1.0, 4.0, 0.0]);
        near(corner(&scene, 2.0), [at_two, 5.0 - 2.0 * half, 0.0]);
        near(corner(&scene, 3.0), [11.0, 4.0, 0.0]);
        let camera = scene.at_frame(72.0).expect("it can be rendered").camera;
        assert!((camera.position - glam::DVec3::new(10.0, 5.0, 4.0)).length() < 1e-5, "{}", camera.position);
    }
    // Cubics: three quarters of the way in time are 27/32 of the way along it, and straight pieces are near.
    let found = corner(&file.read(), 2.5).x + 67.5_f32.to_radians().cos() - 67.5_f32.to_radians().sin();
    assert!((found - 10.0 * 27.0 / 32.0).abs() < 0.05, "{found}");
}

#[test]
fn animations_that_are_broken_are_left_out_with_a_word() {
    for (animation, words) in [
        (json!({ "channels": 5 }), "it cannot be read"),
        (json!({ "channels": [{ "target": { "node": 99, "path": "scale" } }] }), "there is no nodes[99]"),
        (json!({ "channels": [{ "target": { "node": 0, "path": "scale" } }] }), "there is no samplers[0]"),
        (json!({ "channels": [{ "target": { "node": 0, "path": "colour" } }] }), "it moves the property `colour`"),
    ] {
        let mut file = File::new();
        file.root["animations"] = json!([animation]);
        let found = report(&file.read());
        assert!(found.contains(words), "{found}");
    }
}

#[test]
fn textures_are_turned_with_their_coordinates() {
    let mut file = File::new();
    let uvs = file.add("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.5, 0.25]);
    let folder = tempfile::tempdir().expect("a folder");
    image::RgbImage::new(2, 2).save(folder.path().join("a.png")).expect("a picture");
    let picture = file.bytes(&std::fs::read(folder.path().join("a.png")).expect("it is there"));
    file.root["images"] = json!([{ "bufferView": picture, "mimeType": "image/png" }]);
    file.root["textures"] = json!([{ "source": 0, "sampler": 0 }]);
    file.root["samplers"] = json!([{ "wrapS": 33071, "wrapT": 33071, "magFilter": 9728 }]);
    file.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uvs);
    let base = &mut file.root["materials"][0]["pbrMetallicRoughness"];
    base["baseColorFactor"] = json!([1.0, 1.0, 1.0, 1.0]);
    base["baseColorTexture"] = json!({ "index": 0 });
    assert_eq!(mesh(&file.read(), 0).uvs, [[0.0, 1.0], [1.0, 1.0], [0.5, 0.75]].map(glam::Vec2::from));
    file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
        json!({ "KHR_texture_transform": { "offset": [0.25, 0.5], "scale": [2.0, 1.0] } });
    let scene = file.read();
    assert_eq!(mesh(&scene, 0).uvs[2], glam::Vec2::new(1.25, 0.25));
    assert!(matches!(scene.materials[0].kind, MaterialKind::Diffuse { .. }));
    let folder = Folder::new(&[("a.gltf", &file.text())]);
    assert_eq!(super::picture(&folder.valid("a.gltf")), super::picture(&folder.written("a.gltf")));
}

/// A file whose base colour and metallic-roughness pictures, of 2 × 2 texels, lie differently on the triangle.
fn with_two_placements(base: Value, roughness: Value, normal: Option<Value>) -> File {
    let mut file = File::new();
    let uvs = file.add("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.5, 1.0]);
    file.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uvs);
    file.root["images"] = json!([{ "uri": "a.png" }]);
    file.root["textures"] = json!([{ "source": 0, "sampler": 0 }]);
    file.root["samplers"] = json!([{ "magFilter": 9728 }]);
    let info = |transform: Value| json!({ "index": 0, "extensions": { "KHR_texture_transform": transform } });
    file.root["materials"][0] = json!({ "pbrMetallicRoughness": {
        "baseColorTexture": info(base), "metallicRoughnessTexture": info(roughness) } });
    if let Some(normal) = normal {
        file.root["materials"][0]["normalTexture"] = info(normal);
    }
    file
}

/// The same scene by hand, each texture with a placement of its own.
fn with_placements_by_hand(base: &str, roughness: &str) -> String {
    let texture = |name: &str, space: &str, placement: &str| {
        format!(
            "[[texture]]\nname = \"{name}\"\ntype = \"image\"\nfile = \"a.png\"\ncolor_space = \"{space}\"\nfilter = \"nearest\"\n{placement}\n"
        )
    };
    format!(
        "[film]\nsize = [512, 256]\n[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\nvfov = {}\n{}{}\
         [[material]]\nname = \"a\"\ntype = \"principled\"\nbase_color = {{ texture = \"base\" }}\n\
         metallic = {{ texture = \"orm\", channel = \"b\" }}\nroughness = {{ texture = \"orm\", channel = \"g\" }}\nior = 1.5\n\
         [[shape]]\ntype = \"mesh\"\nmaterial = \"a\"\npositions = [[-1, -1, 0], [1, -1, 0.5], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n\
         uvs = [[0, 1], [1, 1], [0.5, 0]]\n[[light]]\ntype = \"point\"\nposition = [1, 2, 3]\nintensity = [40, 20, 10]\n",
        0.7_f64.to_degrees(),
        texture("base", "srgb", base),
        texture("orm", "linear", roughness),
    )
}

/// By hand: v runs upward here, so that (u, 1 - v) is looked up; a turn of 90 degrees leads (u, v) to (v, -u) there.
#[test]
fn each_texture_lies_as_its_own_transform_says() {
    let base = json!({ "offset": [0.25, 0.5], "scale": [2.0, 3.0] });
    let turned = json!({ "rotation": std::f64::consts::FRAC_PI_2 });
    let mut pixels = image::RgbImage::new(2, 2);
    for (place, colour) in pixels.pixels_mut().zip([[250, 20, 30], [40, 250, 60], [70, 80, 250], [200, 190, 20]]) {
        *place = image::Rgb(colour);
    }
    let mut png = std::io::Cursor::new(Vec::new());
    pixels.write_to(&mut png, image::ImageFormat::Png).expect("memory can be written to");
    let file = with_two_placements(base.clone(), turned.clone(), None);
    let by_hand =
        with_placements_by_hand("scale = [2, 3]\nrotation = 0\noffset = [0.25, -2.5]", "rotation = 90\noffset = [1, 1]");
    let wrong = with_placements_by_hand("scale = [2, 3]\nrotation = 0\noffset = [0.25, -2.5]", "");
    let folder = Folder::new(&[
        ("a.png", &png.into_inner()),
        ("a.gltf", &file.text()),
        ("b.toml", by_hand.as_bytes()),
        ("c.toml", wrong.as_bytes()),
        ("d.gltf", &with_two_placements(base.clone(), base.clone(), None).text()),
        ("e.gltf", &with_two_placements(base.clone(), turned.clone(), Some(turned)).text()),
        ("f.gltf", &with_two_placements(base, json!({}), Some(json!({ "rotation": 0.5 }))).text()),
    ]);
    let scene = folder.valid("a.gltf");
    assert_eq!(report(&scene), "");
    let expected = picture(&folder.valid("b.toml"));
    assert_eq!(picture(&scene), expected);
    assert_eq!(picture(&folder.written("a.gltf")), expected);
    assert_ne!(picture(&folder.valid("c.toml")), expected, "the control");
    // What lies alike is applied to the mesh.
    let alike = folder.valid("d.gltf");
    assert!(mesh(&alike, 0).uvs[1].abs_diff_eq(glam::Vec2::new(2.25, 0.5), 1e-6), "{:?}", mesh(&alike, 0).uvs);
    // A normal map that is turned has the mesh's coordinates, so that its directions are turned as well.
    let turned = folder.valid("e.gltf");
    assert!(mesh(&turned, 0).uvs[1].abs_diff_eq(glam::Vec2::new(0.0, 2.0), 1e-6), "{:?}", mesh(&turned, 0).uvs);
    assert_eq!(report(&turned), "");
    assert!(report(&folder.valid("f.gltf")).contains("KHR_texture_transform of the base colour x1"), "a shear");
}

/// A colour by the second set and a roughness by the first, as by hand; a third set is approximated.
#[test]
fn textures_lie_by_two_sets_of_coordinates() {
    let file = |sets: [u64; 3], normal: bool| {
        let mut file = with_two_placements(
            json!({ "offset": [0.25, 0.5], "scale": [2.0, 3.0], "texCoord": sets[0] }),
            json!({ "texCoord": sets[1] }),
            None,
        );
        for set in [1, 2] {
            let uvs = file.add("VEC2", &[0.3, 0.1, 0.9, 0.4, 0.2, 0.8]);
            file.root["meshes"][0]["primitives"][0]["attributes"][format!("TEXCOORD_{set}")] = json!(uvs);
        }
        if normal {
            file.root["materials"][0]["normalTexture"] = json!({ "index": 0, "texCoord": sets[2] });
        }
        file
    };
    let pixels = image::RgbImage::from_fn(2, 2, |x, y| {
        image::Rgb([(200 - 90 * x) as u8, (60 + 120 * y) as u8, (40 + 70 * x + 90 * y) as u8])
    });
    let mut png = std::io::Cursor::new(Vec::new());
    pixels.write_to(&mut png, image::ImageFormat::Png).expect("memory can be written to");
    let by_hand = |uvs: &str| {
        with_placements_by_hand("scale = [2, 3]\nrotation = 0\noffset = [0.25, -2.5]\nsecond_uvs = true", "")
            .replace("uvs = [[0, 1], [1, 1], [0.5, 0]]", uvs)
    };
    let right = by_hand("uvs = [[0, 1], [1, 1], [0.5, 0]]\nsecond_uvs = [[0.3, 0.9], [0.9, 0.6], [0.2, 0.2]]");
    let wrong = by_hand("uvs = [[0, 1], [1, 1], [0.5, 0]]\nsecond_uvs = [[0.3, 0.9], [0.9, 0.6], [0.2, 0.3]]");
    let without = file([1, 0, 0], false).text();
    let folder = Folder::new(&[
        ("a.png", &png.into_inner()),
        ("a.gltf", &without),
        ("b.toml", right.as_bytes()),
        ("c.toml", wrong.as_bytes()),
        ("d.gltf", &file([0, 1, 1], true).text()),
        ("e.gltf", &file([0, 1, 2], true).text()),
    ]);
    let scene = folder.valid("a.gltf");
    assert_eq!(report(&scene), "");
    // The first texture's set is the mesh's first.
    assert_eq!(scene.textures.iter().filter(|texture| texture.by_second_uvs).count(), 1);
    let expected = picture(&folder.valid("b.toml"));
    assert_eq!(picture(&scene), expected);
    assert_eq!(picture(&folder.written("a.gltf")), expected);
    assert_ne!(picture(&folder.valid("c.toml")), expected, "the control");
    // Directions follow the first set, so that is the normal map's.
    let with_normals = folder.valid("d.gltf");
    assert_eq!(report(&with_normals), "");
    assert_eq!(mesh(&with_normals, 0).uvs[0], glam::Vec2::new(0.3, 0.9));
    assert!(report(&folder.valid("e.gltf")).contains("set of texture coordinates of the"), "{}", report(&folder.valid("e.gltf")));
}

/// KHR_materials_sheen and KHR_materials_volume, whose defaults have no effect.
#[test]
fn sheen_and_volumes_are_read() {
    let material = |sheen: Value, volume: Value| {
        let mut file = File::new();
        file.root["materials"][0]["extensions"] = json!({ "KHR_materials_transmission": { "transmissionFactor": 1.0 }, "KHR_materials_sheen": sheen, "KHR_materials_volume": volume });
        file.root["extensionsUsed"] =
            json!(["KHR_lights_punctual", "KHR_materials_transmission", "KHR_materials_sheen", "KHR_materials_volume"]);
        let folder = Folder::new(&[("a.gltf", &file.text())]);
        let scene = folder.valid("a.gltf");
        assert!(!report(&scene).contains("sheen") && !report(&scene).contains("volume"), "{}", report(&scene));
        assert_eq!(picture(&folder.written("a.gltf")), picture(&scene));
        let MaterialKind::Principled(principled) = &scene.materials[0].kind else { panic!("{:?}", scene.materials[0]) };
        (**principled).clone()
    };
    let written = material(
        json!({ "sheenColorFactor": [0.5, 0.25, 1.5], "sheenRoughnessFactor": 0.75 }),
        json!({ "thicknessFactor": 1.0, "attenuationColor": [1.0, 0.5, 0.0], "attenuationDistance": 2.5 }),
    );
    assert_eq!(written.sheen_color, ColorInput::Constant(DVec3::new(0.5, 0.25, 1.0)));
    assert_eq!(written.sheen_roughness, ColorInput::grey(0.75));
    assert_eq!(written.attenuation, Some(Attenuation { color: DVec3::new(1.0, 0.5, 0.0), distance: 2.5 }));
    let plain = material(json!({}), json!({ "thicknessFactor": 1.0, "attenuationColor": [0.5, 0.5, 0.5] }));
    assert_eq!((plain.sheen_color, plain.attenuation, plain.thin), (ColorInput::grey(0.0), None, false));
}

/// A coat has the normals of its own texture, and without one those of the surface, whatever bends the normals below it.
#[test]
fn coats_have_normal_maps_of_their_own() {
    let coated = |normal: Option<Value>| {
        let mut file = with_normals();
        let mut coat = json!({ "clearcoatFactor": 0.9, "clearcoatRoughnessFactor": 0.1 });
        normal.into_iter().for_each(|normal| coat["clearcoatNormalTexture"] = normal);
        file.root["materials"][0]["extensions"] = json!({ "KHR_materials_clearcoat": coat });
        let folder = Folder::new(&[("a.gltf", &file.text())]);
        let scene = folder.valid("a.gltf");
        assert!(!report(&scene).contains("clearcoat"), "{}", report(&scene));
        assert_eq!(picture(&folder.written("a.gltf")), picture(&scene));
        let MaterialKind::Principled(principled) = &scene.materials[0].kind else { panic!("{:?}", scene.materials[0]) };
        assert!(scene.materials[0].normal_map.is_some());
        (principled.coat_normal_map, picture(&scene))
    };
    let (none, even) = coated(None);
    assert_eq!(none, None);
    let (weak, bent) = coated(Some(json!({ "index": 0, "scale": 0.5 })));
    assert_eq!(weak.map(|map| map.scale), Some(0.5));
    let (full, bent_more) = coated(Some(json!({ "index": 0 })));
    assert_eq!(full.map(|map| map.scale), Some(1.0));
    assert!(even != bent && bent != bent_more, "the pictures are alike");
    // By coordinates of its own.
    let mut file = with_normals();
    let uvs = file.add("VEC2", &[0.3, 0.0, 0.0, 1.0, 1.0, 0.5]);
    file.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(uvs);
    file.root["materials"][0]["extensions"] = json!({ "KHR_materials_clearcoat": {
        "clearcoatFactor": 0.9, "clearcoatRoughnessFactor": 0.1, "clearcoatNormalTexture": { "index": 0, "texCoord": 1 } } });
    let scene = file.read();
    let MaterialKind::Principled(principled) = &scene.materials[0].kind else { panic!("{:?}", scene.materials[0]) };
    let map = principled.coat_normal_map.expect("it has one");
    assert!(scene.textures[map.texture].by_second_uvs && report(&scene).is_empty(), "{}", report(&scene));
    assert!(picture(&scene) != bent_more, "the pictures are alike");
}

/// Of the texture, red and green are the direction and blue is the strength.
#[test]
fn directions_of_anisotropy_are_read() {
    let brushed = |anisotropy: Value| {
        let mut file = with_normals();
        file.root["materials"][0]["extensions"] = json!({ "KHR_materials_anisotropy": anisotropy });
        let folder = Folder::new(&[("a.gltf", &file.text())]);
        let scene = folder.valid("a.gltf");
        assert!(!report(&scene).contains("anisotropy"), "{}", report(&scene));
        assert_eq!(picture(&folder.written("a.gltf")), picture(&scene));
        let MaterialKind::Principled(principled) = &scene.materials[0].kind else { panic!("{:?}", scene.materials[0]) };
        ((**principled).clone(), picture(&scene))
    };
    let (even, plain) = brushed(json!({ "anisotropyStrength": 0.75 }));
    assert_eq!((even.anisotropy, even.anisotropy_direction), (Some(ColorInput::grey(0.75)), None));
    let texture = json!({ "anisotropyStrength": 0.75, "anisotropyRotation": 0.5, "anisotropyTexture": { "index": 0 } });
    let (textured, turned) = brushed(texture);
    let direction = textured.anisotropy_direction.expect("it has a direction");
    let strength = ChannelInput { texture: direction, channel: Channel::B, factor: DVec3::splat(0.75), is_squared: false };
    assert_eq!(textured.anisotropy, Some(ColorInput::Channel(strength)));
    assert!((textured.anisotropy_rotation_degrees - 0.5_f64.to_degrees()).abs() < 1e-12);
    assert!(plain != turned, "the pictures are alike");
    // Without a strength there is none.
    let (none, _) = brushed(json!({ "anisotropyTexture": { "index": 0 } }));
    assert_eq!((none.anisotropy, none.anisotropy_direction), (None, None));
}

/// A triangle with a normal map of 4 × 4 texels.
fn with_normals() -> File {
    let mut file = File::new();
    let uvs = file.add("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.5, 1.0]);
    file.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uvs);
    let mut png = Vec::new();
    let texels = image::RgbImage::from_fn(4, 4, |x, y| image::Rgb([100 + 30 * x as u8, 90 + 40 * y as u8, 230]));
    texels.write_to(&mut std::io::Cursor::new(&mut png), image::ImageFormat::Png).expect("encoding to memory works");
    let picture = file.bytes(&png);
    file.root["images"] = json!([{ "bufferView": picture, "mimeType": "image/png" }]);
    file.root["textures"] = json!([{ "source": 0 }]);
    file.root["materials"][0] = json!({
        "pbrMetallicRoughness": { "baseColorFactor": [0.7, 0.4, 0.2, 1.0], "metallicFactor": 0.5, "roughnessFactor": 0.6 },
        "normalTexture": { "index": 0, "scale": 2.0 },
    });
    file
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
    assert!(matches!(&file.read().lights[0], Light::Directional(light) if light.irradiance.x == 3.0));
    file.root["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = json!(2);
    assert!(file.refused().contains("no light of type `area`"));
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
        ("/asset/version", json!(7), "is not valid glTF"),
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

/// The base colour of a painted primitive is a texture of its own, that a scene file says as well.
#[test]
fn vertex_colours_become_a_texture() {
    let mut file = File::new();
    assert!(file.read().textures.is_empty());
    file.paint();
    let folder = Folder::new(&[("a.gltf", &file.text())]);
    let scene = folder.valid("a.gltf");
    assert_eq!(scene.textures.len(), 1);
    let painted = &scene.materials[scene.shapes[0].material];
    assert!(painted.kind.lobe().is_some_and(|lobe| lobe.color0.texture() == Some(0)), "{painted:?}");
    let gpt::scene::TextureKind::Image(image) = &scene.textures[0].kind else { panic!("no image") };
    let texels: Vec<_> = image.image.texels.colors().take(3).map(|texel| texel.to_array()).collect();
    assert_eq!(texels, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.5, 1.0]]);
    assert_eq!(picture(&folder.written("a.gltf")), picture(&scene));
    assert!(!report(&scene).contains("COLOR_0"));
}

/// Vertex colours multiply the base colour's texture, whatever it is, and their alpha the texture's.
#[test]
fn vertex_colours_multiply_textures() {
    let file = |texture: Option<&str>, alpha: [f32; 3], mode: &str| {
        let mut file = File::new();
        file.paint();
        let colours = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.5, 1.0]];
        let numbers: Vec<f32> = colours.into_iter().zip(alpha).flat_map(|([r, g, b], a)| [r, g, b, a]).collect();
        let colours = file.add("VEC4", &numbers);
        let uvs = file.add("VEC2", &[0.3, 0.1, 0.9, 0.4, 0.2, 0.8]);
        let attributes = &mut file.root["meshes"][0]["primitives"][0]["attributes"];
        attributes["COLOR_0"] = json!(colours);
        attributes["TEXCOORD_0"] = json!(uvs);
        file.root["materials"][0] = json!({ "alphaMode": mode, "pbrMetallicRoughness": { "metallicFactor": 0.0 },
            "extensions": { "KHR_materials_specular": { "specularFactor": 0.0 } } });
        if let Some(uri) = texture {
            file.root["images"] = json!([{ "uri": uri }]);
            file.root["textures"] = json!([{ "source": 0 }]);
            file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
        }
        file.text()
    };
    let picture_of = |colour: [u8; 4]| {
        let mut png = std::io::Cursor::new(Vec::new());
        image::RgbaImage::from_pixel(2, 2, image::Rgba(colour)).write_to(&mut png, image::ImageFormat::Png).expect("it fits");
        png.into_inner()
    };
    let (opaque, seen) = ([1.0; 3], [1.0, 0.5, 0.0]);
    let folder = Folder::new(&[
        ("white.png", &picture_of([255; 4])),
        ("red.png", &picture_of([255, 0, 0, 255])),
        ("clear.png", &picture_of([255, 255, 255, 0])),
        ("plain.gltf", &file(None, opaque, "OPAQUE")),
        ("white.gltf", &file(Some("white.png"), opaque, "OPAQUE")),
        ("red.gltf", &file(Some("red.png"), opaque, "OPAQUE")),
        ("ignored.gltf", &file(Some("white.png"), seen, "OPAQUE")),
        ("seen.gltf", &file(None, seen, "BLEND")),
        ("white-seen.gltf", &file(Some("white.png"), seen, "BLEND")),
        ("clear.gltf", &file(Some("clear.png"), seen, "BLEND")),
        ("nothing.gltf", &file(Some("clear.png"), opaque, "BLEND")),
    ]);
    let white = folder.valid("white.gltf");
    assert_eq!(report(&white), "");
    assert_eq!(white.textures.iter().filter(|texture| texture.times.is_some()).count(), 1);
    let of = |name: &str| picture(&folder.valid(name));
    let plain = of("plain.gltf");
    assert_eq!(picture(&white), plain);
    assert_eq!(picture(&folder.written("white.gltf")), plain);
    assert_eq!(of("ignored.gltf"), plain, "alpha of what is opaque");
    assert_ne!(of("red.gltf"), plain, "the control");
    let green = |name: &str| of(name).iter().map(|pixel| f32::from_bits(pixel[1])).fold(0.0, f32::max);
    assert_eq!(green("red.gltf"), 0.0);
    assert!(green("white.gltf") > 0.0);
    // What is behind shows through as far as alpha says.
    let seen = of("seen.gltf");
    assert_ne!(seen, plain, "the control");
    assert_eq!(of("white-seen.gltf"), seen);
    assert_eq!(of("clear.gltf"), of("nothing.gltf"));
    assert_ne!(of("clear.gltf"), seen, "the control");
}

/// One of several materials is chosen by its variant's name; an unknown name is told with those that there are.
#[test]
fn variants_of_materials_are_chosen_by_name() {
    let mut file = File::new();
    let mut green = file.root["materials"][0].clone();
    green["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.1, 0.8, 0.2, 1.0]);
    file.root["materials"].as_array_mut().expect("a list").push(green);
    file.root["extensionsUsed"].as_array_mut().expect("a list").push(json!("KHR_materials_variants"));
    file.root["extensions"]["KHR_materials_variants"] = json!({ "variants": [{ "name": "worn" }, { "name": "new" }] });
    file.root["meshes"][0]["primitives"][0]["extensions"] =
        json!({ "KHR_materials_variants": { "mappings": [{ "material": 1, "variants": [1] }] } });
    let folder = Folder::new(&[("a.gltf", &file.text())]);
    let of =
        |variant: &str| folder.load_as("a.gltf", &LoadOptions { variant: Some(variant.to_owned()), ..LoadOptions::default() });
    let red_of = |scene: Scene| match scene.materials[scene.shapes[0].material].kind {
        MaterialKind::Diffuse { reflectance: gpt::scene::ColorInput::Constant(colour) } => colour.x,
        ref other => panic!("{other:?}"),
    };
    assert_eq!(of("new").map(red_of).ok(), Some(0.1));
    // What a variant says nothing of stays as it is.
    assert_eq!(of("worn").map(red_of).ok(), Some(0.7));
    let plain = folder.valid("a.gltf");
    assert!(report(&plain).contains("--variant chooses worn, new"), "{}", report(&plain));
    assert_eq!(red_of(plain), 0.7);
    let message = refusal(of("old"));
    assert!(message.contains("old") && message.contains("worn") && message.contains("new"), "{message}");
}
