//! Which flat lights are drawn from by solid angle, not by area. `reference::intersect::seen` says how.

use glam::DVec3;

/// Least solid angle, in steradians, of rectangles that are drawn from by it. Single precision finds smaller ones as a difference of
/// angles that leaves too few digits, and over them a point drawn by area has nearly the same density.
pub const LEAST_SOLID_ANGLE: f64 = 0.06;
/// Least distance of the point from the plane, as a share of the farthest side's: below, all angles are next to 0 or to π.
pub const LEAST_DISTANCE: f64 = 0.01;
/// Least solid angle, in steradians, of triangles that are drawn from by it. Single precision finds any as well, down to 10⁻¹⁵ and less; below this
/// one, the density of a point drawn by area is the same to a few thousandths.
pub const LEAST_TRIANGLE_SOLID_ANGLE: f64 = 1e-6;
/// Least volume of the parallelepiped of a triangle's edges and the way to its first corner, as a share of that of a box with sides as long
/// as the edges and as the way to the farthest corner: below, the point is in the triangle's plane, or the triangle narrow. There the largest error of a
/// solid angle in single precision is 5·10⁻⁵, and it grows as the share falls.
pub const LEAST_TRIANGLE_SHARE: f64 = 0.003;
/// Largest cosine between edges that are perpendicular but for rounding.
const PERPENDICULAR: f64 = 1e-6;

/// Says that a parallelogram of these edges is a rectangle.
pub fn is_rectangle(edge_u: DVec3, edge_v: DVec3) -> bool {
    edge_u.dot(edge_v).abs() <= PERPENDICULAR * edge_u.length() * edge_v.length()
}
