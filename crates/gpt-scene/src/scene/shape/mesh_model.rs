//! Meshes as shapes.

use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec3};

use super::mesh::Mesh;
use super::model::{Enclosure, Extent, ShapeModel, around_points, farthest_corner};
use super::tessellation::Tessellated;
use crate::scene::check::Check;
use crate::scene::material::MaterialId;

impl ShapeModel for Arc<Mesh> {
    /// Every list is as long as the others need it.
    fn check(&self) -> Check {
        let vertices = self.positions.len();
        if self.faces.iter().flatten().any(|&vertex| vertex as usize >= vertices) {
            return Err(format!("a face names a vertex beyond the last, {}", vertices.saturating_sub(1)));
        }
        let fits = |length: usize, needed: usize| length == 0 || length == needed;
        let coordinates = [&self.uvs, &self.second_uvs];
        if !fits(self.normals.len(), vertices) || coordinates.iter().any(|uvs| !fits(uvs.len(), vertices)) {
            return Err("normals and uvs must be as many as positions".into());
        }
        if !fits(self.face_materials.len(), self.faces.len()) {
            return Err("face materials must be as many as faces".into());
        }
        if !self.positions.iter().copied().all(Vec3::is_finite) {
            return Err("positions must be finite".into());
        }
        Ok(())
    }

    fn lacks_uv(&self) -> Option<&'static str> {
        self.uvs.is_empty().then_some("the mesh has none")
    }

    fn farthest_from(&self, map: &DAffine3, point: DVec3) -> f64 {
        let low = self.positions.iter().copied().reduce(Vec3::min).unwrap_or_default();
        let high = self.positions.iter().copied().reduce(Vec3::max).unwrap_or_default();
        farthest_corner(low.as_dvec3(), high.as_dvec3(), map, point)
    }

    fn bounds(&self, map: &DAffine3) -> Option<[DVec3; 2]> {
        around_points(self.positions.iter().map(|position| position.as_dvec3()), map)
    }

    fn enclosure(&self) -> Enclosure {
        match (self.is_closed(), self.looks_inward()) {
            (false, _) => Enclosure::None,
            (true, false) => Enclosure::Body,
            (true, true) => Enclosure::Surroundings,
        }
    }

    fn tessellated(&self) -> Tessellated {
        Tessellated { mesh: self.clone(), deviation: 0.0 }
    }

    fn extent(&self, map: &DAffine3) -> Option<Extent> {
        let placed = self.positions.iter().map(|position| map.transform_point3(position.as_dvec3()));
        let (low, high) = placed.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
        (!self.positions.is_empty()).then(|| Extent::Across((high - low).max_element()))
    }

    fn faces(&self) -> usize {
        self.faces.len()
    }

    fn face_materials(&self) -> &[MaterialId] {
        &self.face_materials
    }
}
