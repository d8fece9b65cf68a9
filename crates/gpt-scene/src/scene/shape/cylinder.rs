//! Cylinders: open tubes.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DVec3};

use super::model::{Enclosure, Extent, ShapeModel, around_box, possible};
use super::tessellation::{SEGMENTS, Tessellated, facing_normals, of_rows};
use crate::scene::check::{Check, is_positive};

/// The wall of a tube between two points, without caps; normal outward. v grows from 0 at `from` to 1 at `to`, and u about the axis: in turns
/// counter-clockwise seen from `from`, beginning at [`Cylinder::first_direction`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cylinder {
    pub from: DVec3,
    pub to: DVec3,
    pub radius: f64,
}

impl Cylinder {
    /// The direction from the axis to where u is 0, of length 1: as near to −z as it can be, or to +x where the axis runs along z.
    pub fn first_direction(&self) -> DVec3 {
        let axis = (self.to - self.from).normalize();
        let wanted = if axis.z.abs() > 0.9 { DVec3::X } else { DVec3::NEG_Z };
        (wanted - axis * axis.dot(wanted)).normalize()
    }
}

impl ShapeModel for Cylinder {
    fn check(&self) -> Check {
        let length = (self.to - self.from).length();
        possible(self.from.is_finite() && self.to.is_finite() && is_positive(length) && is_positive(self.radius))
    }

    fn farthest_from(&self, map: &DAffine3, point: DVec3) -> f64 {
        let [from, to] = [self.from, self.to].map(|end| map.transform_point3(end).distance(point));
        let radius = self.radius * map.matrix3.determinant().abs().cbrt();
        (from.max(to).powi(2) + radius.powi(2)).sqrt() + radius
    }

    fn bounds(&self, map: &DAffine3) -> Option<[DVec3; 2]> {
        around_box(self.from.min(self.to) - self.radius, self.from.max(self.to) + self.radius, map)
    }

    fn enclosure(&self) -> Enclosure {
        Enclosure::None
    }

    fn tessellated(&self) -> Tessellated {
        let axis = self.to - self.from;
        let first = self.first_direction();
        let second = first.cross(axis.normalize_or(DVec3::Y));
        let mesh = of_rows(SEGMENTS, 1, |u, v| {
            let (sine, cosine) = (TAU * u).sin_cos();
            let normal = first * cosine + second * sine;
            [self.from + axis * v + self.radius * normal, normal]
        });
        let deviation = self.radius * (1.0 - (PI / f64::from(SEGMENTS)).cos());
        Tessellated { mesh: facing_normals(mesh).into(), deviation }
    }

    fn extent(&self, map: &DAffine3) -> Option<Extent> {
        let length = map.transform_vector3(self.to - self.from).length();
        let width = 2.0 * map.transform_vector3(self.first_direction() * self.radius).length();
        Some(Extent::Across(length.hypot(width)))
    }

    fn is_round(&self) -> bool {
        true
    }
}
