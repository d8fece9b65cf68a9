//! Triangles as they are seen from a point: directions uniform over their solid angle.
//!
//! A corner slides, as in Arvo 1995 and Peters 2021, along the last edge until the part up to there has the share of the solid angle that
//! is drawn, and a direction on the arc to the second corner is uniform in its cosine. Here all angles are tangents of their halves,
//! found from the edges and never as a difference of angles or of directions. So relative errors are those of the arithmetic, however
//! small the triangle is seen.

use glam::{DVec2, DVec3};

use crate::sampling::solid_angle::{LEAST_TRIANGLE_SHARE, LEAST_TRIANGLE_SOLID_ANGLE};

/// A triangle seen from a point. Its corners are the directions a, b and c; e is perpendicular to a, on the arc from a to c.
#[derive(Debug, Clone, Copy)]
pub struct SeenTriangle {
    to_corner: DVec3,
    edge_u: DVec3,
    edge_v: DVec3,
    /// Distances of a, b and c.
    distances: [f64; 3],
    /// Tangent of half the angle between a and c.
    tangent: f64,
    /// 1 + a·b.
    one_and_cosine: f64,
    /// |a·(b × e)|.
    sine: f64,
    /// b·e.
    cosine: f64,
    /// In steradians.
    pub solid_angle: f64,
}

impl SeenTriangle {
    /// The triangle of a corner and the edges that begin there. None where its points are better drawn by area.
    pub fn new(from: DVec3, corner: DVec3, edge_u: DVec3, edge_v: DVec3) -> Option<Self> {
        let to_corner = corner - from;
        let (to_b, to_c) = (to_corner + edge_u, to_corner + edge_v);
        let distances = [to_corner.length(), to_b.length(), to_c.length()];
        let farthest = distances.into_iter().fold(0.0, f64::max);
        let a = to_corner / distances[0];
        let height = a.dot(edge_u.cross(edge_v)).abs();
        // False as well where the point is the corner, and there is no height.
        let is_open = distances[0] * height > LEAST_TRIANGLE_SHARE * farthest * edge_u.length() * edge_v.length();
        if !is_open {
            return None;
        }
        let along_a = edge_v.dot(a);
        let across_a = edge_v - along_a * a;
        let across = across_a.length();
        let tangent = half_angle_tangent(across, distances[0] + along_a, distances[2]);
        let twice_middle = a + to_b / distances[1];
        let one_and_cosine = 0.5 * twice_middle.length_squared();
        let sine = height / (across * distances[1]);
        let cosine = edge_u.dot(across_a) / (across * distances[1]);
        // The tangent of half the solid angle (van Oosterom and Strackee 1983), both sides of the fraction over 1 + a·c.
        let solid_angle = 2.0 * (tangent * sine).atan2(one_and_cosine + tangent * cosine);
        let seen = Self { to_corner, edge_u, edge_v, distances, tangent, one_and_cosine, sine, cosine, solid_angle };
        (solid_angle >= LEAST_TRIANGLE_SOLID_ANGLE).then_some(seen)
    }

    /// The numbers with which a point is drawn by area (`warp::triangle`) that is the one drawn by these, uniform over the solid angle.
    /// From afar they are the same.
    pub fn numbers(&self, u: f64, v: f64) -> DVec2 {
        let [to_a, to_b, to_c] = self.distances;
        // Along the edge from a to c: the triangle up to there is seen under v times the solid angle.
        let (sine, cosine) = (0.5 * v * self.solid_angle).sin_cos();
        let beside = cosine * self.sine - sine * self.cosine;
        let sliding = if beside > 0.0 { (sine * self.one_and_cosine / beside).min(self.tangent) } else { self.tangent };
        let along_edge = share_of_edge([to_a, to_c], self.tangent, sliding);
        // From b to that point: the cosine with b is uniform, and so is the squared sine of half the angle.
        let b = (self.to_corner + self.edge_u) / to_b;
        let across = along_edge * self.edge_v - self.edge_u;
        let end = self.to_corner + along_edge * self.edge_v;
        let to_end = end.length();
        let whole = half_angle_tangent(b.cross(across).length(), b.dot(end), to_end);
        let part = whole * (u / (1.0 + (1.0 - u) * whole * whole)).sqrt();
        let along_arc = share_of_edge([to_b, to_end], whole, part);
        DVec2::new(along_arc * along_arc, along_edge)
    }
}

/// Tangent of half an angle whose sine and cosine are these over `length`.
fn half_angle_tangent(sine: f64, cosine: f64, length: f64) -> f64 {
    if cosine < 0.0 { (length - cosine) / sine } else { sine / (length + cosine) }
}

/// How far along an edge the direction meets it that is at an angle from the edge's beginning, which is seen under `whole`: tangents of
/// their halves. `distances` are those of the edge's ends.
fn share_of_edge(distances: [f64; 2], whole: f64, part: f64) -> f64 {
    // In proportion to the distance times the sine of the angle to either end.
    let near = distances[0] * part * (1.0 + whole * whole);
    let far = distances[1] * (whole - part) * (1.0 + whole * part);
    near / (near + far)
}

#[cfg(test)]
mod tests;
