//! Shapes from files: OBJ, PLY and Mitsuba's own.

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::converter::{Converter, MeshKey, ReadMesh};
use super::plugin::{Plugin, PropertyValue};
use super::serialized;
use super::shape::Looks;
use crate::load::error::{SceneError, show};
use crate::load::file::shape::ShapeEntry;
use crate::load::file::syntax::TextureEntry;
use crate::load::files::Files;
use crate::load::import::{Blocks, barycentric_coordinates, is_uniform, smooth_by_index, turn_inside_out};
use crate::load::{obj, ply};
use crate::scene::Mesh;

const WITHOUT_AREA: &str = "mesh without a face that has area";

impl Converter<'_> {
    pub fn mesh_shape(
        &mut self,
        plugin: &Rc<Plugin>,
        (around, own): (DAffine3, DAffine3),
        looks: Looks,
    ) -> Result<Option<(ShapeEntry, DAffine3)>, SceneError> {
        let Looks { textured, flip, attributes, .. } = looks;
        let map = around * own;
        plugin.without_effect(&[
            "max_smooth_angle",
            "collapse",
            "optimize",
            "kd_tree",
            "load_materials",
            "srgb",
            "has_vertex_normals",
        ]);
        let written =
            plugin.text("filename")?.ok_or_else(|| plugin.error(format!("{} needs the string `filename`", plugin.title())))?;
        let path = self.reader.find(written).ok_or_else(|| plugin.error(format!("there is no file {written}")))?;
        let index = plugin.number_or("shape_index", 0.0)?;
        let flat = plugin.flag("face_normals", false)?;
        // Our v runs upward over a picture, and pictures are turned over: OBJ's v has to follow.
        let turn_uv = plugin.flag("flip_tex_coords", plugin.name == "obj")?;
        if plugin.has("max_smooth_angle") {
            self.approximate(plugin, "`max_smooth_angle`", "normals are as the file has them, or smooth everywhere");
        }
        // Normals that no file has are made once the mesh is where `to_world` puts it.
        let (mirrors, uneven) = (own.matrix3.determinant() < 0.0, !flat && !is_uniform(&own));
        let by_map = if uneven { format!("{:?}", own.matrix3) } else { format!("{mirrors}") };
        let key = format!("{} {index} {flat} {flip} {turn_uv} {textured} {attributes} {by_map} {}", path.display(), plugin.name);
        if let Some(mesh) = self.meshes.get(&key).cloned() {
            self.attributes = self.attributes_of_meshes.get(&key).cloned();
            return self.mesh_entry(plugin, mesh, map).map(Some);
        }
        // Meshes known to have no area are not read again.
        if self.meshes_without_area.contains(&key) {
            self.drop(plugin, WITHOUT_AREA, "it is left out");
            return Ok(None);
        }
        let file: MeshKey = (path.clone(), plugin.name.clone(), index.to_bits());
        let ReadMesh { mut mesh, mends } = match self.read_meshes.remove(&file) {
            Some(known) => known,
            None => read(self.files, &file),
        }
        .map_err(|error| error.with_help(format!("{} names it", plugin.place)))?;
        for mend in mends {
            let line = mend.line.map_or_else(String::new, |line| format!("line {line}: "));
            self.approximate(plugin, &format!("`{}`", show(&path)), line + &mend.what);
        }
        if mesh.drop_degenerate_faces() > 0 && mesh.faces.is_empty() {
            self.drop(plugin, WITHOUT_AREA, "it is left out");
            self.meshes_without_area.insert(key);
            return Ok(None);
        }
        let lacks_normals = flat || mesh.normals.is_empty();
        if flat {
            mesh.normals.clear();
        } else if lacks_normals && uneven {
            smooth_once_placed(&mut mesh, own.matrix3);
        } else if lacks_normals {
            smooth_by_index(&mut mesh);
        } else {
            complete_normals(&mut mesh);
        }
        mesh.smooth = !mesh.normals.is_empty();
        // Faces that a mirror turns over decide where their fronts are, unless the file has normals.
        if flip != (mirrors && lacks_normals) {
            turn_inside_out(&mut mesh);
        }
        if turn_uv {
            mesh.uvs.iter_mut().for_each(|uv| uv.y = 1.0 - uv.y);
        }
        if attributes {
            self.take_attributes(plugin, &path, &key, &mut mesh)?;
        }
        if textured && mesh.uvs.is_empty() {
            barycentric_coordinates(&mut mesh, [Vec2::ZERO, Vec2::X, Vec2::Y]);
        }
        if !textured {
            mesh.uvs.clear();
        }
        let mesh = self.meshes.entry(key).or_insert(Arc::new(mesh)).clone();
        self.mesh_entry(plugin, mesh, map).map(Some)
    }

    /// Makes pictures of the numbers that the vertices and faces of a PLY file have, and texture coordinates that lead there.
    fn take_attributes(&mut self, plugin: &Plugin, path: &Path, key: &str, mesh: &mut Mesh) -> Result<(), SceneError> {
        let mut inputs = HashMap::new();
        if plugin.name == "ply" {
            let model = ply::load_with_attributes(self.files, path)?;
            // The model has the same faces, unless another plugin of this file left some out.
            let faces = model.parts.iter().map(|part| part.mesh.faces.len()).sum::<usize>();
            if faces == mesh.faces.len() && !model.attributes.is_empty() {
                let blocks = Blocks::of(mesh);
                for attribute in &model.attributes {
                    let name = format!("{}_{}", if attribute.of_faces { "face" } else { "vertex" }, attribute.name);
                    let made = blocks.texture(attribute, None, &plugin.at());
                    let made = made.ok_or_else(|| plugin.error(format!("the attribute `{name}` makes no picture")))?;
                    inputs.insert(name.clone(), self.add_texture(plugin, &name, TextureEntry::Image(made)));
                }
            }
        }
        let number = self.attributes_of_meshes.len();
        let made = (number, Rc::new(inputs));
        self.attributes_of_meshes.insert(key.to_owned(), made.clone());
        self.attributes = Some(made);
        Ok(())
    }

    /// Reads all files that shapes name, on all cores. What cannot be read is reported when its shape is made.
    pub fn read_side_by_side(&mut self, root: &Rc<Plugin>) {
        let mut wanted: HashSet<MeshKey> = HashSet::new();
        let mut seen: HashSet<*const Plugin> = HashSet::new();
        let mut to_visit = vec![root.clone()];
        while let Some(plugin) = to_visit.pop() {
            if !seen.insert(Rc::as_ptr(&plugin)) {
                continue;
            }
            to_visit.extend(plugin.children.iter().map(|child| child.plugin.clone()));
            let value = |name: &str| plugin.properties.iter().find(|one| one.name == name).map(|one| &one.value);
            if let (true, Some(PropertyValue::Text(written))) = (FORMATS.contains(&plugin.name.as_str()), value("filename"))
                && let Some(path) = self.reader.find(written)
            {
                let index = if let Some(PropertyValue::Number(number)) = value("shape_index") { *number } else { 0.0 };
                wanted.insert((path, plugin.name.clone(), index.to_bits()));
            }
        }
        let files = self.files;
        files.progress().expect(wanted.len());
        let read = |key: MeshKey| {
            let mesh = read(files, &key);
            files.progress().one_was_read();
            (mesh, key)
        };
        self.read_meshes = wanted.into_par_iter().map(read).map(|(mesh, key)| (key, mesh)).collect();
    }
}

