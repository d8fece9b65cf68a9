//! Infinite planes.

use glam::DVec3;

use super::placement::Placement;
use super::primitive::Primitive;
use crate::reference::intersect::element::Element;
use crate::reference::intersect::hierarchy::PreparedRay;
use crate::reference::intersect::ray::{Local, Ray, SurfacePoint};
use crate::scene;

pub fn elements(shape: &scene::Plane, placement: &Placement<'_>) -> Vec<(usize, Primitive)> {
    let point = placement.to_world.transform_point3(shape.point);
    vec![(0, Primitive::of(Plane { point, normal: placement.normal(shape.normal) }))]
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    point: DVec3,
    normal: DVec3,
}

impl Element for Plane {
    fn intersect(&self, ray: &PreparedRay, limit: f64) -> Option<(f64, Local)> {
        ray.ray.distance_to_plane(self.point, self.normal, limit).map(|distance| (distance, Local::ZERO))
    }

    /// The ray's point projected onto the plane.
    fn point(&self, ray: &Ray, distance: f64, _: Local) -> SurfacePoint {
        let near = ray.at(distance);
        let position = near - self.normal * (near - self.point).dot(self.normal);
        SurfacePoint::new(position, self.normal, self.point.abs().max(near.abs()).max_element())
    }

    fn area(&self) -> f64 {
        f64::INFINITY
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        None
    }
}
