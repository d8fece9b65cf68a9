//! Normal maps on mirrored texture coordinates.
//!
//! There, green points across the normal and the tangent, wherever v grows; here, to where v grows. A mirror exchanges both. What has mirrored coordinates gets others whose
//! v runs the other way, and a material whose textures are turned over to make up for it: all pictures lie as before, and green points as there.

use std::collections::{HashMap, HashSet};

use glam::{DVec2, DVec3, Vec2};

use crate::load::import::{Description, Entry, FileReference, Keys, Value, list, matrix_of};
use crate::scene::Mesh;

/// Turns over what is mirrored and has a normal map.
pub fn turn_mirrored(scene: &mut Description) {
    let bent = with_normal_maps(scene);
    if bent.is_empty() {
        return;
    }
    let mut turned = Turned::default();
    let shapes = std::mem::take(&mut scene.shapes);
    scene.shapes = shapes.into_iter().flat_map(|shape| turned.shape(scene, shape, &bent)).collect();
    for index in 0..scene.groups.len() {
        let shapes = std::mem::take(&mut scene.groups[index].shapes);
        scene.groups[index].shapes = shapes.into_iter().flat_map(|shape| turned.shape(scene, shape, &bent)).collect();
    }
}

/// The names of materials that have one, or blend one that has. Blends share their parts, so nothing is walked twice: where parts stand before
/// what blends them, as the reader puts them, the second pass finds nothing new.
fn with_normal_maps(scene: &Description) -> HashSet<String> {
    let named = || scene.materials.iter().filter_map(|entry| Some((entry.keys.text("name")?, &entry.keys)));
    let has_map = named().filter(|(_, keys)| keys.get("normal_map").is_some());
    let mut bent: HashSet<String> = has_map.map(|(name, _)| name.to_owned()).collect();
    let mut before = 0;
    while bent.len() > before {
        before = bent.len();
        for (name, keys) in named() {
            if parts(keys).any(|part| bent.contains(part)) {
                bent.insert(name.to_owned());
            }
        }
    }
    bent
}

/// What a blend blends.
fn parts(material: &Keys) -> impl Iterator<Item = &str> {
    let names = if let Some(Value::List(names)) = material.get("materials") { &names[..] } else { &[] };
    names.iter().filter_map(|name| if let Value::Text(name) = name { Some(name.as_str()) } else { None })
}

/// What was turned over before: a mesh file's parts, materials and textures, by their names.
#[derive(Default)]
struct Turned {
    /// The handedness of meshes at rest and of those that a mirror shows.
    meshes: HashMap<(usize, bool), Vec<(FileReference, bool)>>,
    materials: HashMap<String, String>,
    textures: HashMap<String, String>,
}

impl Turned {
    /// The shape as it is, or in up to two parts.
    fn shape(&mut self, scene: &mut Description, shape: Entry, bent: &HashSet<String>) -> Vec<Entry> {
        let Some(material) = shape.keys.text("material").filter(|name| bent.contains(*name)) else {
            return vec![shape];
        };
        let (material, Some(Value::File(FileReference::Held(index)))) = (material.to_owned(), shape.keys.get("file")) else {
            return vec![shape];
        };
        let mirrors = shape.keys.get("transform").and_then(matrix_of).is_some_and(|map| map.matrix3.determinant() < 0.0);
        let parts = self.mesh(scene, *index, mirrors);
        let part = |(file, is_turned): (FileReference, bool)| {
            let mut part = shape.clone();
            part.keys.set("file", file);
            if is_turned {
                part.keys.set("material", self.material(scene, &material));
            }
            part
        };
        parts.into_iter().map(part).collect()
    }

    /// The faces that are as they should be, and those that were turned over.
    fn mesh(&mut self, scene: &mut Description, index: usize, mirrors: bool) -> Vec<(FileReference, bool)> {
        if let Some(parts) = self.meshes.get(&(index, mirrors)) {
            return parts.clone();
        }
        let whole = FileReference::Held(index);
        let Some(mesh) = scene.mesh(&whole).filter(|mesh| !mesh.uvs.is_empty()).cloned() else { return vec![(whole, false)] };
        let (mirrored, others): (Vec<[u32; 3]>, Vec<[u32; 3]>) =
            mesh.faces.iter().partition(|face| is_mirrored(&mesh, **face) != mirrors);
        let mut parts = Vec::new();
        if mirrored.is_empty() {
            parts.push((whole, false));
        } else {
            let name = scene.held.get(index).map_or("", |(name, _)| name);
            let name = name.split_once('-').map_or(name, |(_, name)| name).trim_end_matches(".ply").to_owned();
            let uvs = mesh.uvs.iter().map(|uv| Vec2::new(uv.x, -uv.y)).collect();
            let turned = Mesh { faces: mirrored, uvs, ..Mesh::clone(&mesh) };
            if !others.is_empty() {
                parts.push((scene.hold_mesh(&name, Mesh { faces: others, ..Mesh::clone(&mesh) }), false));
            }
            parts.push((scene.hold_mesh(&format!("{name}-mirrored"), turned), true));
        }
        self.meshes.insert((index, mirrors), parts.clone());
        parts
    }

    /// The material for coordinates whose v runs the other way.
    fn material(&mut self, scene: &mut Description, name: &str) -> String {
        if let Some(turned) = self.materials.get(name) {
            return turned.clone();
        }
        let turned = scene.free_material_name(&format!("{name}, mirrored"));
        self.materials.insert(name.to_owned(), turned.clone());
        let Some(mut entry) = scene.materials.iter().find(|entry| entry.keys.text("name") == Some(name)).cloned() else {
            return name.to_owned();
        };
        self.keys(scene, &mut entry.keys);
        entry.keys.set("name", turned.as_str());
        scene.material_variants.insert(turned.clone(), name.to_owned());
        scene.materials.push(entry);
        turned
    }

    fn keys(&mut self, scene: &mut Description, keys: &mut Keys) {
        for (key, value) in &mut keys.0 {
            match value {
                Value::Text(name) if ["texture", "normal_map", "coat_normal_map", "bump_map"].contains(key) => {
                    *name = self.texture(scene, name);
                }
                Value::List(names) if *key == "materials" => {
                    for name in names {
                        if let Value::Text(name) = name {
                            *name = self.material(scene, name);
                        }
                    }
                }
                Value::Table(keys) => self.keys(scene, keys),
                _ => {}
            }
        }
    }

    fn texture(&mut self, scene: &mut Description, name: &str) -> String {
        if let Some(turned) = self.textures.get(name) {
            return turned.clone();
        }
        let Some(mut entry) = scene.textures.iter().find(|entry| entry.keys.text("name") == Some(name)).cloned() else {
            return name.to_owned();
        };
        let turned = scene.free_texture_name(&format!("{name}, mirrored"));
        let [along_u, along_v] = match entry.keys.get("scale") {
            Some(Value::List(factors)) => match factors[..] {
                [Value::Number(u), Value::Number(v)] => [u, v],
                _ => [1.0; 2],
            },
            _ => [1.0; 2],
        };
        entry.keys.set("scale", list([along_u, -along_v]));
        entry.keys.set("name", turned.as_str());
        scene.textures.push(entry);
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
