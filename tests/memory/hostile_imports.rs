//! Damaged scenes of other programs, and damaged meshes that they name: each is read or refused, soon, and within a bound of memory. The long form
//! (`scripts/test --full`) makes 100,000 of each kind, and `GPT_FUZZ_CASES` says how many otherwise.

use std::io::Write as _;

use base64::Engine as _;
use serde_json::{Value, json};

use crate::common::files::{folder_with, png_bytes};
use crate::counting::take_turn;
use crate::hostile::{MOST_FOR_TEXTS, Tally, answer_of, cases, damaged, with_bits_turned};
use crate::random::SplitMix64;
use gpt::load;

const NORMALLY: usize = 40;
const IN_FULL: usize = 100_000;

/// Damages `whole`, puts it into the file `name` by way of `pack`, and reads `scene`, which is that file or names it.
fn damage(kind: &'static str, name: &str, whole: &[u8], others: &[(&str, &[u8])], scene: &str, pack: impl Fn(&[u8]) -> Vec<u8>) {
    let count = cases(NORMALLY, IN_FULL);
    let is_text = std::str::from_utf8(whole).is_ok();
    let folder = folder_with(others);
    let path = |name: &str| folder.path().join(name);
    let read = |bytes: &[u8]| {
        std::fs::write(path(name), pack(bytes)).expect("the folder can be written to");
        let loaded = load::load(path(scene).to_str());
        // A scene that is valid without a frame may be invalid at one.
        if let Ok(scene) = &loaded {
            let _ = scene.at_frame(7.0);
        }
        answer_of(loaded)
    };
    let _turn = take_turn();
    let mut tally = Tally::new(kind, MOST_FOR_TEXTS);
    let mut random = SplitMix64::new(7);
    tally.undamaged(whole, read);
    // By turns: bits that leave the file as it is but for a number, and pieces that move what follows.
    let damage = |bytes: &[u8], round: usize, random: &mut SplitMix64| match round % 2 {
        0 => with_bits_turned(bytes, random),
        _ => damaged(bytes, random, is_text),
    };
    tally.hunt(whole, count, &mut random, damage, read);
    tally.judge();
}

fn as_it_is(bytes: &[u8]) -> Vec<u8> {
    bytes.to_vec()
}

/// Data of a glTF, and views and accessors of them.
#[derive(Default)]
struct Data {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Data {
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.views.push(json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() }));
        self.bytes.extend(bytes);
        // Accessors start at whole numbers of their components.
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.len() - 1
    }

    fn enter(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        self.accessors.push(json!({ "bufferView": view, "componentType": component, "type": kind, "count": count }));
        self.accessors.len() - 1
    }

    fn floats(&mut self, kind: &str, count: usize, numbers: &[f32]) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        self.enter(&bytes, 5126, kind, count)
    }
}

