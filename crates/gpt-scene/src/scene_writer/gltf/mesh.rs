//! Meshes: the triangles of shapes, a primitive for each material.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::{DAffine3, Vec3};
use serde_json::{Value, json};

use super::Writer;
use super::made::{Made, MeshKey};
use super::paint::Painted;
use super::tangents::with_tangents;
use crate::scene::shape::tessellation::{PLANE, part_of};
use crate::scene::{Geometry, MaterialId, Mesh, Shape, Transform, TransformStep};

impl Writer<'_> {
    /// The index of the mesh of a shape in its own space; None where there is nothing to see.
    pub fn mesh_of_shape(&mut self, shape: &Shape, place: &str) -> Option<usize> {
        let key = match &shape.geometry {
            Geometry::Mesh(mesh) => Some(MeshKey::Shared(Arc::as_ptr(mesh) as usize, shape.material)),
            _ => None,
        };
        if let Some(made) = key.as_ref().and_then(|key| self.made_meshes.get(key)) {
            return *made;
        }
        let primitives = self.primitives(shape, place, None, &DAffine3::IDENTITY);
        let made = self.push_mesh(&shape.label, primitives);
        if let Some(key) = key {
            self.made_meshes.insert(key, made);
        }
        made
    }

    /// The index of the mesh of a group, with a material in place of its own ones if one is given.
    pub fn mesh_of_group(&mut self, group: usize, material: Option<MaterialId>) -> Option<usize> {
        let key = MeshKey::Group(group, material);
        if let Some(made) = self.made_meshes.get(&key) {
            return *made;
        }
        let scene = self.scene;
        let of = &scene.groups[group];
        let mut primitives = Vec::new();
        for (index, shape) in of.shapes.iter().enumerate() {
            let place = format!("group[{group}].shape[{index}]");
            primitives.extend(self.primitives(shape, &place, material, &shape.transform.to_affine()));
        }
        let made = self.push_mesh(&of.name, primitives);
        self.made_meshes.insert(key, made);
        made
    }

    fn push_mesh(&mut self, name: &str, primitives: Vec<Value>) -> Option<usize> {
        if primitives.is_empty() {
            return None;
        }
        self.lists.meshes.push(json!({ "name": name, "primitives": primitives }));
        Some(self.lists.meshes.len() - 1)
    }

    /// The primitives of a shape where a map puts it, one for each of its materials.
    fn primitives(&mut self, shape: &Shape, place: &str, replaced: Option<MaterialId>, map: &DAffine3) -> Vec<Value> {
        let made = shape.geometry.tessellated();
        let kind = shape.geometry.kind_name();
        if made.deviation > 0.0 {
            let scale = shape.transform.to_affine().matrix3.x_axis.length();
            let (places, most) = self.round.entry(kind).or_default();
            places.push(place.to_owned());
            *most = most.max(made.deviation * scale);
        } else if shape.geometry.is_infinite() {
            self.approximate(format!("shape `{kind}`"), place, format!("a square of {} units is taken", 2.0 * PLANE));
        }
        let own: BTreeSet<MaterialId> = shape.materials().collect();
        let mut primitives = Vec::new();
        for &id in &own {
            let scene = self.scene;
            // Openings stay openings.
            let shown = replaced.filter(|_| !scene.materials[id].is_nothing()).unwrap_or(id);
            let Some(material) = self.material(shown) else { continue };
            let part =
                if own.len() > 1 { part_of(&made.mesh, |face| shape.face_material(face) == id) } else { (*made.mesh).clone() };
            if !part.faces.is_empty() {
                primitives.push(self.primitive(placed(part, map), &material, place));
            }
        }
        primitives
    }

    fn primitive(&mut self, mesh: Mesh, material: &Made, place: &str) -> Value {
        let Painted { mut mesh, colours } = self.painted(mesh, material, place);
        // One set of a mesh serves for both. The second one needs a first.
        if material.uses_sets[1] && mesh.second_uvs.is_empty() {
            mesh.second_uvs.clone_from(&mesh.uvs);
        }
        if material.uses_sets[1] && mesh.uvs.is_empty() {
            mesh.uvs.clone_from(&mesh.second_uvs);
        }
        // Vertices with colours stay as many as they are.
        let can_be_split = mesh.smooth || colours.is_none();
        let tangents = if material.needs_tangents && can_be_split && !mesh.uvs.is_empty() {
            let (made, tangents) = with_tangents(mesh);
            mesh = made;
            Some(tangents)
        } else {
            None
        };
        let mut attributes = json!({ "POSITION": self.buffer.vectors(&arrays(&mesh.positions, Vec3::to_array), true) });
        if mesh.smooth && !mesh.normals.is_empty() {
            // Lengths of 1 are asked for.
            let unit = |normal: &Vec3| normal.normalize_or(Vec3::Y).to_array();
            attributes["NORMAL"] = json!(self.buffer.vectors(&arrays(&mesh.normals, unit), false));
        }
        if let Some(tangents) = tangents {
            attributes["TANGENT"] = json!(self.buffer.vectors(&tangents, false));
        }
        let sets = [material.uses_sets[0] || material.uses_sets[1], material.uses_sets[1]];
        for (is_used, uvs, name) in [(sets[0], &mesh.uvs, "TEXCOORD_0"), (sets[1], &mesh.second_uvs, "TEXCOORD_1")] {
            if is_used && !uvs.is_empty() {
                // v runs downward there.
                attributes[name] = json!(self.buffer.vectors(&arrays(uvs, |uv| [uv.x, 1.0 - uv.y]), false));
            }
        }
        if let Some(colours) = colours {
            attributes["COLOR_0"] = json!(self.buffer.vectors(&colours, false));
        }
        json!({ "attributes": attributes, "indices": self.buffer.corners(&mesh.faces), "material": material.index })
    }
}

fn arrays<T, const N: usize>(values: &[T], array: impl Fn(&T) -> [f32; N]) -> Vec<[f32; N]> {
    values.iter().map(array).collect()
}

/// The mesh where a map puts it, its fronts where they were.
fn placed(mesh: Mesh, map: &DAffine3) -> Mesh {
    if *map == DAffine3::IDENTITY {
        return mesh;
    }
    let own = Shape {
        label: String::new(),
        geometry: Geometry::Mesh(mesh.clone().into()),
        material: 0,
        transform: Transform { steps: vec![TransformStep::Matrix(*map)] },
        motion: None,
        portal: false,
        receiver: 0,
    };
    Mesh { positions: own.world_positions(), normals: own.world_normals(), faces: own.world_faces(), ..mesh }
}
