//! Light from everywhere on a square whose texels cover equal solid angles, as pbrt has it.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use rayon::prelude::*;

use crate::equal_area_square::direction_at;
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

/// The radiance from a direction by a lat-long map.
pub fn radiance(light: &Environment, map: &ImageData, direction: DVec3) -> Spectrum {
    let turns = light.rotation_degrees / 360.0;
    let direction = light.turn().map_or(direction, |turn| turn.transpose() * direction);
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
    fn maps_are_looked_up_where_they_show_a_direction() {
        let texels = Texels::Float((0..32).map(|index| [index as f32, 0.0, 0.0]).collect());
        let map = ImageData { width: 8, height: 4, texels, has_alpha: false };
        let light = |rotation_degrees: f64| Environment {
            radiance: EnvironmentRadiance::Constant(Spectrum::BLACK),
            rotation_degrees,
            turn: None,
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
