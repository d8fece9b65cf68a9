//! Which flat lights are drawn from by solid angle, not by area. `reference::intersect::shape::seen_rectangle` says how.

use glam::DVec3;

/// Least solid angle, in steradians, of rectangles that are drawn from by it. Single precision finds smaller ones as a difference of
/// angles that leaves too few digits, and over them a point drawn by area has nearly the same density.
pub const LEAST_SOLID_ANGLE: f64 = 0.06;
/// Least distance of the point from the plane, as a share of the farthest side's: below, all angles are next to 0 or to π.
pub const LEAST_DISTANCE: f64 = 0.01;
/// Largest cosine between edges that are perpendicular but for rounding.
const PERPENDICULAR: f64 = 1e-6;

/// Whether a parallelogram of these edges is a rectangle.
pub fn is_rectangle(edge_u: DVec3, edge_v: DVec3) -> bool {
    edge_u.dot(edge_v).abs() <= PERPENDICULAR * edge_u.length() * edge_v.length()
}
