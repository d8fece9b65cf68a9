//! The clear sky of Preetham, Shirley and Smits 1999, "A Practical Analytic Model for Daylight", appendix A: Perez' distribution about a zenith
//! whose luminance and chromaticity follow from the turbidity and the sun's height.

use std::f64::consts::PI;

use glam::{DVec3, DVec4};

use crate::math::xyz_to_rec709;
use crate::spectrum::Spectrum;

/// Factor from W to lm, by which luminance is told as radiance.
const LUMEN_PER_WATT: f64 = 683.0;

/// Perez' five coefficients of luminance and of the chromaticities x and y: a slope by the turbidity, and a constant.
const COEFFICIENTS: [[[f64; 2]; 5]; 3] = [
    [[0.1787, -1.4630], [-0.3554, 0.4275], [-0.0227, 5.3251], [0.1206, -2.5771], [-0.0670, 0.3703]],
    [[-0.0193, -0.2592], [-0.0665, 0.0008], [-0.0004, 0.2125], [-0.0641, -0.8989], [-0.0033, 0.0452]],
    [[-0.0167, -0.2608], [-0.0950, 0.0092], [-0.0079, 0.2102], [-0.0441, -1.6537], [-0.0109, 0.0529]],
];

/// The zenith's x and y: rows by turbidity squared, turbidity and 1, columns by the cube, the square, the first power of the sun's zenith angle, and 1.
const ZENITH: [[[f64; 4]; 3]; 2] = [
    [[0.00166, -0.00375, 0.00209, 0.0], [-0.02903, 0.06377, -0.03202, 0.00394], [0.11693, -0.21196, 0.06052, 0.25886]],
    [[0.00275, -0.00610, 0.00317, 0.0], [-0.04214, 0.08970, -0.04153, 0.00516], [0.15346, -0.26756, 0.06670, 0.26688]],
];

/// Perez' distribution F(θ, γ), of the cosine of the direction's zenith angle and its angle from the sun.
fn perez([a, b, c, d, e]: [f64; 5], cosine: f64, gamma: f64) -> f64 {
    (1.0 + a * (b / cosine).exp()) * (1.0 + c * (d * gamma).exp() + e * gamma.cos().powi(2))
}

/// Radiance from a direction of length 1 above the horizon, W·m⁻²·sr⁻¹, linear Rec.709; colours outside of that are clipped.
pub fn radiance(turbidity: f64, to_sun: DVec3, direction: DVec3) -> Spectrum {
    let sun = to_sun.y.clamp(-1.0, 1.0).acos();
    // A row at the horizon is as bright as one a fifth of a degree above it.
    let cosine = direction.y.max(0.0035);
    let gamma = direction.dot(to_sun).clamp(-1.0, 1.0).acos();
    let chi = (4.0 / 9.0 - turbidity / 120.0) * (PI - 2.0 * sun);
    let kilo_candela = (4.0453 * turbidity - 4.9710) * chi.tan() - 0.2155 * turbidity + 2.4192;
    let powers = DVec4::new(sun.powi(3), sun * sun, sun, 1.0);
    let chromaticity = ZENITH.map(|rows| {
        let [squared, first, constant] = rows.map(|row| DVec4::from_array(row).dot(powers));
        turbidity * turbidity * squared + turbidity * first + constant
    });
    let at_zenith = [1e3 * kilo_candela.max(0.0), chromaticity[0], chromaticity[1]];
    let [luminance, x, y] = std::array::from_fn(|quantity| {
        let coefficients = COEFFICIENTS[quantity].map(|[slope, constant]| slope * turbidity + constant);
        at_zenith[quantity] * perez(coefficients, cosine, gamma) / perez(coefficients, 1.0, sun)
    });
    let xyz = DVec3::new(x / y, 1.0, (1.0 - x - y) / y) * luminance;
    (xyz_to_rec709(xyz) / LUMEN_PER_WATT).max(Spectrum::BLACK)
}
