//! Nodes: what stands where.

use glam::{DAffine3, DMat4};
use serde_json::json;

use super::Writer;

impl Writer<'_> {
    pub fn shapes(&mut self) {
        let scene = self.scene;
        for (index, shape) in scene.shapes.iter().enumerate() {
            let place = format!("shape[{index}]");
            if shape.motion.is_some() {
                self.drop("motion", &place, "the shape rests where the shutter opens");
            }
            let Some(mesh) = self.mesh_of_shape(shape, &place) else { continue };
            self.place_mesh(&shape.label, mesh, &shape.transform.to_affine());
        }
    }

    pub fn instances(&mut self) {
        let scene = self.scene;
        for (index, instances) in scene.instances.iter().enumerate() {
            let place = format!("instance[{index}]");
            if instances.motion.is_some() {
                self.drop("motion", &place, "instances rest where the shutter opens");
            }
            let Some(mesh) = self.mesh_of_group(instances.group, instances.material) else { continue };
            for map in instances.maps() {
                self.place_mesh(&instances.label, mesh, &map);
            }
        }
    }

    fn place_mesh(&mut self, name: &str, mesh: usize, map: &DAffine3) {
        let mut node = json!({ "name": name, "mesh": mesh });
        if *map != DAffine3::IDENTITY {
            node["matrix"] = json!(columns(map));
        }
        self.lists.nodes.push(node);
    }
}

/// The sixteen numbers of a map, column by column.
pub fn columns(map: &DAffine3) -> [f64; 16] {
    DMat4::from(*map).to_cols_array()
}