/// A triangle with all that a glTF can say of it, and its data.
fn gltf() -> (Value, Vec<u8>) {
    let mut data = Data::default();
    let positions = data.floats("VEC3", 3, &[-1.0, -1.0, 0.0, 1.0, -1.0, 0.5, 0.0, 1.0, 0.0]);
    let sparse_at = data.view(&[1, 0]);
    let sparse_values = data.view(&[0; 12]);
    data.accessors[positions]["sparse"] = json!({ "count": 1, "indices": { "bufferView": sparse_at, "componentType": 5123 }, "values": { "bufferView": sparse_values } });
    let normals = data.floats("VEC3", 3, &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    let uvs = data.floats("VEC2", 3, &[0.0, 0.0, 1.0, 0.0, 0.5, 1.0]);
    let colours = data.enter(&[255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255], 5121, "VEC4", 3);
    data.accessors[colours]["normalized"] = json!(true);
    let joints = data.enter(&[0; 12], 5121, "VEC4", 3);
    let weights = data.floats("VEC4", 3, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    let indices = data.enter(&[0, 1, 2], 5121, "SCALAR", 3);
    let times = data.floats("SCALAR", 2, &[0.0, 1.0]);
    let places = data.floats("VEC3", 2, &[0.0, 0.0, 0.0, 0.5, 0.0, 0.0]);
    let shares = data.floats("SCALAR", 2, &[0.0, 1.0]);
    let picture = data.view(&png_bytes([200, 100, 50]));
    let root = json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0, 1, 2, 4] }],
        "nodes": [
            { "mesh": 0, "rotation": [0.0, 0.0, 0.0, 1.0] },
            { "camera": 0, "translation": [0.0, 0.0, 4.0] },
            { "extensions": { "KHR_lights_punctual": { "light": 0 } }, "translation": [1.0, 2.0, 3.0], "children": [3] },
            { "mesh": 1, "extensions": { "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } } } },
            { "mesh": 2, "skin": 0 },
        ],
        "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1, "aspectRatio": 2.0 } }],
        "meshes": [
            { "primitives": [{ "material": 0, "indices": indices,
                "attributes": { "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs } }] },
            { "primitives": [{ "attributes": { "POSITION": positions, "COLOR_0": colours } }] },
            { "weights": [0.5], "primitives": [{ "attributes": { "POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights },
                "targets": [{ "POSITION": normals }] }] },
        ],
        "skins": [{ "joints": [0] }],
        "animations": [{ "samplers": [{ "input": times, "output": places }, { "input": times, "output": shares }], "channels": [
            { "sampler": 0, "target": { "node": 0, "path": "translation" } }, { "sampler": 1, "target": { "node": 4, "path": "weights" } },
        ] }],
        "images": [{ "bufferView": picture, "mimeType": "image/png" }],
        "samplers": [{ "wrapS": 33071 }],
        "textures": [{ "source": 0, "sampler": 0 }],
        "materials": [{
            "alphaMode": "MASK", "alphaCutoff": 0.4, "doubleSided": true, "emissiveFactor": [0.1, 0.2, 0.3],
            "pbrMetallicRoughness": { "baseColorTexture": { "index": 0, "extensions": { "KHR_texture_transform": { "rotation": 0.3 } } },
                "metallicFactor": 0.5, "metallicRoughnessTexture": { "index": 0 } },
            "normalTexture": { "index": 0, "scale": 0.5 },
            "extensions": { "KHR_materials_clearcoat": { "clearcoatFactor": 0.5 }, "KHR_materials_ior": { "ior": 1.4 },
                "KHR_materials_transmission": { "transmissionFactor": 0.2 }, "KHR_materials_anisotropy": { "anisotropyStrength": 0.2 },
                "KHR_materials_specular": { "specularFactor": 0.5 }, "KHR_materials_emissive_strength": { "emissiveStrength": 2.0 } },
        }],
        "extensions": { "KHR_lights_punctual": { "lights": [{ "type": "spot", "spot": { "outerConeAngle": 0.5 }, "intensity": 40.0 }] } },
        "bufferViews": data.views,
        "accessors": data.accessors,
        "buffers": [{ "byteLength": data.bytes.len() }],
    });
    (root, data.bytes)
}

#[test]
fn damaged_gltf() {
    let (mut root, data) = gltf();
    let text = base64::engine::general_purpose::STANDARD.encode(&data);
    root["buffers"][0]["uri"] = json!(format!("data:application/octet-stream;base64,{text}"));
    damage("glTF", "a.gltf", root.to_string().as_bytes(), &[], "a.gltf", as_it_is);
}

#[test]
fn damaged_binary_gltf() {
    let (root, data) = gltf();
    damage("binary glTF", "a.glb", &binary(&root, &data), &[], "a.glb", as_it_is);
}

/// JSON and data as one file.
fn binary(root: &Value, data: &[u8]) -> Vec<u8> {
    let mut text = root.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF".to_vec();
    for number in [2, 28 + text.len() + data.len(), text.len()] {
        bytes.extend((number as u32).to_le_bytes());
    }
    let chunks: [&[u8]; 5] = [b"JSON", &text, &(data.len() as u32).to_le_bytes(), b"BIN\0", data];
    bytes.extend(chunks.concat());
    bytes
}

/// Two triangles that share an edge, as meshoptimizer packs them.
const PACKED_TRIANGLES: [u8; 19] =
    [0xe1, 0xf0, 0x10, 0x00, 0x76, 0x87, 0x56, 0x67, 0x78, 0xa9, 0x86, 0x65, 0x89, 0x68, 0x98, 0x01, 0x69, 0x00, 0x00];

/// Elements of up to 16 as meshoptimizer packs them, each difference as a whole byte.
fn packed_attributes(elements: &[[u8; 8]]) -> Vec<u8> {
    let mut bytes = vec![0xa0];
    for place in 0..8 {
        let mut differences = [0; 16];
        let mut before = 0;
        for (difference, element) in differences.iter_mut().zip(elements) {
            let step = element[place].wrapping_sub(before);
            *difference = (step << 1) ^ (0_u8.wrapping_sub(step >> 7));
            before = element[place];
        }
        bytes.push(0b11);
        bytes.extend(differences);
    }
    bytes.extend([0; 32]);
    bytes
}

#[test]
fn damaged_packed_gltf() {
    let corner = |x: i16, y: i16| {
        let mut element = [0; 8];
        element[..2].copy_from_slice(&x.to_le_bytes());
        element[2..4].copy_from_slice(&y.to_le_bytes());
        element
    };
    let corners = [corner(0, 0), corner(i16::MAX, 0), corner(0, i16::MAX), corner(i16::MAX, 300)];
    let positions = packed_attributes(&corners);
    let mut data = positions.clone();
    data.resize(data.len().next_multiple_of(4), 0);
    let start = data.len();
    data.extend(PACKED_TRIANGLES);
    let packed = |offset: usize, length: usize, count: u32, stride: u32, mode: &str| {
        json!({ "EXT_meshopt_compression": { "buffer": 0, "byteOffset": offset, "byteLength": length, "count": count, "byteStride": stride,
            "mode": mode, "filter": "NONE" } })
    };
    let root = json!({
        "asset": { "version": "2.0" },
        "extensionsRequired": ["EXT_meshopt_compression", "KHR_mesh_quantization"],
        "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
        "accessors": [
            { "bufferView": 0, "componentType": 5122, "normalized": true, "type": "VEC3", "count": 4 },
            { "bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 6 },
        ],
        "bufferViews": [
            { "buffer": 1, "byteLength": 32, "byteStride": 8, "extensions": packed(0, positions.len(), 4, 8, "ATTRIBUTES") },
            { "buffer": 1, "byteLength": 12, "extensions": packed(start, PACKED_TRIANGLES.len(), 6, 2, "TRIANGLES") },
        ],
        "buffers": [{ "byteLength": data.len() }, { "byteLength": 44, "extensions": { "EXT_meshopt_compression": { "fallback": true } } }],
    });
    damage("packed glTF", "a.glb", &binary(&root, &data), &[], "a.glb", as_it_is);
}

#[test]
fn damaged_mitsuba_scenes() {
    let scene = r#"<scene version="3.0.0"><default name="r" value="1"/><integrator type="path"><integer name="max_depth" value="4"/></integrator>
        <sensor type="thinlens"><float name="fov" value="40"/><float name="aperture_radius" value="0.1"/><float name="focus_distance" value="4"/>
        <transform name="to_world"><lookat origin="0,0,4" target="0,0,0" up="0,1,0"/></transform><film type="hdrfilm">
        <integer name="crop_width" value="20"/></film></sensor>
        <bsdf type="mask" id="m"><float name="opacity" value="0.5"/><bsdf type="roughconductor"><string name="material" value="W"/></bsdf></bsdf>
        <shape type="sphere"><float name="radius" value="$r"/><ref id="m"/></shape>
        <shape type="shapegroup" id="g"><shape type="cube"/></shape>
        <shape type="instance"><ref id="g"/><transform name="to_world"><rotate x="1" angle="20"/><scale value="0.5"/></transform></shape>
        <shape type="cylinder"><bsdf type="plastic"><spectrum name="diffuse_reflectance" value="400:0.1, 600:0.5"/></bsdf></shape>
        <bsdf type="bumpmap" id="bumps"><texture type="bitmap"><string name="filename" value="h.png"/></texture><float name="scale" value="0.1"/>
        <bsdf type="diffuse"/></bsdf>
        <shape type="rectangle"><ref id="bumps"/></shape>
        <emitter type="spot"><texture name="texture" type="checkerboard"/></emitter>
        <emitter type="projector"><texture name="irradiance" type="checkerboard"/><float name="fov" value="30"/></emitter></scene>"#;
    damage("Mitsuba scene", "a.xml", scene.as_bytes(), &[("h.png", &png_bytes([9, 8, 7]))], "a.xml", as_it_is);
}

#[test]
fn damaged_pbrt_scenes() {
    let scene = r#"LookAt 0 0 4 0 0 0 0 1 0
Camera "perspective" "float fov" 40 "float lensradius" 0.1 "float focaldistance" 4
Film "rgb" "integer xresolution" 40 "integer yresolution" 30 "float cropwindow" [ 0 0.5 0 1 ]
WorldBegin
Include "part.pbrt"
Texture "tiles" "spectrum" "checkerboard" "rgb tex1" [ 0.1 0.2 0.3 ]
Texture "heights" "float" "imagemap" "string filename" "h.png" "float scale" 0.1
MakeNamedMaterial "bumps" "string type" "coateddiffuse" "texture reflectance" "tiles" "texture displacement" "heights" "float roughness" 0.1
MakeNamedMaterial "metal" "string type" "conductor" "spectrum eta" "metal-Cu-eta" "spectrum k" [ 400 2 700 3 ]
MakeNamedMaterial "m" "string type" "mix" "string materials" [ "bumps" "metal" ] "float amount" 0.5
MakeNamedMedium "smoke" "string type" "uniformgrid" "integer nx" 2 "integer ny" 2 "float density" [ 0 1 2 3 ] "blackbody Le" 3000
ObjectBegin "o"
NamedMaterial "m"
Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 0 ] "integer indices" [ 0 1 2 1 3 2 ] "normal N" [ 0 0 1 0 0 1 0 0 1 0 0 1 ]
Shape "cylinder" "float phimax" 90
ObjectEnd
AttributeBegin
Rotate 20 1 0 0
ActiveTransform EndTime
Translate 0 1 0
ActiveTransform All
ObjectInstance "o"
MediumInterface "smoke" ""
Material "interface"
Shape "sphere" "float alpha" 0.5
AttributeEnd
AreaLightSource "diffuse" "rgb L" [ 1 2 3 ] "float power" 5
Shape "loopsubdiv" "integer levels" 2 "point3 P" [ 0 0 0 1 0 0 0 1 0 0 0 1 ] "integer indices" [ 0 2 1 0 1 3 1 2 3 2 0 3 ]
Shape "bilinearmesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 1 ]
LightSource "infinite" "rgb L" [ 1 2 3 ]"#;
    let others: [(&str, &[u8]); 2] = [("h.png", &png_bytes([9, 8, 7])), ("part.pbrt", b"LightSource \"point\"")];
    damage("pbrt scene", "a.pbrt", scene.as_bytes(), &others, "a.pbrt", as_it_is);
}

/// A scene around one mesh.
fn around(kind: &str, file: &str, bsdf: &str) -> String {
    format!(r#"<scene version="3.0.0"><shape type="{kind}"><string name="filename" value="{file}"/>{bsdf}</shape></scene>"#)
}

/// The content of a mesh in Mitsuba's own format, before it is packed.
fn serialized_content(version: u16, double: bool) -> Vec<u8> {
    let mut bytes = (0x1_u32 | 0x2 | if double { 0x2000 } else { 0x1000 }).to_le_bytes().to_vec();
    if version == 4 {
        bytes.extend(b"mesh\0");
    }
    [3_u64, 1].into_iter().for_each(|count| bytes.extend(count.to_le_bytes()));
    let positions = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let normals = [0.0, 0.0, 1.0].repeat(3);
    let uvs = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
    for number in positions.into_iter().chain(normals).chain(uvs) {
        if double { bytes.extend(f64::to_le_bytes(number)) } else { bytes.extend((number as f32).to_le_bytes()) }
    }
    [0_u32, 1, 2].into_iter().for_each(|corner| bytes.extend(corner.to_le_bytes()));
    bytes
}

/// A file of one such mesh.
fn serialized(version: u16, content: &[u8]) -> Vec<u8> {
    let head = [0x041c_u16.to_le_bytes(), version.to_le_bytes()].concat();
    let mut packed = flate2::write::ZlibEncoder::new(head, flate2::Compression::fast());
    packed.write_all(content).expect("memory can be written to");
    let mut bytes = packed.finish().expect("memory can be written to");
    bytes.extend(vec![0; if version == 4 { 8 } else { 4 }]);
    bytes.extend(1_u32.to_le_bytes());
    bytes
}

#[test]
fn damaged_serialized_meshes() {
    let scene = around("serialized", "b.serialized", "");
    let others: &[(&str, &[u8])] = &[("a.xml", scene.as_bytes())];
    let whole = serialized(4, &serialized_content(4, false));
    damage("serialized mesh", "b.serialized", &whole, others, "a.xml", as_it_is);
    // Damage behind the checksum of what is packed.
    for (kind, version, double) in [("content of a serialized mesh", 4, false), ("that of version 3", 3, true)] {
        let pack = |content: &[u8]| serialized(version, content);
        damage(kind, "b.serialized", &serialized_content(version, double), others, "a.xml", pack);
    }
}

/// Two triangles with colours of their vertices and numbers of their faces.
const PAINTED: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n\
    property uchar green\nproperty uchar blue\nelement face 2\nproperty list uchar int vertex_indices\nproperty float weight_0\nend_header\n\
    -1 -1 0 255 0 0\n1 -1 0 0 255 0\n1 1 0 0 0 255\n-1 1 0 255 255 0\n3 0 1 2 0.25\n3 0 2 3 0.75\n";

/// The file [`PAINTED`] in binary form.
fn binary_ply(big_endian: bool) -> Vec<u8> {
    let (header, data) = PAINTED.split_once("end_header\n").expect("a header has an end");
    let order = if big_endian { "binary_big_endian" } else { "binary_little_endian" };
    let mut bytes = format!("{}end_header\n", header.replace("ascii", order)).into_bytes();
    let four = |number: u32| if big_endian { number.to_be_bytes() } else { number.to_le_bytes() };
    for (row, line) in data.lines().enumerate() {
        for (column, word) in line.split(' ').enumerate() {
            let number: f32 = word.parse().expect("a number");
            match (row < 4, column) {
                (true, 0..3) | (false, 4) => bytes.extend(four(number.to_bits())),
                (true, _) | (false, 0) => bytes.push(number as u8),
                (false, _) => bytes.extend(four(number as u32)),
            }
        }
    }
    bytes
}

#[test]
fn damaged_ply_meshes() {
    let colour = r#"<bsdf type="diffuse"><texture name="reflectance" type="mesh_attribute"><string name="name" value="vertex_color"/></texture></bsdf>"#;
    let scene = around("ply", "b.ply", colour);
    let others: &[(&str, &[u8])] = &[("a.xml", scene.as_bytes())];
    let [little, big] = [false, true].map(binary_ply);
    for (kind, whole) in [("PLY", PAINTED.as_bytes()), ("binary PLY", &little), ("binary PLY, most significant byte first", &big)]
    {
        damage(kind, "b.ply", whole, others, "a.xml", as_it_is);
    }
    let pack = |bytes: &[u8]| {
        let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        packed.write_all(bytes).expect("memory can be written to");
        packed.finish().expect("memory can be written to")
    };
    damage("packed PLY", "b.ply.gz", &little, &[], "b.ply.gz", pack);
}

#[test]
fn damaged_models_and_their_materials() {
    let model = "mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvn 0 0 1\nusemtl m\nf 1/1/1 2/2/1 3/1/1\n";
    let materials = "newmtl m\nKd 0.5 0.4 0.3\nPr 0.4\nPm 0.7\nPc 0.2\nPcr 0.1\naniso 0.5\nanisor 0.2\nNi 1.4\nPs 0.3\nd 0.9\nillum 2\nKe 1 0 0\n\
        map_Kd h.png\nmap_Pr h.png\nnorm h.png\n";
    let png = png_bytes([9, 8, 7]);
    let pictures: (&str, &[u8]) = ("h.png", &png);
    damage("OBJ", "a.obj", model.as_bytes(), &[("b.mtl", materials.as_bytes()), pictures], "a.obj", as_it_is);
    damage("MTL", "b.mtl", materials.as_bytes(), &[("a.obj", model.as_bytes()), pictures], "a.obj", as_it_is);
}
