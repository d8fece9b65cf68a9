//! Infinite planes.

use glam::{DAffine3, DVec3};

use super::model::{Extent, ShapeModel, possible};
use crate::scene::check::{Check, is_direction};

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    pub point: DVec3,
    pub normal: DVec3,
}

impl ShapeModel for Plane {
    fn check(&self) -> Check {
        possible(self.point.is_finite() && is_direction(self.normal))
    }

    fn lacks_uv(&self) -> Option<&'static str> {
        Some("a plane has none; use a large rectangle")
    }

    fn farthest_from(&self, map: &DAffine3, point: DVec3) -> f64 {
        let normal = (map.matrix3.inverse().transpose() * self.normal).normalize();
        (point - map.transform_point3(self.point)).dot(normal).abs()
    }

    fn extent(&self, _map: &DAffine3) -> Option<Extent> {
        None
    }

    fn is_infinite(&self) -> bool {
        true
    }
}
