//! Meshes as scene files have them: by the file they came from, a file beside the scene file, or a few faces written out.

use std::sync::Arc;

use super::deformation;
use crate::load::file::writer::{Writer, line, list, named_file, pair_f32, ply, table, text, vector_f32};
use crate::scene::{MaterialId, Mesh, MeshSource, Shape};

/// Larger meshes that come from no file lie in one beside the scene file.
const MOST_INLINE_FACES: usize = 24;

/// The keys of a mesh and its material, a line each.
pub fn write(mesh: &Arc<Mesh>, shape: &Shape, writer: &mut Writer<'_>) -> String {
    let scene = writer.scene;
    if let Some(track) = scene.animation.deformations.iter().find(|track| Arc::ptr_eq(&track.rest, mesh)) {
        let deformation = &track.deformation;
        return write(&deformation.base, shape, writer) + &deformation::write(deformation, writer);
    }
    if let Some(source) = named_file(scene, mesh) {
        return named_mesh(shape, source, writer);
    }
    let smooth = line("smooth", &mesh.smooth.to_string());
    if mesh.faces.len() > MOST_INLINE_FACES || mesh.smooth || !mesh.face_materials.is_empty() {
        return mesh_beside(mesh, shape, writer) + &smooth;
    }
    let mut out = line("positions", &list(mesh.positions.iter().map(|&position| vector_f32(position))));
    out += &line("faces", &list(mesh.faces.iter().map(|face| list(face.map(|corner| corner.to_string())))));
    if !mesh.uvs.is_empty() {
        out += &line("uvs", &list(mesh.uvs.iter().map(|&uv| pair_f32(uv))));
    }
    if !mesh.second_uvs.is_empty() {
        out += &line("second_uvs", &list(mesh.second_uvs.iter().map(|&uv| pair_f32(uv))));
    }
    out + &writer.material_of(shape) + &smooth
}

fn named_mesh(shape: &Shape, source: &MeshSource, writer: &Writer<'_>) -> String {
    let mut out = line("file", &writer.files.name_of(&source.path));
    if !source.own_materials {
        out += &writer.material_of(shape);
    } else if !source.replaced.is_empty() {
        let id = |name: &str| writer.scene.materials.iter().position(|material| material.name == name);
        let rows = source.replaced.iter().filter_map(|(of_file, name)| Some((of_file, id(name)?)));
        out += &line("materials", &table(rows.map(|(of_file, id)| (text(of_file), writer.materials.quoted(id)))));
    }
    if let Some(smooth) = source.smooth {
        out += &line("smooth", &smooth.to_string());
    }
    out
}

/// Writes the mesh into a file of its own; faces of several materials have a number in place of theirs.
fn mesh_beside(mesh: &Mesh, shape: &Shape, writer: &mut Writer<'_>) -> String {
    let name = format!("mesh-{}.ply", writer.files.len() + 1);
    if mesh.face_materials.is_empty() {
        return line("file", &writer.files.add(&name, ply(mesh, None))) + &writer.material_of(shape);
    }
    let mut used: Vec<MaterialId> = mesh.face_materials.clone();
    used.sort_unstable();
    used.dedup();
    // Every material of a face is among those that are used.
    let group = |id: &MaterialId| used.binary_search(id).unwrap_or_default() as u32;
    let groups: Vec<u32> = mesh.face_materials.iter().map(group).collect();
    let rows = table(used.iter().enumerate().map(|(group, &id)| (group.to_string(), writer.materials.quoted(id))));
    line("file", &writer.files.add(&name, ply(mesh, Some(&groups)))) + &line("materials", &rows)
}
