//! Points around shapes, by which a camera is placed.

use glam::DVec3;

use crate::load::file::shape::ShapeEntry;
use crate::load::file::value::vector;

/// The corners of boxes around round shapes, and those of flat ones; none of what is infinite or a mesh. In the shape's own coordinates.
pub fn outline(shape: &ShapeEntry) -> Vec<DVec3> {
    let around = |center: DVec3, radius: f64| corners(&[center - radius, center + radius]);
    match shape {
        ShapeEntry::Sphere(keys) => around(vector(keys.center), keys.radius.0),
        ShapeEntry::Disk(keys) => around(vector(keys.center), keys.radius.0),
        ShapeEntry::Cylinder(keys) => {
            let ends = [keys.from, keys.to.value].map(vector);
            ends.into_iter().flat_map(|end| around(end, keys.radius.0)).collect()
        }
        ShapeEntry::Box(keys) => corners(&[vector(keys.min), vector(keys.max.value)]),
        ShapeEntry::Rectangle(keys) => {
            let [corner, u, v] = [keys.corner, keys.edge_u.value, keys.edge_v.value].map(vector);
            vec![corner, corner + u, corner + v, corner + u + v]
        }
        ShapeEntry::Plane(_) | ShapeEntry::Mesh(_) => Vec::new(),
    }
}

/// The corners of the box around points.
pub fn corners(points: &[DVec3]) -> Vec<DVec3> {
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let corner = |index: usize| DVec3::select(glam::BVec3::new(index & 1 != 0, index & 2 != 0, index & 4 != 0), high, low);
    (0..8).map(corner).collect()
}
