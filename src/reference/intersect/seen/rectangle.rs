//! Rectangles as they are seen from a point: directions uniform over their solid angle (Ureña, Fajardo and King 2013).

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use crate::sampling::solid_angle::{LEAST_DISTANCE, LEAST_SOLID_ANGLE};

/// A rectangle seen from a point, in axes along its edges with the point at their origin.
#[derive(Debug, Clone, Copy)]
pub struct SeenRectangle {
    low: DVec2,
    high: DVec2,
    /// Distance of the plane.
    distance: f64,
    /// In steradians.
    pub solid_angle: f64,
    /// 2π less the angles at the corners of high x, low y last: where the angle that is drawn begins.
    first_angle: f64,
}

impl SeenRectangle {
    /// The rectangle of a corner and perpendicular edges. None where its points are better drawn by area.
    pub fn new(from: DVec3, corner: DVec3, edge_u: DVec3, edge_v: DVec3) -> Option<Self> {
        let (width, height) = (edge_u.length(), edge_v.length());
        let (x, y) = (edge_u / width, edge_v / height);
        let to_corner = corner - from;
        let low = DVec2::new(to_corner.dot(x), to_corner.dot(y));
        let high = low + DVec2::new(width, height);
        let distance = to_corner.dot(x.cross(y)).abs();
        let farthest = low.abs().max(high.abs()).max_element();
        if distance <= LEAST_DISTANCE * farthest {
            return None;
        }
        // The angle between the planes through the point and two sides, from the cosines of their normals with the rectangle's.
        let side = |offset: f64| {
            let squared = offset * offset + distance * distance;
            [offset / squared.sqrt(), distance * distance / squared]
        };
        let corner_angle = |[a, sine_a]: [f64; 2], [b, sine_b]: [f64; 2]| (sine_a + a * a * sine_b).sqrt().atan2(-a * b);
        let [below, right, above, left] = [side(-low.y), side(high.x), side(high.y), side(-low.x)];
        let before = corner_angle(below, right) + corner_angle(right, above);
        let first_angle = TAU - corner_angle(above, left) - corner_angle(left, below);
        let solid_angle = before - first_angle;
        (solid_angle >= LEAST_SOLID_ANGLE).then_some(Self { low, high, distance, solid_angle, first_angle })
    }

    /// The place along the edges, in [0, 1] × [0, 1], of a point whose direction is uniform over the solid angle.
    pub fn place(&self, u: f64, v: f64) -> DVec2 {
        let Self { low, high, distance, .. } = *self;
        let squared_distance = distance * distance;
        // Along x: the part of the rectangle up to there is seen under u times its solid angle.
        let (sine, cosine) = (self.first_angle + u * self.solid_angle).sin_cos();
        let squared_low = low.y * low.y + squared_distance;
        let b0 = -low.y / squared_low.sqrt();
        let b1 = high.y / (high.y * high.y + squared_distance).sqrt();
        let numerator = cosine * b0 - b1;
        let under_root = numerator * numerator - squared_distance / squared_low * sine * sine;
        let x = (distance * sine * numerator.signum() / under_root.max(f64::MIN_POSITIVE).sqrt()).clamp(low.x, high.x);
        // Along y: uniform in the sine of the angle above the plane through the point and the x axis.
        let across = (x * x + squared_distance).sqrt();
        let sine_of = |y: f64| y / (y * y + across * across).sqrt();
        let height = sine_of(low.y) + v * (sine_of(high.y) - sine_of(low.y));
        let y = (height * across / (1.0 - height * height).max(f64::MIN_POSITIVE).sqrt()).clamp(low.y, high.y);
        (DVec2::new(x, y) - low) / (high - low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The solid angle by the midpoint rule, and shares of it by counting.
    #[test]
    fn directions_are_uniform_over_the_solid_angle() {
        let (corner, edge_u, edge_v) = (DVec3::new(-1.0, 2.0, 0.5), DVec3::new(2.0, 0.0, 1.0), DVec3::new(-0.5, 0.3, 1.0));
        for from in [DVec3::ZERO, DVec3::new(0.5, 1.9, 1.4), DVec3::new(-3.0, 0.5, 2.0), DVec3::new(0.2, 4.0, 1.0)] {
            let seen = SeenRectangle::new(from, corner, edge_u, edge_v).expect("it is large");
            let normal = edge_u.cross(edge_v);
            let steps = 400;
            let middle = |index: u32| (f64::from(index) + 0.5) / f64::from(steps);
            let (mut sum, mut left) = (0.0, 0.0);
            for (i, j) in (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j))) {
                let to_point = corner + edge_u * middle(i) + edge_v * middle(j) - from;
                let part = to_point.dot(normal).abs() / to_point.length().powi(3) / f64::from(steps * steps);
                sum += part;
                left += if middle(i) < 0.3 { part } else { 0.0 };
            }
            assert!((seen.solid_angle / sum - 1.0).abs() < 1e-4, "{from}: {} and {sum}", seen.solid_angle);
            let below = (0..20_000).filter(|&i| seen.place((f64::from(i) + 0.5) / 20_000.0, 0.3).x < 0.3).count();
            assert!((below as f64 / 20_000.0 - left / sum).abs() < 1e-3, "{from}: {below} and {}", left / sum);
        }
    }
}
