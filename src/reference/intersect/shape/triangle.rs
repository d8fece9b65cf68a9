//! Triangles, watertight.

use glam::{DVec2, DVec3, Vec3};

use crate::reference::intersect::element::Element;
use crate::reference::intersect::hierarchy::PreparedRay;
use crate::reference::intersect::ray::{Local, Ray, SurfacePoint};
use crate::reference::intersect::seen::{Flat, Outline};
use crate::reference::warp;

/// Three corners, counter-clockwise seen from the front. They are stored as they are, in f32; all arithmetic is f64, where
/// differences and products of such numbers are all but exact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    pub corners: [Vec3; 3],
}

impl Element for Triangle {
    /// The watertight test of Woop, Benthin and Wald (2013): the triangle is sheared so that the ray becomes the z axis, and the
    /// origin's place is decided by the signs of three edge functions. Neighbours evaluate the function of a shared edge on the same
    /// numbers and get opposite signs, so no ray slips between them; a zero counts as inside for both.
    #[inline]
    fn intersect(&self, ray: &PreparedRay, limit: f64) -> Option<(f64, Local)> {
        let [a, b, c] = self.corners_f64();
        let [a, b, c] = [ray.shear(a), ray.shear(b), ray.shear(c)];
        let weight_a = c.x * b.y - c.y * b.x;
        let weight_b = a.x * c.y - a.y * c.x;
        let weight_c = b.x * a.y - b.y * a.x;
        let any_negative = weight_a < 0.0 || weight_b < 0.0 || weight_c < 0.0;
        let any_positive = weight_a > 0.0 || weight_b > 0.0 || weight_c > 0.0;
        let sum = weight_a + weight_b + weight_c;
        if (any_negative && any_positive) || sum == 0.0 {
            return None;
        }
        // The distance comes from the plane and not from the sheared corners: a point that was moved off the surface then lies on
        // its side for certain, however the ray grazes.
        let distance = ray.ray.distance_to_plane(self.corners[0].as_dvec3(), self.scaled_normal(), limit)?;
        Some((distance, DVec2::new(weight_b, weight_c) / sum))
    }

    #[inline]
    fn point(&self, _: &Ray, _: f64, local: Local) -> SurfacePoint {
        self.at(local)
    }

    fn area(&self) -> f64 {
        0.5 * self.scaled_normal().length()
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        Some(self.corner_bounds())
    }

    fn sample_area(&self, u1: f64, u2: f64) -> Option<(SurfacePoint, Local)> {
        let local = warp::triangle(u1, u2);
        Some((self.at(local), local))
    }

    fn flat(&self) -> Option<Flat> {
        let [a, b, c] = self.corners_f64();
        Some(Flat { outline: Outline::Triangle, corner: a, edges: [b - a, c - a] })
    }
}

impl Triangle {
    /// Lower and upper corner of the box around its corners.
    pub fn corner_bounds(&self) -> [DVec3; 2] {
        let [a, b, c] = self.corners;
        [a.min(b).min(c).as_dvec3(), a.max(b).max(c).as_dvec3()]
    }

    /// Written out: `map` of an array is a call for each corner where the optimiser sees little.
    #[inline]
    fn corners_f64(&self) -> [DVec3; 3] {
        let [a, b, c] = self.corners;
        [a.as_dvec3(), b.as_dvec3(), c.as_dvec3()]
    }

    #[inline]
    fn at(&self, local: Local) -> SurfacePoint {
        let [a, b, c] = self.corners_f64();
        let position = a + (b - a) * local.x + (c - a) * local.y;
        let magnitude = a.abs().max(b.abs()).max(c.abs()).max_element();
        // A degenerate triangle has no normal; none is ever hit.
        SurfacePoint::new(position, self.scaled_normal().normalize_or_zero(), magnitude)
    }

    /// The front normal, as long as twice the area.
    #[inline]
    fn scaled_normal(&self) -> DVec3 {
        let [a, b, c] = self.corners_f64();
        (b - a).cross(c - a)
    }
}
