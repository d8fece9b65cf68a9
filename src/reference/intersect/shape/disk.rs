//! Disks.

use std::f64::consts::PI;

use glam::DVec3;

use super::placement::Placement;
use super::primitive::Primitive;
use crate::math::Frame;
use crate::reference::intersect::element::Element;
use crate::reference::intersect::hierarchy::PreparedRay;
use crate::reference::intersect::ray::{Local, Ray, SurfacePoint};
use crate::reference::warp;
use crate::scene;

pub fn elements(shape: &scene::Disk, placement: &Placement<'_>) -> Vec<(usize, Primitive)> {
    let frame = Frame::around(placement.normal(shape.normal));
    let center = placement.to_world.transform_point3(shape.center);
    vec![(0, Primitive::of(Disk { center, radius: shape.radius * placement.scale, frame }))]
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disk {
    center: DVec3,
    radius: f64,
    frame: Frame,
}

impl Element for Disk {
    fn intersect(&self, ray: &PreparedRay, limit: f64) -> Option<(f64, Local)> {
        let ray = &ray.ray;
        ray.distance_to_plane(self.center, self.frame.normal, limit)
            .filter(|&distance| (ray.at(distance) - self.center).length_squared() <= self.radius * self.radius)
            .map(|distance| (distance, Local::ZERO))
    }

    fn point(&self, ray: &Ray, distance: f64, _: Local) -> SurfacePoint {
        self.under(ray.at(distance))
    }

    fn area(&self) -> f64 {
        PI * self.radius * self.radius
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        // A disk reaches r·√(1 − n²) along an axis whose cosine with the normal is n (Quilez).
        let n = self.frame.normal;
        let reach = self.radius * (DVec3::ONE - n * n).max(DVec3::ZERO).map(f64::sqrt);
        Some([self.center - reach, self.center + reach])
    }

    fn sample_area(&self, u1: f64, u2: f64) -> Option<(SurfacePoint, Local)> {
        let p = warp::disk(self.radius, u1, u2);
        Some((self.under(self.center + self.frame.to_world(DVec3::new(p.x, p.y, 0.0))), Local::ZERO))
    }
}

impl Disk {
    /// `near` projected onto the disk's plane.
    fn under(&self, near: DVec3) -> SurfacePoint {
        let normal = self.frame.normal;
        let position = near - normal * (near - self.center).dot(normal);
        SurfacePoint::new(position, normal, self.center.abs().max_element() + self.radius)
    }
}
