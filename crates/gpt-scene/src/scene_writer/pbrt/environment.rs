//! Light from everywhere on a square, as pbrt has it: an octahedron's faces, mapped so that every texel covers the same solid angle (Clarberg 2008,
//! "Fast equal-area mapping of the (hemi)sphere using SIMD").

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use glam::DVec3;
use rayon::prelude::*;

use crate::load::file::writer::picture;
use crate::scene::{Environment, ImageData, Texels};
use crate::spectrum::Spectrum;

/// Texels along a side of a sky's map.
pub const SKY_SIDE: u32 = 256;
/// The most texels along a side.
const LARGEST_SIDE: u32 = 4096;
/// Places along each side of a texel at which the map is looked up.
const LOOKUPS: u32 = 3;

/// Texels along a side, about as many in all as a lat-long map has.
pub fn side_for(width: u32, height: u32) -> u32 {
    let side = (f64::from(width) * f64::from(height)).sqrt().ceil() as u32;
    side.next_power_of_two().clamp(16, LARGEST_SIDE)
}

/// The picture of the radiance from all directions.
pub fn octahedral(side: u32, radiance: impl Fn(DVec3) -> Spectrum + Sync) -> Vec<u8> {
    let texel = |index: u32| {
        let (column, row) = (index % side, index / side);
        let at = |texel: u32, part: u32| (f64::from(texel) + (f64::from(part) + 0.5) / f64::from(LOOKUPS)) / f64::from(side);
        let places = (0..LOOKUPS * LOOKUPS).map(|part| [at(column, part % LOOKUPS), at(row, part / LOOKUPS)]);
        let sum: Spectrum = places.map(|place| radiance(direction_at(place))).sum();
        (sum / f64::from(LOOKUPS * LOOKUPS)).to_f32()
    };
    let texels = (0..side * side).into_par_iter().map(texel).collect();
    picture(&ImageData { width: side, height: side, texels: Texels::Float(texels), has_alpha: false })
}

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

/// The radiance from a direction by a lat-long map.
pub fn radiance(light: &Environment, map: &ImageData, direction: DVec3) -> Spectrum {
    let turns = light.rotation_degrees / 360.0;
    let u = (direction.x.atan2(-direction.z) / TAU + turns).rem_euclid(1.0);
    let v = direction.x.hypot(direction.z).atan2(direction.y) / PI;
    let (scale, offset) = light.rows.scale_and_offset(map.height);
    let (x, y) = (u * f64::from(map.width) - 0.5, v * scale + offset);
    let (left, top) = (x.floor(), y.floor());
    let texel = |column: f64, row: f64| {
        let column = (column as i64).rem_euclid(i64::from(map.width)) as usize;
        let row = (row as i64).clamp(0, i64::from(map.height) - 1) as usize;
        Spectrum::from_f32(map.texels.color(row * map.width as usize + column).to_array())
    };
    let row = |row: f64| texel(left, row).lerp(texel(left + 1.0, row), x - left);
    row(top).lerp(row(top + 1.0), y - top)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{EnvironmentRadiance, MapRows};

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
    fn maps_are_looked_up_where_they_show_a_direction() {
        let texels = Texels::Float((0..32).map(|index| [index as f32, 0.0, 0.0]).collect());
        let map = ImageData { width: 8, height: 4, texels, has_alpha: false };
        let light = |rotation_degrees: f64| Environment {
            radiance: EnvironmentRadiance::Constant(Spectrum::BLACK),
            rotation_degrees,
            rows: MapRows::Inside,
            mirrored: false,
        };
        // −z is at the left border and +x a quarter to the right; the second row's middle is above the horizon.
        let up = |direction: DVec3| (direction + DVec3::Y * (PI / 8.0).tan()).normalize();
        let x = up(DVec3::X);
        let at_x = radiance(&light(0.0), &map, x).r();
        assert!((at_x - (8.0 + 1.5)).abs() < 1e-9, "{at_x}");
        let turned = radiance(&light(45.0), &map, x).r();
        assert!((turned - (8.0 + 2.5)).abs() < 1e-9, "{turned}");
    }
}
