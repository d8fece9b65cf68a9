//! Oren and Nayar's models and dust, against what is known of them.

use std::f64::consts::{FRAC_1_PI, PI};

use super::super::dust::Dust;
use super::super::energy_preserving_oren_nayar::EnergyPreservingOrenNayar;
use super::super::oren_nayar::OrenNayar;
use super::super::qualitative_oren_nayar::QualitativeOrenNayar;
use super::*;

/// The share of light that is scattered, seen from an angle, by midpoints over the hemisphere: even in the squares of sines, and around.
fn albedo_of(lobe: Lobe, wo_degrees: f64) -> Spectrum {
    let (rings, around) = (400, 200);
    let view = view(wo_degrees, 0.0);
    let mut sum = Spectrum::BLACK;
    for ring in 0..rings {
        // Fine at the horizon, where a lobe may change fast.
        let t = (f64::from(ring) + 0.5) / f64::from(rings);
        let (cosine, stretch) = (t * t, 2.0 * t);
        for step in 0..around {
            let phi = 2.0 * PI * (f64::from(step) + 0.5) / f64::from(around);
            let sine = (1.0 - cosine * cosine).sqrt();
            let wi = DVec3::new(sine * phi.cos(), sine * phi.sin(), cosine);
            sum += single(lobe, view).evaluate(wi).value * stretch;
        }
    }
    sum * (2.0 * PI / f64::from(rings * around))
}

fn energy_preserving(reflectance: f64, roughness: f64) -> Lobe {
    Lobe::EnergyPreservingOrenNayar(EnergyPreservingOrenNayar { reflectance: Spectrum::grey(reflectance), roughness })
}

fn qualitative(reflectance: f64, roughness: f64) -> Lobe {
    Lobe::QualitativeOrenNayar(QualitativeOrenNayar { reflectance: Spectrum::grey(reflectance), roughness })
}

fn full(reflectance: f64, roughness: f64) -> Lobe {
    Lobe::OrenNayar(OrenNayar { reflectance: Spectrum::grey(reflectance), roughness })
}

fn dust(thickness: f64, anisotropy: f64, base: f64) -> Lobe {
    Lobe::Dust(Dust { albedo: Spectrum::WHITE, thickness, anisotropy, base: Spectrum::grey(base) })
}

/// White facets return all light at every angle; the control is the qualitative model, which loses up to a third of it.
#[test]
fn no_light_is_lost_in_the_furnace() {
    for roughness in [0.0, 0.1, 0.5, 1.0] {
        for degrees in [0.0, 30.0, 60.0, 80.0, 88.0] {
            let found = albedo_of(energy_preserving(1.0, roughness), degrees).r();
            assert!((found - 1.0).abs() < 1e-4, "{roughness} at {degrees}: {found}");
        }
    }
    let lossy = albedo_of(qualitative(1.0, 1.0), 0.0).r();
    assert!((0.6..0.75).contains(&lossy), "{lossy}");
}

#[test]
fn smooth_facets_follow_lamberts_law() {
    let (view, wi) = (view(50.0, 0.0), at_degrees(65.0, 2.0));
    for lobe in [energy_preserving(0.7, 0.0), qualitative(0.7, 0.0), full(0.7, 0.0)] {
        let value = single(lobe, view).evaluate(wi).value.r();
        assert!((value - 0.7 * FRAC_1_PI * wi.z).abs() < 1e-12, "{lobe:?}: {value}");
    }
}

/// By hand, with light from 60° and 30°: on the same side, on the other one, and at a right angle.
#[test]
fn values_are_those_of_the_paper() {
    let (sigma2, rho): (f64, f64) = (0.36, 0.8);
    let (a, b) = (1.0 - 0.5 * sigma2 / (sigma2 + 0.33), 0.45 * sigma2 / (sigma2 + 0.09));
    let [alpha, beta] = [PI / 3.0, PI / 6.0];
    let view = view(60.0, 0.0);
    for (phi, cos_phi) in [(0.4, 1.0), (0.4 + PI, -1.0), (0.4 + PI / 2.0, 0.0)] {
        let wi = at_degrees(30.0, phi);
        let value = |lobe: Lobe| single(lobe, view).evaluate(wi).value.r() / (rho * FRAC_1_PI * wi.z);
        let simple = a + b * f64::max(0.0, cos_phi) * alpha.sin() * beta.tan();
        assert!((value(qualitative(rho, 0.6)) - simple).abs() < 1e-12, "{cos_phi}");
        let away = if cos_phi < 0.0 { (2.0 * beta / PI).powi(3) } else { 0.0 };
        let c3 = 0.125 * sigma2 / (sigma2 + 0.09) * (4.0 * alpha * beta / (PI * PI)).powi(2);
        let once =
            a + cos_phi * b * (alpha.sin() - away) * beta.tan() + (1.0 - cos_phi.abs()) * c3 * ((alpha + beta) / 2.0).tan();
        let twice = 0.17 * rho * sigma2 / (sigma2 + 0.13) * (1.0 - cos_phi * (2.0 * beta / PI).powi(2));
        assert!((value(full(rho, 0.6)) - once - twice).abs() < 1e-12, "{cos_phi}");
    }
}

/// A layer without end that scatters evenly returns ½·(1 − μ·ln(1 + 1/μ)) of the light (Chandrasekhar 1960, by the integral of 1/(μ + μ')); none at all is
/// the Lambert surface below it, which a thin one darkens by both ways through it.
#[test]
fn dust_scatters_once() {
    for degrees in [0.0, 45.0, 80.0] {
        let cosine = f64::to_radians(degrees).cos();
        let expected = 0.5 * (1.0 - cosine * (1.0 + 1.0 / cosine).ln());
        let found = albedo_of(dust(1e6, 0.0, 1.0), degrees).r();
        assert!((found - expected).abs() < 1e-3, "{degrees}: {found} {expected}");
        assert!((albedo_of(dust(0.0, 0.3, 0.6), degrees).r() - 0.6).abs() < 1e-3);
        // Light that is thrown back is more.
        assert!(albedo_of(dust(1e6, -0.5, 0.0), degrees).r() > found + 0.02, "{degrees}");
    }
    let (view, wi) = (view(60.0, 0.0), at_degrees(60.0, 2.0));
    let value = single(Lobe::Dust(Dust { albedo: Spectrum::BLACK, ..thin() }), view).evaluate(wi).value.r();
    assert!((value - 0.5 * 0.5 * FRAC_1_PI * (-0.8_f64).exp()).abs() < 1e-12, "{value}");
    // Straight back, by hand: p(180°) = (1 − g²)/(4π(1 + g)³) for g = 0.4.
    let back = single(Lobe::Dust(Dust { base: Spectrum::BLACK, ..thin() }), view).evaluate(view.wo).value.r();
    let phase = (1.0 - 0.16) / (4.0 * PI * 1.4_f64.powi(3));
    assert!((back - phase * (1.0 - (-0.8_f64).exp()) / 1.0 * 0.5).abs() < 1e-12, "{back}");
}

fn thin() -> Dust {
    Dust { albedo: Spectrum::WHITE, thickness: 0.2, anisotropy: 0.4, base: Spectrum::grey(0.5) }
}
