//! Cellular noise in two dimensions (Worley 1996).

use glam::DVec2;

use super::lattice::{cell_of, lattice_bits};

/// Distance to the nearest feature point, at most 1.
///
/// Every lattice cell has one: at x = upper half of [`lattice_bits`] / 2¹⁶ and y = lower half / 2¹⁶ from the cell's corner. Points
/// outside the 3 × 3 cells around the looked-up one are farther than 1.
pub fn share(point: DVec2, seed: u32) -> f64 {
    nearest(point, seed).map_or(1.0, DVec2::length)
}

/// How [`share`] changes with the place: away from the nearest feature point.
pub fn gradient(point: DVec2, seed: u32) -> DVec2 {
    nearest(point, seed).map_or(DVec2::ZERO, |offset| -offset.normalize_or_zero())
}

/// From the point to the nearest feature point, where that is closer than 1.
fn nearest(point: DVec2, seed: u32) -> Option<DVec2> {
    let ([x, y], place) = cell_of(point);
    let offset = |right: i64, up: i64| {
        let bits = lattice_bits(x.wrapping_add(right), y.wrapping_add(up), seed);
        let feature = DVec2::new(f64::from(bits >> 16), f64::from(bits & 0xffff)) / 65_536.0;
        DVec2::new(right as f64, up as f64) + feature - place
    };
    let cells = (-1..=1).flat_map(|up| (-1..=1).map(move |right| (right, up)));
    let offsets = cells.map(|(right, up)| offset(right, up)).filter(|offset| offset.length_squared() < 1.0);
    offsets.min_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_feature_point_of_a_cell_is_at_distance_zero() {
        for (x, y) in (-3..4).flat_map(|x| (-3..4).map(move |y| (x, y))) {
            let bits = lattice_bits(x, y, 9);
            let feature = DVec2::new(x as f64, y as f64) + DVec2::new(f64::from(bits >> 16), f64::from(bits & 0xffff)) / 65_536.0;
            assert_eq!(share(feature, 9), 0.0);
            let near = share(feature + DVec2::new(0.001, 0.0), 9);
            assert!(near > 0.0 && near <= 0.001 + 1e-12, "{near}");
        }
    }

    #[test]
    fn distances_are_one_lipschitz_and_at_most_one() {
        for i in 0..5000 {
            let point = DVec2::new(f64::from(i) * 0.618_034 % 9.0 - 4.0, f64::from(i) * 0.414_214 % 7.0 - 3.0);
            let (here, there) = (share(point, 2), share(point + DVec2::new(0.05, 0.1), 2));
            assert!((here - there).abs() <= DVec2::new(0.05, 0.1).length() + 1e-12 && (0.0..=1.0).contains(&here));
        }
    }
}
