//! Light scattered once: two ways to integrate, a limit in closed form, and the balance of all that a lamp sends out.

use std::f64::consts::{PI, TAU};

use super::phase::phases;
use crate::common::media::airlight::{
    Medium, of_ball_of_light, of_point_light, of_point_light_by_distance, reflected_by_half_space, reflected_by_layer,
    transmitted_by_layer,
};
use crate::common::media::phase::Phase;
use crate::common::media::quadrature::{gauss_legendre, integrate};

fn medium(phase: Phase) -> Medium {
    Medium { scattering: 0.3, extinction: 0.5, phase }
}

#[test]
fn both_variables_give_one_integral() {
    for phase in phases() {
        for (light, length) in [([0.4, 0.2, -3.0], f64::INFINITY), ([1.0, -1.0, -2.0], 2.5), ([0.5, 0.0, 1.0], 4.0)] {
            let medium = medium(phase.clone());
            let direction = [0.0, 0.0, -1.0];
            let found = of_point_light(&medium, light, 2.0, direction, length, 1e-12);
            let expected = of_point_light_by_distance(&medium, light, 2.0, direction, length);
            assert!((found - expected).abs() < 1e-10 * expected.max(1.0), "{phase:?}, {light:?}: {found} is not {expected}");
            // The control: a lamp a thousandth farther from the ray.
            let moved = of_point_light(&medium, light.map(|x| x * 1.001), 2.0, direction, length, 1e-12);
            assert!((moved - expected).abs() > 1e-5 * expected, "{moved} is {expected}");
        }
    }
}

/// In thin air the exponentials are 1, and what is left is the angle that the ray spans at the lamp.
#[test]
fn thin_air_shows_the_angle_at_the_lamp() {
    let thin = Medium { scattering: 1e-9, extinction: 1e-9, phase: Phase::Isotropic };
    let found = of_point_light(&thin, [0.5, 0.0, -1.0], 1.0, [0.0, 0.0, -1.0], 3.0, 1e-14);
    let expected = 1e-9 * 0.25 / PI / 0.5 * ((2.0f64 / 0.5).atan() + (1.0f64 / 0.5).atan());
    assert!((found / expected - 1.0).abs() < 1e-8, "{found} is not {expected}");
}

/// A lamp of intensity 1 sends out 4π; each of its photons is scattered for the first time once, by the albedo, and then travels 1/σ on the mean. So
/// the fluence of light scattered once, over all of space, is 4π ϖ / σ, for every phase function.
#[test]
fn all_light_scattered_once_is_accounted_for() {
    for phase in [Phase::Isotropic, Phase::HenyeyGreenstein(0.6), Phase::Rayleigh] {
        let medium = medium(phase);
        // Places around the lamp and directions there, by rules that are ample for what is smooth.
        let mut all = 0.0;
        for (part, weight) in gauss_legendre(48, 0.0, 1.0) {
            let distance = 4.0 * part / (1.0 - part);
            let volume = weight * 4.0 / (1.0 - part).powi(2) * 2.0 * TAU * distance * distance;
            for (angle, weight) in gauss_legendre(48, 0.0, PI) {
                let (light, direction) = ([0.0, 0.0, distance], [angle.sin(), 0.0, angle.cos()]);
                let radiance = of_point_light(&medium, light, 1.0, direction, f64::INFINITY, 1e-10);
                all += volume * weight * TAU * angle.sin() * radiance;
            }
        }
        let expected = 4.0 * PI * 0.6 / 0.5;
        assert!((all / expected - 1.0).abs() < 1e-5, "{:?}: {all} is not {expected}", medium.phase);
    }
}

#[test]
fn layers_are_integrals_over_their_depth() {
    for phase in phases() {
        let medium = medium(phase);
        for cosines in [[0.5, 0.8], [1.0, 0.3], [0.7, 0.7]] {
            let ([light, eye], turned, thickness) = (cosines, -0.2, 1.7);
            let source = 0.6 * medium.phase.value(turned) * 3.0 / eye;
            let back = integrate(&|depth| source * (-depth / light - depth / eye).exp(), 0.0, thickness, 1e-13);
            let on = integrate(&|depth| source * (-depth / light - (thickness - depth) / eye).exp(), 0.0, thickness, 1e-13);
            let found = reflected_by_layer(&medium, thickness, 3.0, cosines, turned);
            assert!((found - back).abs() < 1e-11, "{found} is not {back}");
            let found = transmitted_by_layer(&medium, thickness, 3.0, cosines, turned);
            assert!((found - on).abs() < 1e-11, "{found} is not {on}");
            let deep = reflected_by_layer(&medium, 60.0, 3.0, cosines, turned);
            assert!((reflected_by_half_space(&medium, 3.0, cosines, turned) - deep).abs() < 1e-14);
        }
    }
}

/// A ball that is small beside its distance is a point of the intensity L π r²; and in thin air a place sees the solid angle of a large one.
#[test]
fn balls_of_light_are_points_from_afar() {
    let medium = medium(Phase::Isotropic);
    let (center, direction) = ([1.0, -1.0, -2.0], [0.0, 0.0, -1.0]);
    let point = of_point_light(&medium, center, PI * 1e-4, direction, 2.5, 1e-14);
    let ball = of_ball_of_light(&medium, center, 1e-2, 1.0, direction, 2.5);
    // The near side of the ball is nearer by up to its radius.
    assert!((ball / point - 1.0).abs() < 6e-3 && ball > point, "{ball} is not {point}");
    let thin = Medium { scattering: 1e-9, extinction: 1e-9, phase: Phase::Isotropic };
    let ball = of_ball_of_light(&thin, center, 1.2, 3.0, direction, 2.5);
    let share = |place: f64| 0.5 * (1.0 - (1.0 - 1.44 / (2.0 + (place - 2.0) * (place - 2.0))).sqrt());
    let expected = 1e-9 * 3.0 * integrate(&share, 0.0, 2.5, 1e-13);
    assert!((ball / expected - 1.0).abs() < 1e-8, "{ball} is not {expected}");
    // Between the two: its surface in parts, each of which is a point that shines by the cosine.
    let (radius, rule) = (0.7, gauss_legendre(40, 0.0, 1.0));
    let mut sum = 0.0;
    for &(place, weight) in &rule {
        let place = 2.5 * place;
        let distance = (2.0 + (place - 2.0) * (place - 2.0)).sqrt();
        // Over the ball's side that is seen: cosines at its centre from the horizon to 1.
        for &(part, share) in &rule {
            let horizon = radius / distance;
            let cosine = horizon + (1.0 - horizon) * part;
            let away = (distance * distance + radius * radius - 2.0 * distance * radius * cosine).sqrt();
            let facing = (distance * cosine - radius) / away;
            let area = TAU * radius * radius * (1.0 - horizon) * share;
            sum += 2.5 * weight * (-0.5 * (place + away)).exp() * 0.3 * 0.25 / PI * facing * area / (away * away);
        }
    }
    let ball = of_ball_of_light(&medium, center, radius, 1.0, direction, 2.5);
    assert!((ball / sum - 1.0).abs() < 1e-8, "{ball} is not {sum}");
}