/// Elements whose plugins read files.
const FORMATS: [&str; 3] = ["obj", "ply", "serialized"];

/// Reads a mesh. The error is that of the file, or why it is none.
fn read(files: &Files, (path, format, index): &MeshKey) -> Result<ReadMesh, SceneError> {
    let file = match format.as_str() {
        "serialized" => {
            let mesh = serialized::load(files, path, f64::from_bits(*index));
            let mesh = mesh.map_err(|reason| SceneError::in_file(show(path), reason))?;
            return Ok(ReadMesh { mesh, mends: Vec::new() });
        }
        "ply" => ply::load(files, path)?,
        _ => obj::load(files, path, false)?,
    };
    let all_normals = file.parts.iter().all(|part| !part.mesh.normals.is_empty());
    let all_uvs = file.parts.iter().all(|part| !part.mesh.uvs.is_empty());
    let mut mesh = Mesh::default();
    for mut part in file.parts {
        if !all_normals {
            part.mesh.normals.clear();
        }
        if !all_uvs {
            part.mesh.uvs.clear();
        }
        mesh.append(part.mesh);
    }
    // Groups of an OBJ file share vertices there.
    if format == "obj" && !all_normals {
        join_vertices(&mut mesh);
    }
    Ok(ReadMesh { mesh, mends: file.substitutes.into_iter().map(|(_, mend)| mend).collect() })
}

/// One vertex for all of the same place and texture coordinates.
fn join_vertices(mesh: &mut Mesh) {
    let mut places: std::collections::HashMap<[u32; 5], u32> = Default::default();
    let old = std::mem::take(mesh);
    let mut new = Vec::with_capacity(old.positions.len());
    for (index, position) in old.positions.iter().enumerate() {
        let uv = old.uvs.get(index).copied().unwrap_or_default();
        let key = [position.x, position.y, position.z, uv.x, uv.y].map(f32::to_bits);
        let next = mesh.positions.len() as u32;
        let place = *places.entry(key).or_insert(next);
        if place == next {
            mesh.positions.push(*position);
            mesh.uvs.extend(old.uvs.get(index));
        }
        new.push(place);
    }
    mesh.faces = old.faces.iter().map(|face| face.map(|corner| new[corner as usize])).collect();
    mesh.drop_degenerate_faces();
}

/// Gives the mesh the normals that become those of its faces where a map puts it.
fn smooth_once_placed(mesh: &mut Mesh, map: DMat3) {
    let mut placed = mesh.clone();
    placed.positions.iter_mut().for_each(|position| *position = (map * position.as_dvec3()).as_vec3());
    smooth_by_index(&mut placed);
    let (back, sign) = (map.transpose(), map.determinant().signum());
    let turned = |normal: &Vec3| (back * normal.as_dvec3() * sign).normalize_or(DVec3::Z).as_vec3();
    mesh.normals = placed.normals.iter().map(turned).collect();
}

/// Normals of no length are computed.
fn complete_normals(mesh: &mut Mesh) {
    let lacking = |normal: &Vec3| !(normal.is_finite() && normal.length_squared() > 1e-20);
    if !mesh.normals.iter().any(lacking) {
        return;
    }
    let written = std::mem::take(&mut mesh.normals);
    smooth_by_index(mesh);
    for (normal, written) in mesh.normals.iter_mut().zip(written) {
        if !lacking(&written) {
            *normal = written;
        }
    }
}
