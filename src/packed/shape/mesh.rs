//! Meshes, and the triangles that they are made of.

use glam::{DAffine3, DVec3, Vec2, Vec3};

use super::element::Element;
use super::placement::Placement;
use crate::math::outward;
use crate::packed::attributes::TriangleAttributes;
use crate::scene::Mesh;

pub fn add(mesh: &Mesh, placement: &Placement<'_>, push: &mut dyn FnMut(Triangle, Option<TriangleAttributes>, usize)) {
    let positions = placement.shape.world_positions();
    let normals = if mesh.smooth && !mesh.normals.is_empty() { placement.shape.world_normals() } else { Vec::new() };
    for (index, face) in placement.shape.world_faces().into_iter().enumerate() {
        let corners = face.map(|corner| corner as usize);
        // Without coordinates they are all 0, which says that they grow in no direction.
        let textured = placement.is_textured(index);
        let attributes = (!normals.is_empty() || textured).then(|| {
            let corner_normals = if normals.is_empty() { [Vec3::ZERO; 3] } else { corners.map(|c| normals[c]) };
            let corner_uvs = if mesh.uvs.is_empty() { [Vec2::ZERO; 3] } else { corners.map(|c| mesh.uvs[c]) };
            TriangleAttributes::new(corner_normals, corner_uvs)
        });
        push(Triangle(corners.map(|c| positions[c])), attributes, index);
    }
}

/// Three vertices, already f32: those shared between triangles must round alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle(pub [Vec3; 3]);

impl Element for Triangle {
    fn moved(&self, map: &DAffine3) -> Self {
        Self(self.0.map(|corner| map.transform_point3(corner.as_dvec3()).as_vec3()))
    }

    fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.extent().map(|[low, high]| outward(low, high))
    }

    fn extent(&self) -> Option<[DVec3; 2]> {
        let [a, b, c] = self.0;
        Some([a.min(b).min(c).as_dvec3(), a.max(b).max(c).as_dvec3()])
    }

    fn area(&self) -> f64 {
        let [a, b, c] = self.0.map(|corner| corner.as_dvec3());
        0.5 * (b - a).cross(c - a).length()
    }

    /// The vertices.
    fn points(&self) -> [Vec3; 3] {
        self.0
    }

    /// A vertex and the edges from it.
    fn light(&self) -> Option<(f64, [DVec3; 3])> {
        let [a, b, c] = self.0.map(|corner| corner.as_dvec3());
        Some((self.area(), [a, b - a, c - a]))
    }
}
