//! Infinite planes.

use glam::{DAffine3, DVec3};

use super::model::{Enclosure, Extent, ShapeModel, possible};
use super::tessellation::{PLANE, Tessellated, of_quads};
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

    fn bounds(&self, _map: &DAffine3) -> Option<[DVec3; 2]> {
        None
    }

    fn enclosure(&self) -> Enclosure {
        Enclosure::Half
    }

    fn tessellated(&self) -> Tessellated {
        let (u, v) = self.normal.normalize_or(DVec3::Y).any_orthonormal_pair();
        Tessellated::exact(of_quads(&[[self.point - (u + v) * PLANE, 2.0 * PLANE * u, 2.0 * PLANE * v]], false))
    }

    fn extent(&self, _map: &DAffine3) -> Option<Extent> {
        None
    }

    fn is_infinite(&self) -> bool {
        true
    }
}
