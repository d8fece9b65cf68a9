//! Flat disks.

use glam::{DAffine3, DVec3};

use super::model::{Extent, ShapeModel, farthest_corner, possible};
use crate::scene::check::{Check, is_direction, is_positive};

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disk {
    pub center: DVec3,
    pub normal: DVec3,
    pub radius: f64,
}

impl ShapeModel for Disk {
    fn check(&self) -> Check {
        possible(self.center.is_finite() && is_direction(self.normal) && is_positive(self.radius))
    }

    fn lacks_uv(&self) -> Option<&'static str> {
        Some("a disk has none; use a mesh with uvs, or a rectangle")
    }

    fn farthest_from(&self, map: &DAffine3, point: DVec3) -> f64 {
        farthest_corner(self.center - self.radius, self.center + self.radius, map, point)
    }

    fn extent(&self, map: &DAffine3) -> Option<Extent> {
        let across = self.normal.normalize_or(DVec3::Y).any_orthonormal_vector() * self.radius;
        Some(Extent::Across(2.0 * map.transform_vector3(across).length()))
    }

    fn is_round(&self) -> bool {
        true
    }
}
