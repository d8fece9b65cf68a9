//! The H function by iteration, against its explicit integral, its moments and published values.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::common::media::half_space::HalfSpace;
use crate::common::media::quadrature::integrate;

const ALBEDOS: [f64; 7] = [0.0, 0.1, 0.5, 0.8, 0.95, 0.999, 1.0];

/// ln H(µ) = −µ/π ∫₀^∞ ln(1 − ϖ arctan(t)/t) / (1 + µ² t²) dt, by t = tan θ.
fn explicit(albedo: f64, cosine: f64) -> f64 {
    let at = |angle: f64| {
        let t = angle.tan();
        // 1 − arctan(t)/t, by its series where the difference would lose digits.
        let term = |k: i32| -(-t * t).powi(k) / f64::from(2 * k + 1);
        let loss = if t < 0.25 { (1..16).map(term).sum() } else { 1.0 - angle / t };
        let logarithm = (1.0 - albedo + albedo * loss).ln();
        logarithm / (angle.cos().powi(2) + (cosine * angle.sin()).powi(2))
    };
    (-cosine / PI * integrate(&at, 0.0, FRAC_PI_2, 1e-12)).exp()
}

#[test]
fn the_iteration_agrees_with_the_explicit_integral() {
    for albedo in ALBEDOS {
        let half_space = HalfSpace::new(albedo);
        for cosine in [0.01, 0.1, 0.3, 0.5, 0.8, 1.0] {
            let (found, expected) = (half_space.h(cosine), explicit(albedo, cosine));
            assert!((found - expected).abs() < 1e-10, "albedo {albedo}, cosine {cosine}: {found} is not {expected}");
        }
    }
    assert!((HalfSpace::new(0.9).h(0.0) - 1.0).abs() < 1e-10);
    // The control: an albedo 2 % higher.
    assert!((HalfSpace::new(0.51).h(0.5) - explicit(0.5, 0.5)).abs() > 1e-3);
}

/// Chandrasekhar's table XI to its digits; H(1) of the lossless half space as is known to more (Viik 1986).
#[test]
fn published_values() {
    let lossless = HalfSpace::new(1.0);
    for (cosine, expected) in [(0.1, 1.24735), (0.5, 2.01278), (1.0, 2.90781)] {
        assert!((lossless.h(cosine) - expected).abs() < 1e-5, "{cosine}: {}", lossless.h(cosine));
    }
}

#[test]
fn the_law_of_reflection_keeps_its_albedos() {
    for albedo in ALBEDOS {
        let half_space = HalfSpace::new(albedo);
        // The mean of H: 2/ϖ (1 − √(1 − ϖ)).
        if albedo > 0.0 {
            let mean = integrate(&|x| 2.0 * x * half_space.h(x * x), 0.0, 1.0, 1e-12);
            let expected = 2.0 / albedo * (1.0 - (1.0 - albedo).sqrt());
            assert!((mean - expected).abs() < 1e-10, "albedo {albedo}: {mean} is not {expected}");
        }
        for cosine in [0.2, 0.6, 1.0] {
            let flux = |eye: f64| TAU * eye * half_space.radiance([cosine, eye]);
            let reflected = integrate(&|x| 2.0 * x * flux(x * x), 0.0, 1.0, 1e-12) / cosine;
            let found = half_space.plane_albedo(cosine);
            assert!((found - reflected).abs() < 1e-10, "albedo {albedo}, cosine {cosine}: {found} is not {reflected}");
        }
        let mean = integrate(&|x| 4.0 * x.powi(3) * half_space.plane_albedo(x * x), 0.0, 1.0, 1e-12);
        assert!((half_space.spherical_albedo() - mean).abs() < 1e-10, "albedo {albedo}");
    }
    assert_eq!(HalfSpace::new(1.0).plane_albedo(0.3), 1.0);
}
