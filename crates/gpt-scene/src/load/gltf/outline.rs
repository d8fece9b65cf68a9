//! Outlines as inverted hulls: a copy of a model, a little larger and turned inside out, of which viewers draw the far side alone because they
//! leave out what is seen from behind.
//!
//! Rays of light that leave the model would end on the hull's inside. So what is closed and looks inward, around which the camera stands, is
//! there for the camera alone. A room that the camera stands in looks the same but for that, and is a room.

use glam::{DAffine3, DVec3};

use super::importer::Importer;
use crate::scene::Mesh;

impl Importer<'_> {
    /// The mesh is an outline wherever it stands.
    pub fn is_outline(&self, mesh: usize, material: Option<usize>, built: &Mesh) -> bool {
        let is_one_sided =
            material.and_then(|index| self.root.materials.get(index)).is_none_or(|material| !material.double_sided);
        if !is_one_sided || !built.looks_inward() {
            return false;
        }
        let Some(camera) = self.clipping.map(|clipping| clipping.position) else { return true };
        let places = self.places.get(&mesh).map_or(&[][..], Vec::as_slice);
        !places.iter().any(|map| is_within_box(camera, built, map))
    }
}

fn is_within_box(point: DVec3, mesh: &Mesh, map: &DAffine3) -> bool {
    let placed = || mesh.positions.iter().map(|position| map.transform_point3(position.as_dvec3()));
    let (low, high) = (placed().fold(DVec3::INFINITY, DVec3::min), placed().fold(DVec3::NEG_INFINITY, DVec3::max));
    point.cmpge(low).all() && point.cmple(high).all()
}
