//! Meshes that enclose a volume.

use std::collections::HashMap;

use super::mesh::Mesh;

impl Mesh {
    /// The mesh encloses a volume, and its fronts face that.
    pub fn looks_inward(&self) -> bool {
        let volume = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|corner| self.positions[corner as usize].as_dvec3());
            a.dot(b.cross(c))
        };
        // Most meshes look outward: their edges need not be looked at.
        self.faces.iter().map(volume).sum::<f64>() < 0.0 && self.is_closed()
    }

    /// Every edge has as many faces on the one side as on the other. Vertices at the same place are one.
    pub fn is_closed(&self) -> bool {
        let mut points: HashMap<[u32; 3], u32> = HashMap::new();
        let point: Vec<u32> = self
            .positions
            .iter()
            .map(|position| {
                let next = points.len() as u32;
                // 0 and −0 are one.
                *points.entry(position.to_array().map(|number| (number + 0.0).to_bits())).or_insert(next)
            })
            .collect();
        let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
        for face in &self.faces {
            for corner in 0..3 {
                let [from, to] = [face[corner], face[(corner + 1) % 3]].map(|vertex| point[vertex as usize]);
                *edges.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
            }
        }
        !edges.is_empty() && edges.values().all(|count| *count == 0)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::Mesh;

    #[test]
    fn closed_surfaces_that_look_inward_are_reported() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let mut mesh = Mesh { positions, faces: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], ..Mesh::default() };
        assert!(mesh.is_closed() && !mesh.looks_inward());
        mesh.faces.iter_mut().for_each(|face| face.swap(1, 2));
        assert!(mesh.looks_inward());
        // Wherever it stands.
        mesh.positions.iter_mut().for_each(|position| *position += Vec3::splat(40.0));
        assert!(mesh.looks_inward());
        mesh.faces.pop();
        assert!(!mesh.looks_inward());
    }
}
