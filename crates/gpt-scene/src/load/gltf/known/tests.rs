//! Walks through the table: nothing that a file says is silent.

use std::collections::BTreeSet;
use std::fs;

use base64::Engine as _;
use serde_json::{Value, json};

use super::*;
use crate::load::files::Files;
use crate::load::gltf::load;

/// Keys of the table that are tested elsewhere: numbers that are packed, and the rest of a buffer whose views are all packed.
const ELSEWHERE: [&str; 2] = ["PACKED", "STAND_IN"];

/// A file that has an object of every kind.
fn file() -> Value {
    let mut data: Vec<u8> = Vec::new();
    let mut views: Vec<Value> = Vec::new();
    let mut view = |bytes: &[u8]| {
        let start = data.len();
        data.extend(bytes);
        data.resize(data.len().next_multiple_of(4), 0);
        views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": bytes.len() }));
    };
    let floats = |numbers: &[f32]| -> Vec<u8> { numbers.iter().flat_map(|number| number.to_le_bytes()).collect() };
    view(&floats(&[-1.0, -1.0, 0.0, 1.0, -1.0, 0.0, 1.0, 1.0, 0.0, -1.0, 1.0, 0.5, 7.0, 7.0, 7.0])); // 0 positions
    view(&floats(&[0.0, 0.0, 1.0].repeat(4))); // 1 normals
    view(&floats(&[0.0, 1.0, 0.0, 1.0].repeat(4))); // 2 tangents
    view(&floats(&[0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.5, 0.5])); // 3 coordinates
    view(&[255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 9, 9, 9, 255]); // 4 colours
    view(&[0, 0, 1, 0, 2, 0, 0, 0, 2, 0, 3, 0]); // 5 indices
    view(&[0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1]); // 6 joints
    view(&floats(&[0.5, 0.5, 0.0, 0.0].repeat(4))); // 7 weights
    let bind = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.25, 0.0, 0.0, 1.0];
    view(&floats(&bind.repeat(2))); // 8 bind matrices
    view(&floats(&[0.0, 1.0, 3.0])); // 9 times
    view(&floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0])); // 10 translations
    view(&[1, 0, 2, 0]); // 11 sparse indices
    view(&floats(&[0.1, 0.2, 0.3, 0.4, 0.5, 0.6])); // 12 sparse values
    view(&floats(&[0.0, 0.6, 0.0, 0.8, 0.0, 0.0, 0.6, 0.8, 0.8, 0.0, 0.0, 0.6])); // 13 rotations
    view(&picture([10, 200, 90, 128])); // 14
    let texture = |index: u32| json!({ "index": index });
    let material = |extensions: Value| {
        json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.4, 0.3, 0.5], "metallicFactor": 0.5, "roughnessFactor": 0.5 },
            "emissiveFactor": [0.5, 0.5, 0.5], "doubleSided": true, "extensions": extensions })
    };
    let mut everything = material(json!({
        "KHR_materials_emissive_strength": { "emissiveStrength": 3.0 },
        "KHR_materials_ior": { "ior": 1.4 },
        "KHR_materials_specular": { "specularFactor": 0.5, "specularColorFactor": [0.5, 0.5, 0.5], "specularTexture": texture(0),
            "specularColorTexture": texture(0) },
        "KHR_materials_transmission": { "transmissionFactor": 0.5, "transmissionTexture": texture(0) },
        "KHR_materials_volume": { "thicknessFactor": 1.0, "attenuationDistance": 2.0, "attenuationColor": [0.5, 0.6, 0.7] },
        "KHR_materials_volume_scatter": { "multiscatterColor": [0.5, 0.4, 0.3], "scatterAnisotropy": 0.25 },
        "KHR_materials_clearcoat": { "clearcoatFactor": 0.5, "clearcoatTexture": texture(0), "clearcoatRoughnessFactor": 0.5,
            "clearcoatRoughnessTexture": texture(0), "clearcoatNormalTexture": { "index": 0, "scale": 0.5 } },
        "KHR_materials_sheen": { "sheenColorFactor": [0.5, 0.5, 0.5], "sheenColorTexture": texture(0), "sheenRoughnessFactor": 0.5,
            "sheenRoughnessTexture": texture(0) },
        "KHR_materials_anisotropy": { "anisotropyStrength": 0.5, "anisotropyRotation": 0.5, "anisotropyTexture": texture(0) },
        "KHR_materials_iridescence": { "iridescenceFactor": 0.5, "iridescenceTexture": texture(0), "iridescenceIor": 1.5,
            "iridescenceThicknessMinimum": 150.0, "iridescenceThicknessMaximum": 500.0, "iridescenceThicknessTexture": texture(0) },
        "KHR_materials_dispersion": { "dispersion": 0.0 },
        "KHR_materials_diffuse_transmission": { "diffuseTransmissionFactor": 0.5, "diffuseTransmissionTexture": texture(0),
            "diffuseTransmissionColorFactor": [0.5, 0.6, 0.7], "diffuseTransmissionColorTexture": texture(0) },
    }));
    everything["normalTexture"] = json!({ "index": 0, "texCoord": 0, "scale": 0.5 });
    everything["occlusionTexture"] = json!({ "index": 0, "strength": 0.5 });
    everything["emissiveTexture"] = texture(0);
    let pbr = &mut everything["pbrMetallicRoughness"];
    pbr["baseColorTexture"] = json!({ "index": 0, "texCoord": 0, "extensions": { "KHR_texture_transform": {
        "offset": [0.1, 0.2], "rotation": 0.3, "scale": [2.0, 3.0], "texCoord": 0 } } });
    pbr["metallicRoughnessTexture"] = texture(0);
    let glossy = material(json!({ "KHR_materials_pbrSpecularGlossiness": { "diffuseFactor": [0.5, 0.4, 0.3, 1.0],
        "diffuseTexture": texture(0), "specularFactor": [0.2, 0.2, 0.2], "glossinessFactor": 0.5,
        "specularGlossinessTexture": texture(0) } }));
    let accessor = |view: u32, kind: &str, component: u32, count: u32| json!({ "bufferView": view, "byteOffset": 0, "type": kind, "componentType": component, "count": count });
    let mut colours = accessor(4, "VEC4", 5121, 4);
    colours["normalized"] = json!(true);
    let mut sparse = accessor(1, "VEC3", 5126, 4);
    sparse["sparse"] = json!({ "count": 2, "indices": { "bufferView": 11, "byteOffset": 0, "componentType": 5123 },
        "values": { "bufferView": 12, "byteOffset": 0 } });
    let uri = |bytes: &[u8]| {
        let text = base64::engine::general_purpose::STANDARD.encode(bytes);
        format!("data:application/octet-stream;base64,{text}")
    };
    let light = |kind: &str| json!({ "type": kind, "color": [1.0, 0.5, 0.25], "intensity": 40.0 });
    let mut spot = light("spot");
    spot["spot"] = json!({ "innerConeAngle": 0.2, "outerConeAngle": 0.5 });
    let other = vec![1; data.len()];
    json!({
        "asset": { "version": "2.0", "minVersion": "2.0" },
        "scene": 0,
        "scenes": [
            { "nodes": [0, 1, 2, 3, 6, 8, 9], "extensions": { "EXT_lights_image_based": { "light": 0 } } },
            { "nodes": [0, 1] },
        ],
        "nodes": [
            { "mesh": 0, "translation": [0.0, 0.0, 0.5], "children": [7],
                "extensions": { "KHR_node_visibility": { "visible": true } } },
            { "camera": 0, "translation": [0.0, 0.0, 6.0] },
            { "extensions": { "KHR_lights_punctual": { "light": 0 },
                "EXT_lights_ies": { "light": 0, "multiplier": 2.0, "color": [1.0, 0.5, 0.25] } } },
            { "mesh": 1, "skin": 0, "weights": [0.5] },
            { "translation": [0.1, 0.0, 0.0] },
            { "translation": [0.2, 0.0, 0.0] },
            { "children": [4, 5], "matrix": [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.5, 0.0, 0.0, 1.0] },
            { "mesh": 3, "rotation": [0.0, 0.0, 0.6, 0.8], "scale": [1.0, 2.0, 3.0] },
            { "mesh": 3, "extensions": { "EXT_mesh_gpu_instancing": {
                "attributes": { "TRANSLATION": 10, "ROTATION": 13, "SCALE": 16 } } } },
            { "mesh": 2 },
        ],
        "cameras": [
            { "type": "perspective", "perspective": { "yfov": 0.7, "aspectRatio": 2.0, "znear": 0.1, "zfar": 100.0 } },
            { "type": "orthographic", "orthographic": { "xmag": 3.0, "ymag": 2.0, "znear": 0.1, "zfar": 100.0 } },
        ],
        "meshes": [
            { "primitives": [{ "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 3, "TEXCOORD_1": 15 }, "indices": 5,
                "material": 0, "mode": 4, "extensions": { "KHR_materials_variants": {
                    "mappings": [{ "variants": [0], "material": 1 }] } } }] },
            { "weights": [0.25], "primitives": [{ "attributes": { "POSITION": 0, "JOINTS_0": 6, "WEIGHTS_0": 7 },
                "targets": [{ "POSITION": 12 }] }] },
            { "primitives": [{ "attributes": { "POSITION": 0, "NORMAL": 12, "COLOR_0": 4 }, "indices": 5 }] },
            { "weights": [0.25], "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 3, "NORMAL": 1, "TANGENT": 2 },
                "material": 3, "targets": [{ "POSITION": 12 }] }] },
        ],
        "accessors": [
            accessor(0, "VEC3", 5126, 4), accessor(1, "VEC3", 5126, 4), accessor(2, "VEC4", 5126, 4),
            accessor(3, "VEC2", 5126, 4), colours, accessor(5, "SCALAR", 5123, 6), accessor(6, "VEC4", 5121, 4),
            accessor(7, "VEC4", 5126, 4), accessor(8, "MAT4", 5126, 2), accessor(9, "SCALAR", 5126, 3),
            accessor(10, "VEC3", 5126, 3), accessor(9, "SCALAR", 5126, 3), sparse, accessor(13, "VEC4", 5126, 3),
            accessor(12, "VEC3", 5126, 2), accessor(3, "VEC2", 5126, 4), accessor(10, "VEC3", 5126, 3),
        ],
        "bufferViews": views,
        "buffers": [{ "uri": uri(&data), "byteLength": data.len() }, { "uri": uri(&other), "byteLength": other.len() }],
        "materials": [material(json!({})), everything, glossy,
            { "normalTexture": texture(1), "alphaMode": "MASK", "alphaCutoff": 0.4, "doubleSided": true,
              "pbrMetallicRoughness": { "baseColorTexture": texture(2) } }],
        "textures": [{ "source": 0, "sampler": 0 }, { "source": 1 }, { "extensions": { "EXT_texture_webp": { "source": 0 } } }],
        "images": [
            { "uri": uri(&picture([9, 99, 199, 255])) },
            { "bufferView": 14, "mimeType": "image/png" },
            { "uri": uri(&square([40, 50, 60, 200])) },
            { "uri": uri(&square([60, 50, 40, 255])) },
        ],
        "samplers": [{ "magFilter": 9729, "minFilter": 9729, "wrapS": 10497, "wrapT": 10497 }],
        "skins": [{ "joints": [4, 5], "inverseBindMatrices": 8 }],
        "animations": [{ "channels": [{ "sampler": 0, "target": { "node": 9, "path": "translation" } }],
            "samplers": [{ "input": 9, "output": 10, "interpolation": "LINEAR" },
                         { "input": 9, "output": 16, "interpolation": "STEP" }] }],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensionsRequired": ["KHR_lights_punctual"],
        "extensions": {
            "KHR_lights_punctual": { "lights": [spot, light("point")] },
            "EXT_lights_ies": { "lights": [{ "uri": uri(&[1, 2]) }, { "bufferView": 14, "mimeType": "application/x-ies-lm-63" }] },
            "EXT_lights_image_based": { "lights": [
                { "intensity": 2.0, "rotation": [0.0, 0.6, 0.0, 0.8], "irradianceCoefficients": vec![[0.5; 3]; 9],
                    "specularImages": [[2, 2, 2, 2, 2, 2]], "specularImageSize": 2 },
                { "irradianceCoefficients": vec![[0.5; 3]; 9], "specularImages": [[]], "specularImageSize": 2 },
            ] },
            "KHR_materials_variants": { "variants": [{ "name": "shown" }, { "name": "other" }] },
        },
    })
}

