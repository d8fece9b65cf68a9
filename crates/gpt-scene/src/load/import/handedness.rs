//! Normal maps on mirrored texture coordinates.
//!
//! There, green points across the normal and the tangent, wherever v grows; here, to where v grows. A mirror exchanges both. What has mirrored coordinates gets others whose
//! v runs the other way, and a material whose textures are turned over to make up for it: all pictures lie as before, and green points as there.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use glam::{DVec2, DVec3, Vec2};

use crate::load::file::material::MaterialEntry;
use crate::load::file::reference::FileOr;
use crate::load::file::shape::ShapeEntry;
use crate::load::file::value::{Exactly, Located, Number};
use crate::load::import::Description;
use crate::scene::Mesh;

/// Turns over what is mirrored and has a normal map.
pub fn turn_mirrored(scene: &mut Description) {
    let mapped = with_normal_maps(scene);
    if mapped.is_empty() {
        return;
    }
    let mut turned = Turned::default();
    let shapes = std::mem::take(&mut scene.file.shape);
    scene.file.shape = shapes.into_iter().flat_map(|shape| turned.shape(scene, shape, &mapped)).collect();
    for index in 0..scene.file.group.len() {
        let shapes = std::mem::take(&mut scene.file.group[index].shape);
        scene.file.group[index].shape = shapes.into_iter().flat_map(|shape| turned.shape(scene, shape, &mapped)).collect();
    }
}

/// The names of materials that have one, or blend one that has. Blends share their parts, so nothing is walked twice: where parts stand before
/// what blends them, as the reader puts them, the second pass finds nothing new.
fn with_normal_maps(scene: &Description) -> HashSet<String> {
    let materials = &scene.file.material;
    let has_map = materials.iter().filter(|entry| entry.common().normal_map.is_some());
    let mut mapped: HashSet<String> = has_map.map(|entry| entry.name().to_owned()).collect();
    let mut before = 0;
    while mapped.len() > before {
        before = mapped.len();
        for entry in materials {
            if entry.parts().iter().any(|part| mapped.contains(&part.value)) {
                mapped.insert(entry.name().to_owned());
            }
        }
    }
    mapped
}

/// The parts of a mesh, each with whether it was turned over.
type MeshParts = Vec<(Arc<Mesh>, bool)>;

/// Parts that were turned over before: meshes' parts by their addresses, materials and textures by their names.
#[derive(Default)]
struct Turned {
    /// The handedness of meshes at rest and of those that a mirror shows.
    meshes: HashMap<(usize, bool), MeshParts>,
    materials: HashMap<String, String>,
    textures: HashMap<String, String>,
}

impl Turned {
    /// The shape as it is, or in up to two parts.
    fn shape(
        &mut self,
        scene: &mut Description,
        shape: Located<ShapeEntry>,
        mapped: &HashSet<String>,
    ) -> Vec<Located<ShapeEntry>> {
        let ShapeEntry::Mesh(keys) = &shape.value else { return vec![shape] };
        let Some(material) = keys.material.clone().filter(|name| mapped.contains(&name.value)) else { return vec![shape] };
        let Some(FileOr::InMemory(mesh)) = keys.file.as_ref().map(|file| &file.value) else { return vec![shape] };
        let map = keys.transform.as_ref().and_then(|transform| transform.value.map());
        let parts = self.mesh(mesh, map.is_some_and(|map| map.matrix3.determinant() < 0.0));
        let part = |(mesh, is_turned): (Arc<Mesh>, bool)| {
            let mut part = keys.clone();
            part.file = Some(shape.place.at(FileOr::InMemory(mesh)));
            if is_turned {
                part.material = Some(material.place.at(self.material(scene, &material.value)));
            }
            shape.place.at(ShapeEntry::Mesh(part))
        };
        parts.into_iter().map(part).collect()
    }

