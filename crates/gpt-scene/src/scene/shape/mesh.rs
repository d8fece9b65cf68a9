//! Meshes, and what is done to one before it is rendered: faces without area go, normals are made where none are given.

use std::collections::HashMap;

use glam::{DVec3, Vec2, Vec3};

use crate::scene::material::MaterialId;

/// Triangles with shared vertices. Front faces are counter-clockwise.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    pub positions: Vec<Vec3>,
    /// One per position, or empty.
    pub normals: Vec<Vec3>,
    /// One per position, or empty.
    pub uvs: Vec<Vec2>,
    /// The coordinates of textures that use the second ones: one per position, or empty, where `uvs` serve
    /// them too.
    pub second_uvs: Vec<Vec2>,
    pub faces: Vec<[u32; 3]>,
    /// One material per face, or empty: then the shape's material is that of every face.
    pub face_materials: Vec<MaterialId>,
    /// Interpolate normals over the faces (needs `normals`); false: flat facets.
    pub smooth: bool,
}

impl Mesh {
    /// Removes faces that have no area, with repeated corners or corners on one line, and says how many. Such faces have no normal
    /// and no ray meets them.
    pub fn drop_degenerate_faces(&mut self) -> usize {
        let keep: Vec<bool> = self.faces.iter().map(|&face| self.face_normal(face).is_some()).collect();
        let dropped = keep.iter().filter(|&&keep| !keep).count();
        if dropped > 0 {
            retain_marked(&mut self.faces, &keep);
            retain_marked(&mut self.face_materials, &keep);
        }
        dropped
    }

    /// Unit normal on the counter-clockwise side; None for a face without area.
    pub fn face_normal(&self, face: [u32; 3]) -> Option<DVec3> {
        let [a, b, c] = face.map(|index| self.positions[index as usize].as_dvec3());
        let (u, v) = (b - a, c - a);
        let normal = u.cross(v);
        let longest = u.length_squared().max(v.length_squared()).max((c - b).length_squared());
        // In double precision the product of two single-precision edges is exact but for its last bits.
        (normal.length() > 1e-14 * longest).then(|| normal.try_normalize()).flatten()
    }

    /// Gives every vertex the mean of its faces' normals, each weighted by the face's angle there (Thürmer and Wüthrich 1998). Corners
    /// at the same position count as one vertex, so that seams of uv coordinates do not show.
    pub fn compute_smooth_normals(&mut self) {
        let mut sums: HashMap<[u32; 3], DVec3> = HashMap::with_capacity(self.positions.len());
        for &face in &self.faces {
            let Some(normal) = self.face_normal(face) else { continue };
            let corners = face.map(|index| self.positions[index as usize]);
            for corner in 0..3 {
                let at = corners[corner].as_dvec3();
                let next = corners[(corner + 1) % 3].as_dvec3() - at;
                let previous = corners[(corner + 2) % 3].as_dvec3() - at;
                *sums.entry(bits(corners[corner])).or_default() += next.angle_between(previous) * normal;
            }
        }
        let normal = |position: &Vec3| sums.get(&bits(*position)).and_then(|sum| sum.try_normalize()).unwrap_or(DVec3::Y);
        self.normals = self.positions.iter().map(|position| normal(position).as_vec3()).collect();
    }

    /// Gives every face corners of its own, with the face's normal: interpolating these shows flat facets.
    pub fn compute_flat_normals(&mut self) {
        let old = std::mem::take(self);
        self.smooth = old.smooth;
        self.face_materials.clone_from(&old.face_materials);
        for &face in &old.faces {
            let normal = old.face_normal(face).unwrap_or(DVec3::Y).as_vec3();
            let first = self.positions.len() as u32;
            for index in face.map(|index| index as usize) {
                self.positions.push(old.positions[index]);
                self.normals.push(normal);
                self.uvs.extend(old.uvs.get(index));
                self.second_uvs.extend(old.second_uvs.get(index));
            }
            self.faces.push([first, first + 1, first + 2]);
        }
    }

    /// Appends another mesh's vertices and faces. A side without uvs gets (0, 0) where the other has them; normals must be had by
    /// both or neither.
    pub fn append(&mut self, other: Mesh) {
        let offset = self.positions.len() as u32;
        for (own, others) in [(&mut self.uvs, &other.uvs), (&mut self.second_uvs, &other.second_uvs)] {
            if !own.is_empty() || !others.is_empty() {
                own.resize(self.positions.len(), Vec2::ZERO);
                own.extend(others);
                own.resize(self.positions.len() + other.positions.len(), Vec2::ZERO);
            }
        }
        self.positions.extend(other.positions);
        self.normals.extend(other.normals);
        self.faces.extend(other.faces.into_iter().map(|face| face.map(|index| index + offset)));
        self.face_materials.extend(other.face_materials);
    }
}

fn bits(position: Vec3) -> [u32; 3] {
    // Adding zero turns -0 into 0, which is the same place.
    position.to_array().map(|coordinate| (coordinate + 0.0).to_bits())
}

fn retain_marked<T>(items: &mut Vec<T>, keep: &[bool]) {
    let mut marks = keep.iter();
    items.retain(|_| *marks.next().unwrap_or(&true));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> Mesh {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        Mesh { positions, faces: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], ..Mesh::default() }
    }

    #[test]
    fn faces_without_area_go_and_take_their_material_along() {
        let mut mesh = tetrahedron();
        mesh.positions.push(Vec3::new(2.0, 0.0, 0.0));
        mesh.faces.insert(1, [0, 1, 4]);
        mesh.faces.push([2, 2, 3]);
        mesh.face_materials = vec![10, 11, 12, 13, 14, 15];
        assert_eq!(mesh.drop_degenerate_faces(), 2);
        assert_eq!(mesh.faces.len(), 4);
        assert_eq!(mesh.face_materials, [10, 12, 13, 14]);
    }

    #[test]
    fn smooth_normals_weigh_by_angle_and_join_seams() {
        let mut mesh = tetrahedron();
        // The corner of three right angles looks along the diagonal, outward.
        mesh.compute_smooth_normals();
        assert!(mesh.normals[0].abs_diff_eq(Vec3::splat(-1.0).normalize(), 1e-6));
        // The second mesh has vertices of its own for every face.
        let joined = mesh.normals[1];
        mesh.compute_flat_normals();
        mesh.compute_smooth_normals();
        let split = mesh.positions.iter().position(|&position| position == Vec3::X).map(|index| mesh.normals[index]);
        assert!(split.unwrap_or_default().abs_diff_eq(joined, 1e-6));
    }
}
