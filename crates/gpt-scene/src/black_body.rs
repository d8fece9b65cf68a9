//! The colours of black bodies.

use glam::DVec3;

use crate::math::xyz_to_rec709;
use crate::spectrum::Spectrum;

/// Wavelengths that are added up, nm: a tenth of what the eye sees of a black body changes within a hundred of them.
const SHORTEST: u32 = 360;
const LONGEST: u32 = 830;
const STEP: u32 = 2;
/// Planck's second radiation constant, nm·K (CODATA 2018).
const SECOND_CONSTANT: f64 = 1.438_776_877e7;

/// Linear Rec.709 colour of a black body of this temperature in kelvin, its largest channel 1. Below some 1900 K the colour lies outside of
/// Rec.709: the blue channel is then 0.
pub fn black_body(kelvin: f64) -> Spectrum {
    let linear = xyz_to_rec709(tristimulus(kelvin)).max(Spectrum::BLACK);
    linear / linear.max_component()
}

/// Linear Rec.709 light of a black body of this temperature in kelvin as a multiple of the brightest channel at the temperature `hottest`.
/// A body below 500 K gives off none that is seen.
pub fn glow(kelvin: f64, hottest: f64) -> Spectrum {
    if kelvin < 500.0 {
        return Spectrum::BLACK;
    }
    let linear = |kelvin: f64| xyz_to_rec709(tristimulus(kelvin)).max(Spectrum::BLACK);
    linear(kelvin) / linear(hottest).max_component()
}

/// CIE 1931 XYZ, up to a factor: Planck's law times the matching functions.
pub fn tristimulus(kelvin: f64) -> DVec3 {
    let wavelengths = (SHORTEST..=LONGEST).step_by(STEP as usize).map(f64::from);
    wavelengths.fold(DVec3::ZERO, |sum, wavelength| {
        // 550 nm scales the fifth power to numbers near 1.
        let radiance = (550.0 / wavelength).powi(5) / (SECOND_CONSTANT / (wavelength * kelvin)).exp_m1();
        sum + radiance * matching(wavelength)
    })
}

/// The CIE 1931 colour matching functions by the sums of Gaussians of Wyman, Sloan and Shirley 2013, "Simple Analytic Approximations to the
/// CIE XYZ Color Matching Functions", table 1.
fn matching(wavelength: f64) -> DVec3 {
    let lobe = |height: f64, center: f64, below: f64, above: f64| {
        let t = (wavelength - center) * if wavelength < center { below } else { above };
        height * (-0.5 * t * t).exp()
    };
    DVec3::new(
        lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) + lobe(-0.065, 501.1, 0.0490, 0.0382),
        lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
        lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chromaticities of the Planckian locus, CIE 15:2004; 2856 K is illuminant A.
    #[test]
    fn chromaticities_are_those_of_the_planckian_locus() {
        for (kelvin, x, y) in [
            (2000.0, 0.5267, 0.4133),
            (2856.0, 0.4476, 0.4074),
            (4000.0, 0.3805, 0.3768),
            (6500.0, 0.3135, 0.3237),
            (10_000.0, 0.2807, 0.2884),
        ] {
            let color = tristimulus(kelvin);
            let [found_x, found_y] = [color.x, color.y].map(|part| part / color.element_sum());
            // The tolerance is the error of the sums of Gaussians.
            assert!((found_x - x).abs() < 4e-3 && (found_y - y).abs() < 4e-3, "{kelvin} K: {found_x} {found_y}");
        }
    }

    #[test]
    fn what_is_hotter_glows_brighter() {
        assert_eq!(glow(1500.0, 1500.0), black_body(1500.0));
        let [cool, hot] = [glow(1200.0, 2000.0), glow(2000.0, 2000.0)];
        // Wien's law at wavelengths to either side of those that red is seen by.
        let ratio = |wavelength: f64| (-1.438_776_877e7 / wavelength * (1.0 / 1200.0 - 1.0 / 2000.0)).exp();
        let found = cool.r() / hot.r();
        assert!(ratio(600.0) < found && found < ratio(650.0), "{cool} {hot}");
        assert_eq!(glow(300.0, 2000.0), Spectrum::BLACK);
    }

    #[test]
    fn the_largest_channel_is_1_and_heat_turns_red_to_blue() {
        let mut before = f64::INFINITY;
        for kelvin in (1000..=40_000).step_by(500) {
            let color = black_body(kelvin.into());
            assert!(color.max_component() == 1.0 && color.min_component() >= 0.0, "{kelvin}: {color:?}");
            let ratio = color.r() / color.b().max(1e-9);
            assert!(ratio <= before, "{kelvin}: {color:?}");
            before = ratio;
        }
    }
}