    /// The faces that are as they should be, and those that were turned over.
    fn mesh(&mut self, mesh: &Arc<Mesh>, mirrors: bool) -> MeshParts {
        let key = (Arc::as_ptr(mesh) as usize, mirrors);
        if let Some(parts) = self.meshes.get(&key) {
            return parts.clone();
        }
        if mesh.uvs.is_empty() {
            return vec![(mesh.clone(), false)];
        }
        let (mirrored, others): (Vec<[u32; 3]>, Vec<[u32; 3]>) =
            mesh.faces.iter().partition(|face| is_mirrored(mesh, **face) != mirrors);
        let mut parts = Vec::new();
        if mirrored.is_empty() {
            parts.push((mesh.clone(), false));
        } else {
            if !others.is_empty() {
                parts.push((Arc::new(Mesh { faces: others, ..Mesh::clone(mesh) }), false));
            }
            let uvs = mesh.uvs.iter().map(|uv| Vec2::new(uv.x, -uv.y)).collect();
            parts.push((Arc::new(Mesh { faces: mirrored, uvs, ..Mesh::clone(mesh) }), true));
        }
        self.meshes.insert(key, parts.clone());
        parts
    }

    /// The material for coordinates whose v runs the other way.
    fn material(&mut self, scene: &mut Description, name: &str) -> String {
        if let Some(turned) = self.materials.get(name) {
            return turned.clone();
        }
        let turned = scene.free_material_name(&format!("{name}, mirrored"));
        self.materials.insert(name.to_owned(), turned.clone());
        let Some(mut entry) = scene.file.material.iter().find(|entry| entry.name() == name).cloned() else {
            return name.to_owned();
        };
        self.turn_over(scene, &mut entry);
        entry.common_mut().name.value = turned.clone();
        scene.material_variants.insert(turned.clone(), name.to_owned());
        scene.file.material.push(entry);
        turned
    }

    /// Lets a material look up turned textures, and blend turned materials.
    fn turn_over(&mut self, scene: &mut Description, entry: &mut MaterialEntry) {
        entry.each_texture(&mut |name| *name = self.texture(scene, name));
        for part in entry.parts_mut() {
            part.value = self.material(scene, &part.value);
        }
    }

    fn texture(&mut self, scene: &mut Description, name: &str) -> String {
        if let Some(turned) = self.textures.get(name) {
            return turned.clone();
        }
        let Some(mut entry) = scene.file.texture.iter().find(|entry| entry.name() == name).cloned() else {
            return name.to_owned();
        };
        let turned = scene.free_texture_name(&format!("{name}, mirrored"));
        if let Some(scale) = entry.scale_mut() {
            let [along_u, along_v] = scale.map_or([1.0; 2], |scale| scale.map(|factor| factor.0));
            // Both were possible before.
            *scale = Exactly::<Number, 2>::of([along_u, -along_v]).ok();
        }
        entry.common_mut().name.value = turned.clone();
        scene.file.texture.push(entry);
        self.textures.insert(name.to_owned(), turned.clone());
        turned
    }
}

/// v grows to the other side of the tangent than where the normal's cross product with it points.
fn is_mirrored(mesh: &Mesh, face: [u32; 3]) -> bool {
    let corner = |index: u32| mesh.positions[index as usize].as_dvec3();
    let uv = |index: u32| -> DVec2 { mesh.uvs[index as usize].as_dvec2() };
    let [a, b, c] = face;
    let uv_area = (uv(b) - uv(a)).perp_dot(uv(c) - uv(a));
    let area = (corner(b) - corner(a)).cross(corner(c) - corner(a));
    let normal: DVec3 = match mesh.smooth && !mesh.normals.is_empty() {
        true => face.into_iter().map(|index| mesh.normals[index as usize].as_dvec3()).sum(),
        false => area,
    };
    // The cross product of the directions in which u and v grow is the area over that in texture coordinates.
    area.dot(normal) * uv_area < 0.0
}