fn picture(pixel: [u8; 4]) -> Vec<u8> {
    of_size(3, 2, pixel)
}

fn square(pixel: [u8; 4]) -> Vec<u8> {
    of_size(2, 2, pixel)
}

fn of_size(width: u32, height: u32, pixel: [u8; 4]) -> Vec<u8> {
    let picture = image::RgbaImage::from_fn(width, height, |x, y| {
        image::Rgba(pixel.map(|value| value.wrapping_add((17 * x + 31 * y) as u8)))
    });
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png).expect("it is written");
    bytes.into_inner()
}

/// All that an import makes of a file, and what it reports; or the refusal.
fn made_of(root: &Value) -> (Vec<u8>, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.gltf");
    fs::write(&path, root.to_string()).expect("it is written");
    match load(&Files::default(), &path, None, Some("shown")) {
        Err(error) => (Vec::new(), error.to_string().replace(&*folder.path().to_string_lossy(), "")),
        Ok(description) => {
            let bytes = format!("{:?}", description.file).into_bytes();
            let items = description.report.dropped.iter().chain(&description.report.approximated);
            (bytes, items.map(|item| format!("{} {} {}\n", item.what, item.count, item.instead)).collect())
        }
    }
}

/// Writes a value at a pointer; `null` takes away what is there.
fn set(root: &mut Value, pointer: &str, value: &Value) {
    let (around, key) = pointer.rsplit_once('/').expect("a pointer");
    let around = root.pointer_mut(around).unwrap_or_else(|| panic!("{pointer}"));
    match around {
        Value::Object(entries) if value.is_null() => drop(entries.remove(key)),
        Value::Object(entries) => drop(entries.insert(key.to_owned(), value.clone())),
        Value::Array(values) => values[key.parse::<usize>().expect("an index")] = value.clone(),
        _ => panic!("{pointer}"),
    }
}

