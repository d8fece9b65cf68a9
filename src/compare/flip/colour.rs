//! The colour spaces of ꟻLIP: opponent colours that are linear in light (YCxCz), and CIELAB.

use glam::{DMat3, DVec3};

/// L*, a* and b*.
pub(super) type Lab = [f64; 3];

/// From linear sRGB to XYZ, by the primaries of Rec. ITU-R BT.709 and D65, row by row.
const TO_XYZ: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];

fn to_xyz() -> DMat3 {
    DMat3::from_cols_array_2d(&TO_XYZ).transpose()
}

/// XYZ of white.
fn white() -> DVec3 {
    to_xyz() * DVec3::ONE
}

/// Luminance, red against green and blue against yellow, of a linear colour (equation 1 of Zhang and Wandell 1997 as linearised by Flohr et
/// al. 1993).
pub(super) fn opponent_of_linear(colour: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = (to_xyz() * DVec3::from_array(colour) / white()).to_array();
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The inverse of [`opponent_of_linear`].
pub(super) fn linear_of_opponent([luminance, red_green, blue_yellow]: [f64; 3]) -> [f64; 3] {
    let y = (luminance + 16.0) / 116.0;
    let xyz = DVec3::new(y + red_green / 500.0, y, y - blue_yellow / 200.0) * white();
    (to_xyz().inverse() * xyz).to_array()
}

/// CIELAB (CIE 15:2004) of a linear colour.
pub(super) fn lab_of_linear(colour: [f64; 3]) -> Lab {
    const DELTA: f64 = 6.0 / 29.0;
    let curve = |t: f64| if t > DELTA.powi(3) { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 };
    let [x, y, z] = (to_xyz() * DVec3::from_array(colour) / white()).to_array().map(curve);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Colours look paler in the dark (Hunt 1952).
pub(super) fn hunt_adjusted([lightness, a, b]: Lab) -> Lab {
    [lightness, 0.01 * lightness * a, 0.01 * lightness * b]
}

/// Distance of colours far apart (Abasi, Tehran and Fairchild 2020).
pub(super) fn hyab(first: Lab, second: Lab) -> f64 {
    (first[0] - second[0]).abs() + (first[1] - second[1]).hypot(first[2] - second[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opponent_colours_come_back() {
        for colour in [[0.2, 0.5, 0.7], [0.0; 3], [1.0, 0.0, 0.3]] {
            let back = linear_of_opponent(opponent_of_linear(colour));
            assert!(colour.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-12), "{colour:?} {back:?}");
        }
    }

    /// CIE's values for sRGB's red, as published (Lindbloom): L* 53.24, a* 80.09, b* 67.20.
    #[test]
    fn red_is_where_it_is_published() {
        let lab = lab_of_linear([1.0, 0.0, 0.0]);
        assert!((lab[0] - 53.24).abs() < 0.01 && (lab[1] - 80.09).abs() < 0.02 && (lab[2] - 67.20).abs() < 0.02, "{lab:?}");
        assert!(lab_of_linear([1.0; 3]).iter().zip([100.0, 0.0, 0.0]).all(|(a, b)| (a - b).abs() < 1e-9));
    }
}
