//! Light that is scattered once, in homogeneous media. Coefficients are of one channel; a coloured medium is three of them.

use std::f64::consts::PI;

use super::phase::Phase;
use super::quadrature::{integrate, integrate_to_infinity};

/// A homogeneous medium in one channel, per unit length.
#[derive(Debug, Clone)]
pub struct Medium {
    pub scattering: f64,
    pub extinction: f64,
    pub phase: Phase,
}

impl Medium {
    fn albedo(&self) -> f64 {
        self.scattering / self.extinction
    }
}

/// The radiance at the origin of a ray of direction `direction` (length 1), scattered once by the medium over the ray's first `length` units, of a
/// point light of this radiant intensity. Everything is within the medium.
///
/// The place on the ray is t = t₀ + h tan θ, with h the light's distance from the ray and t₀ that of the foot: dt / d² = dθ / h, so the pole of the
/// light is gone (Kulla and Fajardo 2012 draw places so). The absolute tolerance is for intensity 1 and a phase function of 1.
pub fn of_point_light(medium: &Medium, light: [f64; 3], intensity: f64, direction: [f64; 3], length: f64, tolerance: f64) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let foot = dot(light, direction);
    let height = (dot(light, light) - foot * foot).sqrt();
    let at = |angle: f64| {
        let (place, distance) = (foot + height * angle.tan(), height / angle.cos());
        // Light travels from the lamp to the place, and then back along the ray: θ > 0 where the place is beyond the foot.
        let turned = -angle.sin();
        (-medium.extinction * (place + distance)).exp() * medium.phase.value(turned)
    };
    let [from, to] = [-foot / height, (length - foot) / height].map(f64::atan);
    medium.scattering * intensity / height * integrate(&at, from, to, tolerance)
}

/// The radiance of a glowing ball's light, scattered once by a medium that scatters evenly; the other arguments are those of [`of_point_light`]. The
/// ray stays clear of the ball. The light at a place comes from a cone, and travels from the near side of the ball.
pub fn of_ball_of_light(medium: &Medium, center: [f64; 3], radius: f64, radiance: f64, direction: [f64; 3], length: f64) -> f64 {
    assert_eq!(medium.phase, Phase::Isotropic, "the phase function is taken out of the integral over the cone");
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let foot = dot(center, direction);
    let height = (dot(center, center) - foot * foot).sqrt();
    let at = |angle: f64| {
        let (place, distance) = (foot + height * angle.tan(), height / angle.cos());
        let ratio = radius / distance;
        let widest = (1.0 - ratio * ratio).sqrt();
        // The cosine is 1 − (1 − widest) x², which keeps the root of the ball's near side smooth where the cone grazes it.
        let over_cone = |x: f64| {
            let below_one = (1.0 - widest) * (1.0 - x * x);
            let cosine = widest + below_one;
            let chord = distance * (cosine * cosine - widest * widest).max(0.0).sqrt();
            (-medium.extinction * (distance * cosine - chord)).exp() * 2.0 * x * (1.0 - widest)
        };
        let fluence = 2.0 * PI * radiance * integrate(&over_cone, 0.0, 1.0, 1e-12);
        (-medium.extinction * place).exp() * 0.25 / PI * fluence * distance * distance
    };
    let [from, to] = [-foot / height, (length - foot) / height].map(f64::atan);
    medium.scattering / height * integrate(&at, from, to, 1e-10)
}

/// Airlight by integration over the distance along the ray, without a change of variable.
pub fn of_point_light_by_distance(medium: &Medium, light: [f64; 3], intensity: f64, direction: [f64; 3], length: f64) -> f64 {
    let at = |place: f64| {
        let to_place: [f64; 3] = std::array::from_fn(|axis| place * direction[axis] - light[axis]);
        let squared = to_place.iter().map(|x| x * x).sum::<f64>();
        let turned = -(0..3).map(|axis| to_place[axis] * direction[axis]).sum::<f64>() / squared.sqrt();
        intensity / squared * (-medium.extinction * (place + squared.sqrt())).exp() * medium.phase.value(turned)
    };
    let integral = if length.is_finite() {
        integrate(&at, 0.0, length, 1e-13)
    } else {
        integrate_to_infinity(&at, 0.0, 1.0 / medium.extinction, 1e-13)
    };
    medium.scattering * integral
}

/// The radiance that a layer of this optical thickness sends back, scattered once, of light whose irradiance perpendicular to itself is given.
/// `cosines` are those of the directions to the light and to the eye with the normal, `turned` is that between the directions of travel.
pub fn reflected_by_layer(medium: &Medium, thickness: f64, irradiance: f64, cosines: [f64; 2], turned: f64) -> f64 {
    let [light, eye] = cosines;
    let paths = thickness * (1.0 / light + 1.0 / eye);
    medium.albedo() * medium.phase.value(turned) * irradiance * light / (light + eye) * -(-paths).exp_m1()
}

/// The radiance that a layer lets through, scattered once; the arguments are those of [`reflected_by_layer`], and the eye is on the far side.
pub fn transmitted_by_layer(medium: &Medium, thickness: f64, irradiance: f64, cosines: [f64; 2], turned: f64) -> f64 {
    let [light, eye] = cosines;
    let difference = thickness * (1.0 / light - 1.0 / eye);
    // (exp(−τ/µ₀) − exp(−τ/µ)) µ₀ / (µ₀ − µ), written so that equal angles are no special case to the last digits.
    let mean = if difference.abs() < 1e-12 { 1.0 } else { -(-difference).exp_m1() / difference };
    medium.albedo() * medium.phase.value(turned) * irradiance * (-thickness / eye).exp() * thickness / eye * mean
}

/// The radiance that a half space sends back of light from afar, scattered once: that of a layer without end.
pub fn reflected_by_half_space(medium: &Medium, irradiance: f64, cosines: [f64; 2], turned: f64) -> f64 {
    reflected_by_layer(medium, f64::INFINITY, irradiance, cosines, turned)
}
