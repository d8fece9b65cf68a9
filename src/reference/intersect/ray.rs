//! Rays, and points of surfaces that rays leave from.

use glam::{DVec2, DVec3};

/// A half-line; `direction` has unit length, but for rays taken to the rest space of a moving shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    pub origin: DVec3,
    pub direction: DVec3,
}

impl Ray {
    #[inline]
    pub fn at(&self, distance: f64) -> DVec3 {
        self.origin + self.direction * distance
    }

    /// Distance to the plane through `point`, in (0, limit).
    #[inline]
    pub fn distance_to_plane(&self, point: DVec3, normal: DVec3, limit: f64) -> Option<f64> {
        let distance = (point - self.origin).dot(normal) / self.direction.dot(normal);
        // A ray in the plane gives 0/0 or an infinity, which fails the comparisons.
        (distance > 0.0 && distance < limit).then_some(distance)
    }
}

/// A point's place on a primitive, in the primitive's own coordinates: along the two edges of a parallelogram, the weights of the
/// second and third vertex of a triangle, unused elsewhere.
pub type Local = DVec2;

/// A computed point of a surface lies within `size * ROUNDING` of the surface, and is seen to do so by every intersection test.
///
/// Every chain of operations from a surface's own numbers to the point, and from the point back to the sign of a distance, is
/// shorter than 32 roundings of 2⁻⁵³ relative to the largest magnitude involved. The bound takes 2¹⁰ of them, so that normals of
/// slivers and directions that graze are covered as well; it is still 10⁷ times below what a device's f32 can resolve.
const ROUNDING: f64 = 1024.0 * 0.5 * f64::EPSILON;

/// A point of a surface together with what is needed to leave the surface safely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    pub position: DVec3,
    /// Geometric normal on the front side, unit length.
    pub normal: DVec3,
    /// Bound on the distance between `position` and the surface, from rounding.
    pub error: f64,
}

impl SurfacePoint {
    /// `magnitude` is at least as large as every coordinate that went into the position.
    pub fn new(position: DVec3, normal: DVec3, magnitude: f64) -> Self {
        Self { position, normal, error: magnitude * ROUNDING }
    }

    /// The magnitude that it was made with.
    pub fn magnitude(&self) -> f64 {
        self.error / ROUNDING
    }

    /// The geometric normal on the side that `direction` points to.
    pub fn normal_towards(&self, direction: DVec3) -> DVec3 {
        self.normal * 1.0_f64.copysign(direction.dot(self.normal))
    }

    /// The point moved off the surface by its error bound, to the side that `direction` points to. A ray from there in that
    /// direction does not meet the surface again by rounding.
    pub fn leave_towards(&self, direction: DVec3) -> DVec3 {
        self.position + self.normal * self.error.copysign(direction.dot(self.normal))
    }
}
