//! Spheres.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DVec3};

use super::model::{Enclosure, Extent, ShapeModel, around_box, farthest_corner, possible};
use super::tessellation::{SEGMENTS, Tessellated, facing_normals, of_rows};
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

    fn bounds(&self, map: &DAffine3) -> Option<[DVec3; 2]> {
        around_box(self.center - self.radius, self.center + self.radius, map)
    }

    fn enclosure(&self) -> Enclosure {
        Enclosure::Body
    }

    /// Rows follow the texture coordinates: u about +Y from −Z over +X, v from the lowest to the highest point.
    fn tessellated(&self) -> Tessellated {
        let direction = |u: f64, v: f64| {
            let ((sine, cosine), (x, minus_z)) = ((PI * v).sin_cos(), (TAU * u).sin_cos());
            DVec3::new(sine * x, -cosine, -sine * minus_z)
        };
        // Seen from outside, u runs to the left: rows are walked the other way.
        let mesh = of_rows(SEGMENTS, SEGMENTS / 2, |u, v| {
            let normal = direction(u, v);
            [self.center + self.radius * normal, normal]
        });
        // The middle of a quad at the equator lies deepest, below both of its arcs.
        let deviation = self.radius * (1.0 - (PI / f64::from(SEGMENTS)).cos().powi(2));
        Tessellated { mesh: facing_normals(mesh).into(), deviation }
    }

    fn extent(&self, map: &DAffine3) -> Option<Extent> {
        Some(Extent::Across(2.0 * map.transform_vector3(DVec3::X * self.radius).length()))
    }

    fn is_round(&self) -> bool {
        true
    }
}
