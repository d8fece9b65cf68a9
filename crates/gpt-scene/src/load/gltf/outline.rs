//! Outlines as inverted hulls: a copy of a model, a little larger and turned inside out, of which viewers draw the far side alone because they
//! leave out what is seen from behind.
//!
//! Rays of light that leave the model would end on the hull's inside. So what is closed and looks inward, around which the camera stands, is
//! there for the camera alone. A room that the camera stands in looks the same but for that, and is a room.

use std::collections::HashMap;

use glam::{DAffine3, DVec3};

use super::importer::Importer;
use crate::scene::Mesh;

impl Importer<'_> {
    /// The mesh is an outline wherever it stands.
    pub fn is_outline(&self, mesh: usize, material: Option<usize>, built: &Mesh) -> bool {
        let is_one_sided =
            material.and_then(|index| self.root.materials.get(index)).is_none_or(|material| !material.double_sided);
        if !is_one_sided || !looks_inward(built) {
            return false;
        }
        let Some(camera) = self.clipping.map(|clipping| clipping.position) else { return true };
        let places = self.places.get(&mesh).map_or(&[][..], Vec::as_slice);
        !places.iter().any(|map| is_within_box(camera, built, map))
    }
}

/// The mesh encloses a volume, and its fronts face that.
fn looks_inward(mesh: &Mesh) -> bool {
    let volume = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|corner| mesh.positions[corner as usize].as_dvec3());
        a.dot(b.cross(c))
    };
    // Most meshes look outward: their edges need not be looked at.
    mesh.faces.iter().map(volume).sum::<f64>() < 0.0 && is_closed(mesh)
}

/// Every edge has as many faces on the one side as on the other. Vertices at the same place are one.
fn is_closed(mesh: &Mesh) -> bool {
    let mut points: HashMap<[u32; 3], u32> = HashMap::new();
    let point: Vec<u32> = mesh
        .positions
        .iter()
        .map(|position| {
            let next = points.len() as u32;
            // 0 and −0 are one.
            *points.entry(position.to_array().map(|number| (number + 0.0).to_bits())).or_insert(next)
        })
        .collect();
    let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
    for face in &mesh.faces {
        for corner in 0..3 {
            let [from, to] = [face[corner], face[(corner + 1) % 3]].map(|vertex| point[vertex as usize]);
            *edges.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
        }
    }
    !edges.is_empty() && edges.values().all(|count| *count == 0)
}

fn is_within_box(point: DVec3, mesh: &Mesh, map: &DAffine3) -> bool {
    let placed = || mesh.positions.iter().map(|position| map.transform_point3(position.as_dvec3()));
    let (low, high) = (placed().fold(DVec3::INFINITY, DVec3::min), placed().fold(DVec3::NEG_INFINITY, DVec3::max));
    point.cmpge(low).all() && point.cmple(high).all()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::import::unit_cube;

    #[test]
    fn closed_surfaces_that_look_inward_are_told() {
        let mut cube = unit_cube();
        assert!(is_closed(&cube) && !looks_inward(&cube));
        cube.faces.iter_mut().for_each(|face| face.swap(1, 2));
        assert!(looks_inward(&cube));
        // Wherever it stands.
        cube.positions.iter_mut().for_each(|position| *position += glam::Vec3::splat(40.0));
        assert!(looks_inward(&cube));
        cube.faces.pop();
        assert!(!looks_inward(&cube));
    }
}
