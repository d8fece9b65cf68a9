//! The glTF of a triangle, of which tests make larger ones.

use serde_json::{Value, json};

/// A mesh of one primitive, whose positions are the accessor 0, in the node 0, changed by `fill`.
pub fn gltf(fill: impl FnOnce(&mut Value)) -> Vec<u8> {
    let positions = "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let mut root = json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "buffers": [{ "byteLength": 36, "uri": positions }],
    });
    fill(&mut root);
    serde_json::to_vec(&root).expect("JSON")
}
