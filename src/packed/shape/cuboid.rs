//! Boxes.

use glam::DVec3;

use super::placement::Placement;
use super::rectangle::Quad;
use crate::packed::attributes::TriangleAttributes;
use crate::scene::Cuboid;

pub fn add(shape: &Cuboid, placement: &Placement<'_>, push: &mut dyn FnMut(Quad, Option<TriangleAttributes>, usize)) {
    for (index, face) in faces(shape).into_iter().enumerate() {
        let [_, edge_u, edge_v] = face;
        if edge_u.cross(edge_v) != DVec3::ZERO {
            let (quad, attributes) = Quad::placed(face, placement);
            push(quad, attributes, index);
        }
    }
}

/// Corner and edges of the faces −x, +x, −y, +y, −z, +z, with edge_u × edge_v outward.
fn faces(shape: &Cuboid) -> [[DVec3; 3]; 6] {
    let extent = shape.max - shape.min;
    let axis = |a: usize| DVec3::AXES[a % 3] * extent[a % 3];
    [0, 1, 2, 3, 4, 5].map(|face| {
        let a = face / 2;
        if face % 2 == 0 { [shape.min, axis(a + 2), axis(a + 1)] } else { [shape.min + axis(a), axis(a + 1), axis(a + 2)] }
    })
}
