//! Triangles, in the text or in PLY files.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::{Geometry, Needs, face_normals};
use crate::load::error::{SceneError, show};
use crate::load::files::Files;
use crate::load::import::{barycentric_coordinates, turn_inside_out};
use crate::load::pbrt::converter::{Converter, ReadMesh};
use crate::load::pbrt::parameter::{Entity, Kind};
use crate::load::pbrt::world::ShapeRecord;
use crate::load::ply;
use crate::scene::Mesh;

/// The texture coordinates of a triangle's corners where none are said.
const CORNERS: [Vec2; 3] = [Vec2::ZERO, Vec2::X, Vec2::ONE];

impl Converter<'_> {
    pub(super) fn triangle_mesh(&mut self, record: &ShapeRecord, needs: Needs) -> Result<Option<Geometry>, SceneError> {
        let entity = &record.entity;
        // Numbers of faces are for textures of a format that is not read.
        entity.without_effect(&["faceIndices"]);
        let mut mesh = self.vertices(entity)?;
        let count = mesh.positions.len();
        let indices = indices(entity, count, if count == 3 { &[0, 1, 2] } else { &[] })?;
        if !indices.len().is_multiple_of(3) {
            self.drop(entity.spot_of("indices"), "indices beyond the last whole triangle", "they are left out");
        }
        mesh.faces = indices.chunks_exact(3).map(|face| [face[0], face[1], face[2]]).collect();
        face_normals(&mut mesh);
        self.finish_mesh(record, needs, mesh)
    }

    /// The vertices of a mesh that is written, with normals and texture coordinates where there are as many.
    pub(super) fn vertices(&mut self, entity: &Entity) -> Result<Mesh, SceneError> {
        let triples = |name: &str, kind: Kind| -> Result<Vec<Vec3>, SceneError> {
            let list = entity.list(name, kind, 3)?;
            Ok(list.chunks_exact(3).map(|at| Vec3::new(at[0] as f32, at[1] as f32, at[2] as f32)).collect())
        };
        let positions = triples("P", Kind::Point3)?;
        if positions.is_empty() {
            return Err(entity.error(format!("{} needs \"point3 P\", the places of its vertices", entity.title())));
        }
        if !positions.iter().all(|position| position.is_finite()) {
            return Err(entity.spot_of("P").error("`P` has a place out of the range of numbers"));
        }
        let normals = triples("N", Kind::Normal)?;
        let uvs: Vec<Vec2> =
            entity.list("uv", Kind::Point2, 2)?.chunks_exact(2).map(|at| Vec2::new(at[0] as f32, at[1] as f32)).collect();
        let mut mesh = Mesh { positions, normals, uvs, ..Mesh::default() };
        let count = mesh.positions.len();
        for (name, found) in [("N", mesh.normals.len()), ("uv", mesh.uvs.len())] {
            if found != 0 && found != count {
                let what = format!("`{name}` of another number than `P`");
                self.drop(entity.spot_of(name), what, "they are left out, as there");
            }
        }
        if mesh.normals.len() != count || !mesh.normals.iter().all(|normal| normal.is_finite()) {
            mesh.normals.clear();
        }
        if mesh.uvs.len() != count || !mesh.uvs.iter().all(|uv| uv.is_finite()) {
            mesh.uvs.clear();
        }
        mesh.smooth = !mesh.normals.is_empty();
        Ok(mesh)
    }

    /// A mesh whose fronts are turned where that is said, with texture coordinates where they are looked up.
    pub(super) fn finish_mesh(
        &mut self,
        record: &ShapeRecord,
        needs: Needs,
        mut mesh: Mesh,
    ) -> Result<Option<Geometry>, SceneError> {
        if record.reverses {
            turn_inside_out(&mut mesh);
        }
        let has_coordinates = needs.looks.is_textured || needs.looks.is_bent;
        if has_coordinates && mesh.uvs.is_empty() {
            let corners = if record.reverses { [CORNERS[0], CORNERS[2], CORNERS[1]] } else { CORNERS };
            barycentric_coordinates(&mut mesh, corners);
        }
        self.geometry_of_mesh(record, needs, mesh)
    }

    pub(super) fn ply_mesh(&mut self, record: &ShapeRecord, needs: Needs) -> Result<Option<Geometry>, SceneError> {
        let entity = &record.entity;
        let path = self.ply_path(entity)?;
        let has_coordinates = needs.looks.is_textured || needs.looks.is_bent;
        let key = format!("{} {} {has_coordinates}", path.display(), record.reverses);
        if let Some(mesh) = self.meshes.get(&key).cloned() {
            return self.placed_mesh(record, mesh).map(Some);
        }
        let read = self.read_meshes.remove(&path).unwrap_or_else(|| read(self.files, &path));
        let ReadMesh { mut mesh, mends } = read.map_err(|error| error.with_help(format!("{} names it", entity.spot)))?;
        for mend in mends {
            let line = mend.line.map_or_else(String::new, |line| format!("line {line}: "));
            self.approximate(&entity.spot, format!("`{}`", show(&path)), line + &mend.what);
        }
        mesh.smooth = !mesh.normals.is_empty();
        face_normals(&mut mesh);
        if has_coordinates && mesh.uvs.is_empty() {
            let instead = "each of its triangles has (0, 0), (1, 0) and (1, 1) in its corners; there faces of four corners have the unit square";
            self.approximate(&entity.spot, "texture on a PLY file without texture coordinates", instead);
        }
        let geometry = self.finish_mesh(record, needs, mesh)?;
        if let Some(mesh) = geometry.as_ref().and_then(|geometry| crate::load::import::mesh_of(&geometry.entry)) {
            self.meshes.insert(key, mesh.clone());
        }
        Ok(geometry)
    }

    fn ply_path(&self, entity: &Entity) -> Result<PathBuf, SceneError> {
        let written = entity.text("filename")?.ok_or_else(|| entity.error("a plymesh needs \"string filename\""))?;
        let found = self.files.find(&self.folder, written);
        Ok(found.ok_or_else(|| entity.spot_of("filename").error(format!("there is no file {written}")))?.path)
    }

    /// Reads all files that shapes name, on all cores. What cannot be read is reported when its shape is made.
    pub fn read_side_by_side(&mut self) {
        let world = self.world.clone();
        let shapes = world.shapes.iter().chain(world.objects.iter().flat_map(|object| &object.shapes));
        let meshes = shapes.filter(|shape| shape.entity.name == "plymesh");
        let wanted: HashSet<PathBuf> = meshes.filter_map(|shape| self.ply_path(&shape.entity).ok()).collect();
        let files = self.files;
        files.progress().expect(wanted.len());
        let read = |path: PathBuf| {
            let mesh = read(files, &path);
            files.progress().one_was_read();
            (path, mesh)
        };
        self.read_meshes = wanted.into_par_iter().map(read).collect();
    }
}

/// The numbers of vertices, all of which are there.
pub(super) fn indices(entity: &Entity, vertices: usize, otherwise: &[u32]) -> Result<Vec<u32>, SceneError> {
    let list = entity.list("indices", Kind::Integer, 1)?;
    if list.is_empty() {
        if otherwise.is_empty() {
            return Err(entity.error(format!("{} needs \"integer indices\"", entity.title())));
        }
        return Ok(otherwise.to_vec());
    }
    if let Some(beyond) = list.iter().find(|index| !(0.0..vertices as f64).contains(*index)) {
        let message = format!("`indices` names the vertex {beyond}, and there are {vertices}, from 0 on");
        return Err(entity.spot_of("indices").error(message));
    }
    Ok(list.iter().map(|index| *index as u32).collect())
}

/// Reads a mesh. The error is that of the file.
fn read(files: &Files, path: &Path) -> Result<ReadMesh, SceneError> {
    let file = ply::load(files, path)?;
    let mut mesh = Mesh::default();
    file.parts.into_iter().for_each(|part| mesh.append(part.mesh));
    Ok(ReadMesh { mesh, mends: file.substitutes.into_iter().map(|(_, mend)| mend).collect() })
}
