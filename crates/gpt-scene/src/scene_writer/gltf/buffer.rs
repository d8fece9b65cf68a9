//! The numbers and pictures of the file.

use serde_json::{Value, json};

const FLOAT: u32 = 5126;
const UNSIGNED: u32 = 5125;
const VERTICES: u32 = 34_962;
const INDICES: u32 = 34_963;

/// Bytes with the views and accessors that name them.
#[derive(Default)]
pub struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    fn view(&mut self, content: &[u8], target: Option<u32>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": content.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.bytes.extend_from_slice(content);
        self.views.push(view);
        self.views.len() - 1
    }

    /// A view of a picture's file.
    pub fn picture(&mut self, content: &[u8]) -> usize {
        self.view(content, None)
    }

    /// An accessor of vectors, one for each vertex. `is_bounded`: the least and the largest of each coordinate are stated.
    pub fn vectors<const N: usize>(&mut self, values: &[[f32; N]], is_bounded: bool) -> usize {
        let view = self.view(bytemuck::cast_slice(values.as_flattened()), Some(VERTICES));
        let kind = format!("VEC{N}");
        let mut accessor = json!({ "bufferView": view, "componentType": FLOAT, "count": values.len(), "type": kind });
        if is_bounded {
            let bound = |fold: fn(f32, f32) -> f32, first: f32| -> Vec<f32> {
                (0..N).map(|axis| values.iter().map(|value| value[axis]).fold(first, fold)).collect()
            };
            accessor["min"] = json!(bound(f32::min, f32::INFINITY));
            accessor["max"] = json!(bound(f32::max, f32::NEG_INFINITY));
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// An accessor of the corners of triangles.
    pub fn corners(&mut self, faces: &[[u32; 3]]) -> usize {
        let view = self.view(bytemuck::cast_slice(faces.as_flattened()), Some(INDICES));
        let count = 3 * faces.len();
        self.accessors.push(json!({ "bufferView": view, "componentType": UNSIGNED, "count": count, "type": "SCALAR" }));
        self.accessors.len() - 1
    }

    /// The bytes, the views and the accessors.
    pub fn into_parts(mut self) -> (Vec<u8>, Vec<Value>, Vec<Value>) {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        (self.bytes, self.views, self.accessors)
    }
}
