//! Spheres.

use glam::{DAffine3, DVec3};

use super::model::{Extent, ShapeModel, farthest_corner, possible};
use crate::scene::check::{Check, is_positive};

/// Normal outward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    pub center: DVec3,
    pub radius: f64,
}

impl ShapeModel for Sphere {
    fn check(&self) -> Check {
        possible(self.center.is_finite() && is_positive(self.radius))
    }

    fn farthest_from(&self, map: &DAffine3, point: DVec3) -> f64 {
        farthest_corner(self.center - self.radius, self.center + self.radius, map, point)
    }

    fn extent(&self, map: &DAffine3) -> Option<Extent> {
        Some(Extent::Across(2.0 * map.transform_vector3(DVec3::X * self.radius).length()))
    }

    fn is_round(&self) -> bool {
        true
    }
}
