//! Phase functions against their integrals by quadrature.

use std::f64::consts::TAU;

use crate::common::media::phase::Phase;
use crate::common::media::quadrature::{gauss_legendre, integrate, integrate_to_infinity};

pub fn phases() -> Vec<Phase> {
    let hg = Phase::HenyeyGreenstein;
    vec![
        Phase::Isotropic,
        hg(0.0),
        hg(1e-7),
        hg(0.5),
        hg(-0.7),
        hg(0.9),
        Phase::Rayleigh,
        Phase::blend(hg(0.8), hg(-0.4), 0.3),
        Phase::blend(Phase::Rayleigh, Phase::blend(Phase::Isotropic, hg(0.6), 0.5), 0.25),
    ]
}

/// P₀ … P_degree at x.
fn legendre(degree: usize, x: f64) -> f64 {
    let (mut before, mut value) = (1.0, x);
    for k in 2..=degree {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
    }
    if degree == 0 { before } else { value }
}

#[test]
fn moments_are_integrals_of_the_phase_function() {
    for phase in phases() {
        for degree in 0..=8 {
            let moment = integrate(&|x| TAU * phase.value(x) * legendre(degree, x), -1.0, 1.0, 1e-12);
            assert!((moment - phase.moment(degree)).abs() < 1e-11, "{phase:?}, degree {degree}: {moment}");
        }
        assert!((phase.mean_cosine() - phase.moment(1)).abs() < 1e-15);
    }
    // The control: scattering forward is not scattering backward.
    let mean = integrate(&|x| TAU * Phase::HenyeyGreenstein(0.5).value(x) * x, -1.0, 1.0, 1e-12);
    assert!((mean - Phase::HenyeyGreenstein(-0.5).mean_cosine()).abs() > 0.9);
}

#[test]
fn cumulative_probabilities_are_integrals_too() {
    for phase in phases() {
        for cosine in [-1.0, -0.99, -0.3, 0.0, 0.45, 0.97, 1.0] {
            let below = integrate(&|x| TAU * phase.value(x), -1.0, cosine, 1e-12);
            assert!((below - phase.cumulative(cosine)).abs() < 1e-11, "{phase:?}, {cosine}: {below}");
        }
        for probability in [0.01, 0.3, 0.5, 0.999] {
            assert!((phase.cumulative(phase.invert(probability)) - probability).abs() < 1e-12, "{phase:?}, {probability}");
        }
    }
}

#[test]
fn quadrature_is_exact_for_polynomials_and_resolves_peaks() {
    for count in [1, 2, 5, 33] {
        let rule = gauss_legendre(count, -0.5, 2.0);
        let degree = 2 * count as i32 - 1;
        let sum: f64 = rule.iter().map(|(x, weight)| weight * x.powi(degree)).sum();
        let exact = (2f64.powi(degree + 1) - 0.5f64.powi(degree + 1)) / f64::from(degree + 1);
        assert!((sum / exact - 1.0).abs() < 1e-12, "{count} points: {sum} is not {exact}");
    }
    let peak = integrate(&|x| 1e-3 / (1e-6 + (x - 0.3) * (x - 0.3)), 0.0, 1.0, 1e-12);
    assert!((peak - ((0.7f64 / 1e-3).atan() + (0.3f64 / 1e-3).atan())).abs() < 1e-10, "{peak}");
    let tail = integrate_to_infinity(&|x| x * (-3.0 * x).exp(), 1.0, 0.5, 1e-13);
    assert!((tail - (4.0 / 9.0) * (-3.0f64).exp()).abs() < 1e-12, "{tail}");
}
