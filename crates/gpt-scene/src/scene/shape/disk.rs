//! Flat disks.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DVec3};

use super::mesh::Mesh;
use super::model::{Enclosure, Extent, ShapeModel, around_box, farthest_corner, possible};
use super::tessellation::{SEGMENTS, Tessellated};
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

    fn bounds(&self, map: &DAffine3) -> Option<[DVec3; 2]> {
        around_box(self.center - self.radius, self.center + self.radius, map)
    }

    fn enclosure(&self) -> Enclosure {
        Enclosure::None
    }

    fn tessellated(&self) -> Tessellated {
        let (across, beside) = self.normal.normalize_or(DVec3::Z).any_orthonormal_pair();
        let rim = |index: u32| {
            let (sine, cosine) = (TAU * f64::from(index) / f64::from(SEGMENTS)).sin_cos();
            (self.center + self.radius * (across * cosine + beside * sine)).as_vec3()
        };
        let mesh = Mesh {
            positions: std::iter::once(self.center.as_vec3()).chain((0..SEGMENTS).map(rim)).collect(),
            faces: (0..SEGMENTS).map(|index| [0, 1 + index, 1 + (index + 1) % SEGMENTS]).collect(),
            ..Mesh::default()
        };
        let deviation = self.radius * (1.0 - (PI / f64::from(SEGMENTS)).cos());
        Tessellated { mesh: mesh.into(), deviation }
    }

    fn extent(&self, map: &DAffine3) -> Option<Extent> {
        let across = self.normal.normalize_or(DVec3::Y).any_orthonormal_vector() * self.radius;
        Some(Extent::Across(2.0 * map.transform_vector3(across).length()))
    }

    fn is_round(&self) -> bool {
        true
    }
}
