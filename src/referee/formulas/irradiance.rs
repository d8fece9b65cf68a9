//! Irradiance at a point `p` with normal `n`, of light whose radiance or intensity is 1.

use std::f64::consts::PI;

use super::vector::{Vector, cross, dot, length, normalized, sub};

/// A point that sends the intensity 1 in every direction: cos θ / r².
pub fn point(p: Vector, n: Vector, light: Vector) -> f64 {
    let to_light = sub(light, p);
    let r = length(to_light);
    (dot(n, to_light) / r).max(0.0) / (r * r)
}

/// Parallel light of irradiance 1 that travels along `direction`.
pub fn directional(n: Vector, direction: Vector) -> f64 {
    (-dot(n, normalized(direction))).max(0.0)
}

/// A polygon that lies above the horizon, its front towards p if its corners run counter-clockwise seen from there (Lambert 1760; Baum, Rushmeier and
/// Winget 1989, equation 2): half the sum of the angles of its edges by the cosines of their planes. Below 0 for one that runs clockwise.
pub fn polygon(p: Vector, n: Vector, corners: &[Vector]) -> f64 {
    let directions: Vec<Vector> = corners.iter().map(|&corner| normalized(sub(corner, p))).collect();
    let mut sum = 0.0;
    for (index, &a) in directions.iter().enumerate() {
        let b = directions[(index + 1) % directions.len()];
        let normal = cross(a, b);
        let sine = length(normal);
        if sine > 0.0 {
            sum += sine.atan2(dot(a, b)) * dot(n, normal) / sine;
        }
    }
    // Corners that run counter-clockwise seen from p have products that point away from there.
    -0.5 * sum
}

/// A sphere that is wholly above the horizon: π·sin²·cos of its angular radius and of its middle's angle with the normal.
pub fn sphere(p: Vector, n: Vector, center: Vector, radius: f64) -> f64 {
    let to_center = sub(center, p);
    let distance = length(to_center);
    PI * (radius / distance).powi(2) * dot(n, to_center) / distance
}

/// A disk of this radius that is parallel to the receiver, `height` above its plane, its middle `aside` from the receiver's normal (Foote 1915; Howell's
/// catalogue of configuration factors, B-13).
pub fn disk(height: f64, aside: f64, radius: f64) -> f64 {
    let (h2, a2, r2) = (height * height, aside * aside, radius * radius);
    let sum = h2 + a2 + r2;
    0.5 * PI * (1.0 - (h2 + a2 - r2) / (sum * sum - 4.0 * a2 * r2).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: Vector = [0.0, 0.0, 1.0];

    /// Corners of a square of side 2 at this height, counter-clockwise seen from below.
    fn square(height: f64, [x, y]: [f64; 2]) -> [Vector; 4] {
        [[x - 1.0, y - 1.0, height], [x - 1.0, y + 1.0, height], [x + 1.0, y + 1.0, height], [x + 1.0, y - 1.0, height]]
    }

    /// The integral over small pieces of the surface.
    fn summed(height: f64, middle: [f64; 2]) -> f64 {
        let pieces = 400;
        let mut sum = 0.0;
        for i in 0..pieces {
            for j in 0..pieces {
                let at = |index: i32, middle: f64| middle - 1.0 + 2.0 * (f64::from(index) + 0.5) / f64::from(pieces);
                let (x, y) = (at(i, middle[0]), at(j, middle[1]));
                let r2 = x * x + y * y + height * height;
                sum += height * height / (r2 * r2);
            }
        }
        sum * (2.0 / f64::from(pieces)).powi(2)
    }

    #[test]
    fn polygons_are_the_sum_of_their_pieces() {
        for (height, middle) in [(1.0, [0.0, 0.0]), (2.0, [1.5, -0.7])] {
            let (closed, sum) = (polygon([0.0; 3], UP, &square(height, middle)), summed(height, middle));
            assert!((closed - sum).abs() < 1e-5 * sum, "{closed} {sum}");
        }
        // From behind.
        let mut corners = square(1.0, [0.0, 0.0]);
        corners.reverse();
        assert!(polygon([0.0; 3], UP, &corners) < 0.0);
    }

    #[test]
    fn disks_and_spheres_meet_on_the_axis() {
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        close(disk(2.0, 0.0, 1.0), PI / 5.0);
        // A sphere is a disk seen from its middle's direction.
        let radius = 0.5f64;
        let sine = radius / 2.0;
        close(sphere([0.0; 3], UP, [0.0, 0.0, 2.0], radius), PI * sine * sine);
        close(disk(2.0, 1e6, 1.0), 0.0);
    }

    #[test]
    fn a_disk_aside_is_a_polygon_of_many_corners() {
        let corners: Vec<Vector> = (0..4000)
            .map(|index| -2.0 * PI * f64::from(index) / 4000.0)
            .map(|angle| [1.3 + 0.8 * angle.cos(), 0.8 * angle.sin(), 1.5])
            .collect();
        let (closed, many) = (disk(1.5, 1.3, 0.8), polygon([0.0; 3], UP, &corners));
        assert!((closed - many).abs() < 1e-5 * closed, "{closed} {many}");
    }
}
