//! Bilinear patches, of triangles.

use glam::{DVec3, Vec2};

use super::mesh::indices;
use super::{Geometry, Needs, face_normals};
use crate::load::error::SceneError;
use crate::load::pbrt::converter::Converter;
use crate::load::pbrt::world::ShapeRecord;
use crate::scene::Mesh;

/// Quads along each side of a patch that is no parallelogram.
const SIDES: u32 = 16;
/// How far a corner may be from where a parallelogram has it, of the patch's size.
const SAME: f64 = 1e-6;

impl Converter<'_> {
    pub(super) fn bilinear_mesh(&mut self, record: &ShapeRecord, needs: Needs) -> Result<Option<Geometry>, SceneError> {
        let entity = &record.entity;
        entity.without_effect(&["faceIndices"]);
        if entity.has("emissionfilename") {
            self.drop(
                entity.spot_of("emissionfilename"),
                "Shape `bilinearmesh`: `emissionfilename`",
                "it says how light is sampled",
            );
            entity.without_effect(&["emissionfilename"]);
        }
        let corners = self.vertices(entity)?;
        let count = corners.positions.len();
        let indices = indices(entity, count, if count == 4 { &[0, 1, 2, 3] } else { &[] })?;
        if !indices.len().is_multiple_of(4) {
            self.drop(entity.spot_of("indices"), "indices beyond the last whole patch", "they are left out");
        }
        let mut mesh = Mesh { smooth: true, ..Mesh::default() };
        let mut bent = 0;
        for patch in indices.chunks_exact(4) {
            let patch = Patch::of(&corners, [patch[0], patch[1], patch[2], patch[3]]);
            let sides = if patch.is_parallelogram() { 1 } else { SIDES };
            bent += usize::from(sides > 1);
            patch.append_to(&mut mesh, sides);
        }
        if bent > 0 {
            let instead = format!("{} triangles each, with interpolated normals", 2 * SIDES * SIDES);
            self.approximate(&entity.spot, "Shape `bilinearmesh` of patches that are no parallelograms", instead);
        }
        face_normals(&mut mesh);
        self.finish_mesh(record, needs, mesh)
    }
}

/// The corners of a patch at (0, 0), (1, 0), (0, 1) and (1, 1).
struct Patch {
    positions: [DVec3; 4],
    normals: Option<[DVec3; 4]>,
    uvs: [Vec2; 4],
}

impl Patch {
    fn of(mesh: &Mesh, corners: [u32; 4]) -> Self {
        let at = corners.map(|corner| corner as usize);
        let plain = [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE];
        Self {
            positions: at.map(|at| mesh.positions[at].as_dvec3()),
            normals: (!mesh.normals.is_empty()).then(|| at.map(|at| mesh.normals[at].as_dvec3())),
            uvs: if mesh.uvs.is_empty() { plain } else { at.map(|at| mesh.uvs[at]) },
        }
    }

    fn is_parallelogram(&self) -> bool {
        let [a, b, c, d] = self.positions;
        let [ua, ub, uc, ud] = self.uvs;
        let size = (b - a).length().max((c - a).length());
        (a + d - b - c).length() <= SAME * size && (ua + ud - ub - uc).length() <= SAME as f32
    }

    /// Adds the patch as so many quads along each side.
    fn append_to(&self, mesh: &mut Mesh, sides: u32) {
        let first = mesh.positions.len() as u32;
        for row in 0..=sides {
            for column in 0..=sides {
                let (u, v) = (f64::from(column) / f64::from(sides), f64::from(row) / f64::from(sides));
                let between = |corners: [DVec3; 4]| corners[0].lerp(corners[1], u).lerp(corners[2].lerp(corners[3], u), v);
                let [a, b, c, d] = self.positions;
                let across = (b - a).lerp(d - c, v).cross((c - a).lerp(d - b, u));
                let normal = self.normals.map_or(across, between).normalize_or(DVec3::Z);
                mesh.positions.push(between(self.positions).as_vec3());
                mesh.normals.push(normal.as_vec3());
                let [ua, ub, uc, ud] = self.uvs;
                let (u, v) = (u as f32, v as f32);
                mesh.uvs.push(ua.lerp(ub, u).lerp(uc.lerp(ud, u), v));
            }
        }
        let width = sides + 1;
        for row in 0..sides {
            for column in 0..sides {
                let a = first + row * width + column;
                mesh.faces.extend([[a, a + 1, a + width + 1], [a, a + width + 1, a + width]]);
            }
        }
    }
}
