//! Directions on a square, as pbrt has maps of light from everywhere: an octahedron's faces, mapped so that equal areas of the square are equal solid
//! angles (Clarberg 2008, "Fast equal-area mapping of the (hemi)sphere using SIMD").

use std::f64::consts::{FRAC_2_PI, FRAC_PI_4};

use glam::DVec3;

/// The direction of a place in the unit square: +z is in its middle, −z in its corners. Within a quadrant, places as far from the middle by the sum
/// of their coordinates have one height, and go evenly around.
pub fn direction_at([x, y]: [f64; 2]) -> DVec3 {
    let (right, down) = (2.0 * x - 1.0, 2.0 * y - 1.0);
    let beyond = right.abs() + down.abs() - 1.0;
    // The distance from the nearer pole, 1 at the equator.
    let radius = 1.0 - beyond.abs();
    let turn = if radius > 0.0 { (1.0 + (down.abs() - right.abs()) / radius) * FRAC_PI_4 } else { FRAC_PI_4 };
    let across = radius * (2.0 - radius * radius).max(0.0).sqrt();
    let height = (1.0 - radius * radius).copysign(-beyond);
    DVec3::new((across * turn.cos()).copysign(right), (across * turn.sin()).copysign(down), height)
}

/// The place of a direction of length 1.
pub fn place_of(direction: DVec3) -> [f64; 2] {
    let radius = (1.0 - direction.z.abs()).max(0.0).sqrt();
    let turn = direction.y.abs().atan2(direction.x.abs()) * FRAC_2_PI;
    let (mut right, mut down) = (radius * (1.0 - turn), radius * turn);
    if direction.z < 0.0 {
        (right, down) = (1.0 - down, 1.0 - right);
    }
    [right.copysign(direction.x), down.copysign(direction.y)].map(|place| 0.5 * (place + 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_texel_covers_the_same_solid_angle() {
        // Moments of the sphere by the middles of a fine grid: those of the uniform distribution.
        let side = 256;
        let at = |index: u32| (f64::from(index) + 0.5) / f64::from(side);
        let directions: Vec<DVec3> = (0..side * side).map(|index| direction_at([at(index % side), at(index / side)])).collect();
        let count = directions.len() as f64;
        let mean: DVec3 = directions.iter().copied().sum::<DVec3>() / count;
        let squares: DVec3 = directions.iter().map(|direction| *direction * *direction).sum::<DVec3>() / count;
        let fourth: DVec3 = directions.iter().map(|direction| direction.powf(2.0) * direction.powf(2.0)).sum::<DVec3>() / count;
        assert!(directions.iter().all(|direction| direction.is_normalized()));
        assert!(
            mean.length() < 1e-9 && (squares - 1.0 / 3.0).length() < 1e-4 && (fourth - 0.2).length() < 1e-4,
            "{squares} {fourth}"
        );
        // The control: without the mapping of equal areas.
        let plain = |[x, y]: [f64; 2]| crate::math::octahedron::direction_at([2.0 * x - 1.0, 2.0 * y - 1.0]);
        let squares: f64 =
            (0..side * side).map(|index| plain([at(index % side), at(index / side)]).z.powi(4)).sum::<f64>() / count;
        assert!((squares - 0.2).abs() > 1e-3, "{squares}");
    }

    /// Corners, the middle and the middles of sides are where pbrt has them.
    #[test]
    fn axes_lie_where_they_should() {
        let cases = [
            ([0.5, 0.5], DVec3::Z),
            ([1.0, 0.5], DVec3::X),
            ([0.0, 0.5], DVec3::NEG_X),
            ([0.5, 1.0], DVec3::Y),
            ([0.5, 0.0], DVec3::NEG_Y),
            ([0.0, 0.0], DVec3::NEG_Z),
            ([1.0, 1.0], DVec3::NEG_Z),
        ];
        for (place, expected) in cases {
            assert!(direction_at(place).distance(expected) < 1e-12, "{place:?} {}", direction_at(place));
        }
        // Half-way between two axes.
        assert!(direction_at([0.75, 0.75]).distance(DVec3::new(1.0, 1.0, 0.0).normalize()) < 1e-12);
        assert!(direction_at([0.6, 0.55]).z > 0.9 && direction_at([0.95, 0.95]).z < -0.9);
    }

    #[test]
    fn places_are_those_of_their_directions() {
        for step in 0..1000_u32 {
            let place = [f64::from(step % 37) / 37.0 + 0.01, f64::from(step % 41) / 41.0 + 0.01];
            let found = place_of(direction_at(place));
            assert!((found[0] - place[0]).abs() < 1e-9 && (found[1] - place[1]).abs() < 1e-9, "{place:?} {found:?}");
        }
    }
}
