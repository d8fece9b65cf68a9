//! Meshes, of triangles.

use std::sync::Arc;

use super::placement::Placement;
use super::primitive::Primitive;
use super::triangle::Triangle;
use crate::scene::Mesh;

pub fn elements(_: &Arc<Mesh>, placement: &Placement<'_>) -> Vec<(usize, Primitive)> {
    let positions = placement.shape.world_positions();
    let triangle = |face: [u32; 3]| Primitive::Triangle(Triangle { corners: face.map(|corner| positions[corner as usize]) });
    placement.shape.world_faces().into_iter().map(triangle).enumerate().collect()
}
