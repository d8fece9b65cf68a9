//! Boxes.

use glam::DVec3;

use super::placement::Placement;
use super::primitive::Primitive;
use super::rectangle::Quad;
use crate::scene::Cuboid;

pub fn elements(shape: &Cuboid, placement: &Placement<'_>) -> Vec<(usize, Primitive)> {
    let quad = |(part, face)| Quad::placed(face, placement).map(|quad| (part, Primitive::of(quad)));
    faces(shape).into_iter().enumerate().filter_map(quad).collect()
}

/// Corner and edges of the faces −x +x −y +y −z +z, normals (first edge × second edge) outward.
fn faces(shape: &Cuboid) -> [[DVec3; 3]; 6] {
    let extent = shape.max - shape.min;
    std::array::from_fn(|face| {
        let axis = face / 2;
        let edge = |axis: usize| DVec3::AXES[axis % 3] * extent[axis % 3];
        let (u, v) = (edge(axis + 1), edge(axis + 2));
        if face % 2 == 0 { [shape.min, v, u] } else { [shape.min + edge(axis), u, v] }
    })
}