/// The place of a key in the file, the values that it takes in turn, and further text for both files.
struct Row(&'static str, &'static str, Value, &'static [(&'static str, &'static str)]);

fn rows() -> Vec<Row> {
    const FACTOR_ENDS: [f64; 4] = [-1.0, 0.0, 1.0, 2.0];
    const ORTHOGRAPHIC: &[(&str, &str)] = &[("/nodes/1/camera", "1")];
    const GLOSSY: &[(&str, &str)] = &[("/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/material", "2")];
    let colours = || json!([[-1.0, 0.5, 0.5], [0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [2.0, 0.5, 0.5]]);
    let texture = || json!([{ "index": 1 }, null, { "index": 77 }]);
    let mut rows = vec![
        Row("ROOT.scene", "/scene", json!([1, 5]), &[("/scenes/0/nodes", "[1, 9]")]),
        Row("ROOT.extensionsUsed", "/extensionsUsed", json!([["X_unknown"]]), &[]),
        Row("ROOT.extensionsRequired", "/extensionsRequired", json!([["X_unknown"], ["KHR_texture_basisu"]]), &[]),
        Row("ASSET.version", "/asset/version", json!(["1.0", "0.8", 1, "3.0", null]), &[]),
        Row("ASSET.minVersion", "/asset/minVersion", json!(["2.1", "3.0"]), &[]),
        Row("SCENE.nodes", "/scenes/0/nodes", json!([[0, 1], [], [77], [0, 0]]), &[]),
        Row("NODE.camera", "/nodes/1/camera", json!([1, 7, null]), &[]),
        Row("NODE.children", "/nodes/0/children", json!([[], [0], [77]]), &[]),
        Row("NODE.skin", "/nodes/3/skin", json!([null, 3]), &[]),
        Row("NODE.mesh", "/nodes/0/mesh", json!([null, 3, 77]), &[]),
        Row("NODE.weights", "/nodes/3/weights", json!([[0.0], [1.0], [-1.0], [2.0]]), &[]),
        Row("LIGHT_OF_NODE.light", "/nodes/2/extensions/KHR_lights_punctual/light", json!([1, 7]), &[]),
        Row("PROFILE_OF_NODE.light", "/nodes/2/extensions/EXT_lights_ies/light", json!([1, 7, null]), &[]),
        Row(
            "PROFILE_OF_NODE.multiplier",
            "/nodes/2/extensions/EXT_lights_ies/multiplier",
            json!([-1.0, 0.0, 1.0, null, "2"]),
            &[],
        ),
        Row("PROFILE_OF_NODE.color", "/nodes/2/extensions/EXT_lights_ies/color", colours(), &[]),
        Row(
            "PROFILE.uri",
            "/extensions/EXT_lights_ies/lights/0/uri",
            json!([null, "absent.ies", "data:application/octet-stream;base64,AAAA", "http://x/y.ies"]),
            &[],
        ),
        Row(
            "PROFILE.bufferView",
            "/extensions/EXT_lights_ies/lights/1/bufferView",
            json!([null, 0, 77]),
            &[("/nodes/2/extensions/EXT_lights_ies/light", "1")],
        ),
        Row("LIGHT_OF_SCENE.light", "/scenes/0/extensions/EXT_lights_image_based/light", json!([1, 7, null]), &[]),
        Row(
            "IMAGE_LIGHT.rotation",
            "/extensions/EXT_lights_image_based/lights/0/rotation",
            json!([null, [0.0, 0.0, 0.0, 0.0], [1.0]]),
            &[],
        ),
        Row(
            "IMAGE_LIGHT.intensity",
            "/extensions/EXT_lights_image_based/lights/0/intensity",
            json!([null, -1.0, 0.0, 1.0, "2"]),
            &[],
        ),
        Row(
            "IMAGE_LIGHT.irradianceCoefficients",
            "/extensions/EXT_lights_image_based/lights/1/irradianceCoefficients",
            json!([null, [], [[1.0, 1.0, 1.0]]]),
            &[("/scenes/0/extensions/EXT_lights_image_based/light", "1")],
        ),
        Row(
            "IMAGE_LIGHT.specularImages",
            "/extensions/EXT_lights_image_based/lights/0/specularImages",
            json!([null, [[2, 2, 2, 2, 2, 3]], [[2, 2, 2, 2, 2, 0]], [[2, 2, 2, 2, 2, 77]], [[2, 2, 2, 2, 2, 2], []]]),
            &[],
        ),
        Row("VISIBILITY.visible", "/nodes/0/extensions/KHR_node_visibility/visible", json!([false]), &[]),
        Row("MESH.weights", "/meshes/3/weights", json!([[0.0], [1.0], [-2.0], null]), &[]),
        Row("PRIMITIVE.indices", "/meshes/0/primitives/0/indices", json!([null, 9, 77]), &[]),
        Row("PRIMITIVE.material", "/meshes/2/primitives/0/material", json!([0, 77]), &[]),
        Row("PRIMITIVE.mode", "/meshes/0/primitives/0/mode", json!([0, 1, 2, 3, 5, 6, 7, 99]), &[]),
        Row("ATTRIBUTES.POSITION", "/meshes/0/primitives/0/attributes/POSITION", json!([null, 12, 77]), &[]),
        Row("ATTRIBUTES.NORMAL", "/meshes/0/primitives/0/attributes/NORMAL", json!([null, 12, 77]), &[]),
        Row("ATTRIBUTES.TANGENT", "/meshes/3/primitives/0/attributes/TANGENT", json!([null, 3]), &[]),
        Row("ATTRIBUTES.COLOR_0", "/meshes/2/primitives/0/attributes/COLOR_0", json!([null, 12]), &[]),
        Row("ATTRIBUTES.COLOR_1", "/meshes/2/primitives/0/attributes/COLOR_1", json!([4]), &[]),
        Row("ATTRIBUTES.OTHER", "/meshes/2/primitives/0/attributes/OTHER", json!([4]), &[]),
        Row("TARGETS.COLOR_0", "/meshes/1/primitives/0/targets/0/COLOR_0", json!([4]), &[]),
        Row("TARGETS.POSITION", "/meshes/1/primitives/0/targets/0/POSITION", json!([1, 77]), &[]),
        Row(
            "MAPPING.variants",
            "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/variants",
            json!([[1], []]),
            &[],
        ),
        Row(
            "MAPPING.material",
            "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/material",
            json!([0, 77]),
            &[],
        ),
        Row("ACCESSOR.bufferView", "/accessors/0/bufferView", json!([1, null, 77]), &[]),
        Row("ACCESSOR.byteOffset", "/accessors/0/byteOffset", json!([12, 999]), &[]),
        Row("ACCESSOR.componentType", "/accessors/0/componentType", json!([5120, 5121, 5122, 5123, 5125, 5124, 5130]), &[]),
        Row("ACCESSOR.normalized", "/accessors/4/normalized", json!([false]), &[("/accessors/4/type", "\"VEC3\"")]),
        Row("ACCESSOR.count", "/accessors/0/count", json!([0, 3, 5, 999]), &[]),
        Row("ACCESSOR.type", "/accessors/0/type", json!(["SCALAR", "VEC2", "VEC4", "MAT3", "X"]), &[]),
        Row("SPARSE.count", "/accessors/12/sparse/count", json!([0, 1, 99]), &[]),
        Row("SPARSE_INDICES.bufferView", "/accessors/12/sparse/indices/bufferView", json!([5, 77]), &[]),
        Row("SPARSE_INDICES.byteOffset", "/accessors/12/sparse/indices/byteOffset", json!([2]), &[]),
        Row("SPARSE_INDICES.componentType", "/accessors/12/sparse/indices/componentType", json!([5121, 5125, 1]), &[]),
        Row("SPARSE_VALUES.bufferView", "/accessors/12/sparse/values/bufferView", json!([0, 77]), &[]),
        Row("SPARSE_VALUES.byteOffset", "/accessors/12/sparse/values/byteOffset", json!([12]), &[]),
        Row("BUFFER_VIEW.buffer", "/bufferViews/0/buffer", json!([1, 7]), &[]),
        Row("BUFFER_VIEW.byteOffset", "/bufferViews/0/byteOffset", json!([12, 99_999]), &[]),
        Row("BUFFER_VIEW.byteLength", "/bufferViews/0/byteLength", json!([12, 99_999]), &[]),
        Row("BUFFER_VIEW.byteStride", "/bufferViews/0/byteStride", json!([16, 4]), &[]),
        Row("BUFFER.uri", "/buffers/0/uri", json!([null, "absent.bin", "data:;base64,AAAA"]), &[]),
        Row("BUFFER.byteLength", "/buffers/0/byteLength", json!([99_999]), &[]),
        Row("MATERIAL.alphaMode", "/materials/3/alphaMode", json!([null, "OPAQUE", "BLEND", "HAIR"]), &[]),
        Row("MATERIAL.alphaCutoff", "/materials/3/alphaCutoff", json!([0.0, 1.0, 2.0, null]), &[]),
        Row("MATERIAL.doubleSided", "/materials/3/doubleSided", json!([false, null]), &[]),
        Row("MATERIAL.emissiveFactor", "/materials/1/emissiveFactor", colours(), &[]),
        Row("MATERIAL.occlusionTexture", "/materials/1/occlusionTexture", json!([null]), &[]),
        Row("NORMAL_TEXTURE.index", "/materials/1/normalTexture/index", json!([1, 77]), &[]),
        Row("NORMAL_TEXTURE.texCoord", "/materials/1/normalTexture/texCoord", json!([1, 7]), &[]),
        Row("NORMAL_TEXTURE.scale", "/materials/1/normalTexture/scale", json!([0.0, -1.0, 2.0, null]), &[]),
        Row("TEXTURE_INFO.index", "/materials/1/pbrMetallicRoughness/baseColorTexture/index", json!([1, 77]), &[]),
        Row("TEXTURE_INFO.texCoord", "/materials/1/emissiveTexture/texCoord", json!([1, 7]), &[]),
        Row("LIGHT.type", "/extensions/KHR_lights_punctual/lights/0/type", json!(["point", "directional", "ambient"]), &[]),
        Row("LIGHT.color", "/extensions/KHR_lights_punctual/lights/0/color", colours(), &[]),
        Row("LIGHT.intensity", "/extensions/KHR_lights_punctual/lights/0/intensity", json!([0.0, -1.0, 1.0, null]), &[]),
        Row("LIGHT.range", "/extensions/KHR_lights_punctual/lights/0/range", json!([5.0, 0.0]), &[]),
        Row(
            "CONE.innerConeAngle",
            "/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle",
            json!([0.0, 0.5, 1.0, -1.0]),
            &[],
        ),
        Row(
            "CONE.outerConeAngle",
            "/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle",
            json!([0.0, 0.1, 1.6, 3.0, -1.0, null]),
            &[],
        ),
        Row("TEXTURE.sampler", "/textures/0/sampler", json!([7]), &[]),
        Row("TEXTURE.source", "/textures/0/source", json!([1, 7, null]), &[]),
        Row("PICTURE.source", "/textures/2/extensions/EXT_texture_webp/source", json!([1, 7, null]), &[]),
        Row("IMAGE.uri", "/images/0/uri", json!([null, "absent.png", "data:image/png;base64,AAAA", "http://x/y.png"]), &[]),
        Row("IMAGE.bufferView", "/images/1/bufferView", json!([null, 0, 77]), &[]),
        Row("SAMPLER.magFilter", "/samplers/0/magFilter", json!([9728, 1]), &[]),
        Row("SAMPLER.minFilter", "/samplers/0/minFilter", json!([9728, 9984, 9986, 1]), &[("/samplers/0/magFilter", "null")]),
        Row("SAMPLER.wrapS", "/samplers/0/wrapS", json!([33_071, 33_648, 1]), &[]),
        Row("SAMPLER.wrapT", "/samplers/0/wrapT", json!([33_071, 33_648, 1]), &[]),
        Row("PERSPECTIVE.aspectRatio", "/cameras/0/perspective/aspectRatio", json!([null, 0.0, 1.0, 1e9]), &[]),
        Row("PERSPECTIVE.yfov", "/cameras/0/perspective/yfov", json!([0.0, -1.0, 1.0, 3.1, 4.0, 1e-9]), &[]),
        Row("PERSPECTIVE.zfar", "/cameras/0/perspective/zfar", json!([1.0]), &[]),
        Row("PERSPECTIVE.znear", "/cameras/0/perspective/znear", json!([50.0]), &[]),
        Row("ORTHOGRAPHIC.xmag", "/cameras/1/orthographic/xmag", json!([0.0, -3.0, 1.0]), ORTHOGRAPHIC),
        Row("ORTHOGRAPHIC.ymag", "/cameras/1/orthographic/ymag", json!([0.0, -2.0, 1.0]), ORTHOGRAPHIC),
        Row("ORTHOGRAPHIC.zfar", "/cameras/1/orthographic/zfar", json!([1.0]), ORTHOGRAPHIC),
        Row("ORTHOGRAPHIC.znear", "/cameras/1/orthographic/znear", json!([50.0]), ORTHOGRAPHIC),
        Row("SKIN.inverseBindMatrices", "/skins/0/inverseBindMatrices", json!([null, 0, 77]), &[]),
        Row("SKIN.joints", "/skins/0/joints", json!([[5, 4], [77, 4]]), &[]),
        Row("CHANNEL.sampler", "/animations/0/channels/0/sampler", json!([1, 7]), &[]),
        Row("TARGET.node", "/animations/0/channels/0/target/node", json!([7, 77, null]), &[]),
        Row("TARGET.path", "/animations/0/channels/0/target/path", json!(["scale", "rotation", "weights", "pointer"]), &[]),
        Row("ANIMATION_SAMPLER.input", "/animations/0/samplers/0/input", json!([10, 77]), &[]),
        Row("ANIMATION_SAMPLER.output", "/animations/0/samplers/0/output", json!([12, 77]), &[]),
        Row(
            "ANIMATION_SAMPLER.interpolation",
            "/animations/0/samplers/0/interpolation",
            json!(["STEP", "CUBICSPLINE", "X"]),
            &[],
        ),
    ];
    for (key, values) in [
        ("matrix", json!([[1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]])),
        ("translation", json!([[1.0, 0.0, 0.0], [1e30, 0.0, 0.0]])),
        ("rotation", json!([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]])),
        ("scale", json!([[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [-1.0, 2.0, 3.0], null])),
    ] {
        let name = ["NODE.matrix", "NODE.translation", "NODE.rotation", "NODE.scale"];
        let name = name.into_iter().find(|name| name.ends_with(key)).expect("a key");
        let pointer = format!("/nodes/7/{key}").leak();
        rows.push(Row(name, pointer, values, &[]));
    }
    for key in ["TRANSLATION", "ROTATION", "SCALE"] {
        let pointer = format!("/nodes/8/extensions/EXT_mesh_gpu_instancing/attributes/{key}").leak();
        rows.push(Row(format!("INSTANCE_ATTRIBUTES.{key}").leak(), pointer, json!([null, 9, 77]), &[]));
    }
    let pbr = "pbrMetallicRoughness";
    let factors = json!(FACTOR_ENDS);
    let base = json!([[0.0, 0.0, 0.0, 0.5], [2.0, 0.4, 0.3, 0.5], [-1.0, 0.4, 0.3, 0.5]]);
    for (object, path, key, values, setup) in [
        ("METALLIC_ROUGHNESS", pbr, "baseColorFactor", &base, &[][..]),
        ("METALLIC_ROUGHNESS", pbr, "metallicFactor", &factors, &[]),
        ("METALLIC_ROUGHNESS", pbr, "roughnessFactor", &factors, &[]),
        ("EMISSIVE_STRENGTH", "extensions/KHR_materials_emissive_strength", "emissiveStrength", &factors, &[]),
        ("IOR", "extensions/KHR_materials_ior", "ior", &json!([-1.0, 0.0, 0.5, 1.0, 10.0, 50.0]), &[]),
        ("SPECULAR", "extensions/KHR_materials_specular", "specularFactor", &factors, &[]),
        ("SPECULAR", "extensions/KHR_materials_specular", "specularColorFactor", &colours(), &[]),
        ("TRANSMISSION", "extensions/KHR_materials_transmission", "transmissionFactor", &factors, &[]),
        ("VOLUME", "extensions/KHR_materials_volume", "thicknessFactor", &json!([0.0, -1.0]), &[]),
        ("VOLUME", "extensions/KHR_materials_volume", "attenuationDistance", &json!([0.0, -1.0, 1.0, 1e30]), &[]),
        ("VOLUME", "extensions/KHR_materials_volume", "attenuationColor", &colours(), &[]),
        ("VOLUME_SCATTER", "extensions/KHR_materials_volume_scatter", "multiscatterColor", &colours(), &[]),
        ("VOLUME_SCATTER", "extensions/KHR_materials_volume_scatter", "scatterAnisotropy", &json!([-2.0, -1.0, 0.0, 1.0]), &[]),
        ("CLEARCOAT", "extensions/KHR_materials_clearcoat", "clearcoatFactor", &factors, &[]),
        ("CLEARCOAT", "extensions/KHR_materials_clearcoat", "clearcoatRoughnessFactor", &factors, &[]),
        ("SHEEN", "extensions/KHR_materials_sheen", "sheenColorFactor", &colours(), &[]),
        ("SHEEN", "extensions/KHR_materials_sheen", "sheenRoughnessFactor", &factors, &[]),
        ("ANISOTROPY", "extensions/KHR_materials_anisotropy", "anisotropyStrength", &factors, &[]),
        ("ANISOTROPY", "extensions/KHR_materials_anisotropy", "anisotropyRotation", &factors, &[]),
        ("IRIDESCENCE", "extensions/KHR_materials_iridescence", "iridescenceFactor", &factors, &[]),
        ("IRIDESCENCE", "extensions/KHR_materials_iridescence", "iridescenceIor", &json!([0.5, 1.0, 3.0, 20.0]), &[]),
        ("IRIDESCENCE", "extensions/KHR_materials_iridescence", "iridescenceThicknessMinimum", &json!([-1.0, 0.0, 600.0]), &[]),
        ("IRIDESCENCE", "extensions/KHR_materials_iridescence", "iridescenceThicknessMaximum", &json!([-1.0, 0.0, 1e9]), &[]),
        ("DISPERSION", "extensions/KHR_materials_dispersion", "dispersion", &json!([0.1]), &[]),
        ("DIFFUSE_TRANSMISSION", "extensions/KHR_materials_diffuse_transmission", "diffuseTransmissionFactor", &factors, &[]),
        (
            "DIFFUSE_TRANSMISSION",
            "extensions/KHR_materials_diffuse_transmission",
            "diffuseTransmissionColorFactor",
            &colours(),
            &[],
        ),
        (
            "TRANSFORM",
            "pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform",
            "offset",
            &json!([[0.0, 0.0]]),
            &[],
        ),
        (
            "TRANSFORM",
            "pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform",
            "rotation",
            &json!([0.0, -1.0]),
            &[],
        ),
        (
            "TRANSFORM",
            "pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform",
            "scale",
            &json!([[0.0, 1.0], [-1.0, 1.0]]),
            &[],
        ),
        ("TRANSFORM", "pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform", "texCoord", &json!([1, 7]), &[]),
    ] {
        rows.push(Row(format!("{object}.{key}").leak(), format!("/materials/1/{path}/{key}").leak(), values.clone(), setup));
    }
    let glossy = "/materials/2/extensions/KHR_materials_pbrSpecularGlossiness";
    for (key, values) in [("diffuseFactor", base), ("specularFactor", colours()), ("glossinessFactor", factors)] {
        rows.push(Row(format!("SPECULAR_GLOSSINESS.{key}").leak(), format!("{glossy}/{key}").leak(), values, GLOSSY));
    }
    for key in ["diffuseTexture", "specularGlossinessTexture"] {
        rows.push(Row(format!("SPECULAR_GLOSSINESS.{key}").leak(), format!("{glossy}/{key}").leak(), texture(), GLOSSY));
    }
    for path in [
        "pbrMetallicRoughness/baseColorTexture",
        "pbrMetallicRoughness/metallicRoughnessTexture",
        "normalTexture",
        "emissiveTexture",
        "extensions/KHR_materials_specular/specularTexture",
        "extensions/KHR_materials_specular/specularColorTexture",
        "extensions/KHR_materials_transmission/transmissionTexture",
        "extensions/KHR_materials_volume/thicknessTexture",
        "extensions/KHR_materials_iridescence/iridescenceTexture",
        "extensions/KHR_materials_iridescence/iridescenceThicknessTexture",
        "extensions/KHR_materials_diffuse_transmission/diffuseTransmissionTexture",
        "extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorTexture",
        "extensions/KHR_materials_clearcoat/clearcoatTexture",
        "extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture",
        "extensions/KHR_materials_clearcoat/clearcoatNormalTexture",
        "extensions/KHR_materials_sheen/sheenColorTexture",
        "extensions/KHR_materials_sheen/sheenRoughnessTexture",
        "extensions/KHR_materials_anisotropy/anisotropyTexture",
    ] {
        let values = if path.ends_with("thicknessTexture") { json!([{ "index": 1 }]) } else { texture() };
        rows.push(Row(path.rsplit('/').next().expect("a key"), format!("/materials/1/{path}").leak(), values, &[]));
    }
    rows
}

/// Whatever a key is, it shows, or is reported, or the file is refused.
#[test]
fn every_end_of_every_key_is_reported_or_shows() {
    let mut silent = Vec::new();
    for Row(name, pointer, values, setup) in rows() {
        let mut base = file();
        for (pointer, value) in setup {
            set(&mut base, pointer, &serde_json::from_str(value).expect("it is JSON"));
        }
        let expected = made_of(&base);
        assert!(!expected.0.is_empty(), "{name}: {}", expected.1);
        for value in values.as_array().expect("values") {
            let mut other = base.clone();
            set(&mut other, pointer, value);
            assert!(other != base, "{name}: {value} is what is written");
            if made_of(&other) == expected {
                silent.push(format!("{name} = {value}"));
            }
        }
    }
    assert!(silent.is_empty(), "{silent:#?}");
}

/// Calls `visit` with every object of the table once.
fn for_each_object(object: &'static Object, seen: &mut BTreeSet<&'static str>, visit: &mut dyn FnMut(&'static Object)) {
    if !seen.insert(object.name) {
        return;
    }
    visit(object);
    for key in object.keys {
        if let Holds::Object(of) | Holds::List(of) = key.holds {
            for_each_object(of, seen, visit);
        }
    }
    object.extensions.iter().for_each(|(_, of)| for_each_object(of, seen, visit));
}

/// The test above has a row for every key that is read.
#[test]
fn every_key_that_is_read_has_its_ends_tested() {
    let rows = rows();
    let tested: BTreeSet<&str> = rows.iter().map(|row| row.0).collect();
    let mut missing = Vec::new();
    for_each_object(&ROOT, &mut BTreeSet::new(), &mut |object| {
        let read = object.keys.iter().filter(|key| key.role == Role::Read && matches!(key.holds, Holds::Value));
        let names = read.map(|key| format!("{}.{}", object.name, key.name));
        missing.extend(names.filter(|name| !tested.contains(name.as_str()) && !ELSEWHERE.contains(&object.name)));
    });
    assert!(missing.is_empty(), "{missing:#?}");
}

/// An unknown key and an unknown extension in every object of the file are found, each at its place.
#[test]
fn what_is_unknown_is_found_everywhere() {
    fn plant(value: &mut Value, count: &mut usize) {
        match value {
            Value::Array(values) => values.iter_mut().for_each(|value| plant(value, count)),
            Value::Object(entries) => {
                let is_of_extensions =
                    entries.keys().any(|key| key.contains("_") && key.chars().next().is_some_and(char::is_uppercase));
                entries.values_mut().for_each(|value| plant(value, count));
                if !is_of_extensions {
                    entries.insert("unheardOf".to_owned(), json!(1));
                    *count += 1;
                }
            }
            _ => {}
        }
    }
    assert_eq!(find_unread(file().to_string().as_bytes()), []);
    let mut planted = file();
    let mut count = 0;
    plant(&mut planted, &mut count);
    let found = find_unread(planted.to_string().as_bytes());
    // An object that is passed over as a whole has nothing found in it.
    let places: BTreeSet<&str> = found.iter().map(|unread| unread.place.as_str()).collect();
    assert_eq!((found.len(), places.len()), (count, count), "{found:#?}");
    let unknown = json!({ "nodes": [{ "extensions": { "X_unknown": {}, "KHR_xmp": {} } }], "extensions": { "KHR_lights_punctual": {
        "lights": [{ "extensions": { "Y_unknown": 1 } }] } } });
    let found = find_unread(unknown.to_string().as_bytes());
    let found: Vec<(&str, &str)> = found.iter().map(|unread| (unread.what.as_str(), unread.place.as_str())).collect();
    let light = "extensions.KHR_lights_punctual.lights[0].extensions";
    let mut expected = [("X_unknown", "nodes[0].extensions"), ("Y_unknown", light)];
    expected.sort_unstable_by_key(|(what, _)| *what);
    let mut sorted = found.clone();
    sorted.sort_unstable();
    assert_eq!(sorted, expected);
    assert_eq!(find_unread(b"[1, {\"a\": 2"), []);
}
