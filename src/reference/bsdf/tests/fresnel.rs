//! Fresnel's equations and Snell's law.

use super::super::fresnel::{conductor_reflectance, normal_incidence_reflectance, schlick_reflectance};
use super::*;

#[test]
fn fresnel_has_its_known_values() {
    // Normal incidence: ((n−1)/(n+1))².
    assert!((dielectric_reflectance(1.0, 1.5) - 0.04).abs() < 1e-15);
    assert!((dielectric_reflectance(1.0, 1.0 / 1.5) - 0.04).abs() < 1e-15);
    assert!(dielectric_reflectance(0.3, 1.0) < 1e-30);
    assert_eq!(dielectric_reflectance(0.0, 1.5), 1.0);
    // Brewster's angle, tanθ = n: no parallel part, the perpendicular one is ((n²−1)/(n²+1))².
    let brewster = 1.5_f64.atan().cos();
    assert!((dielectric_reflectance(brewster, 1.5) - 0.5 * (1.25_f64 / 3.25).powi(2)).abs() < 1e-15);
    // Past the critical angle reflection is total, exactly.
    let critical = (1.0_f64 / 1.5).asin();
    assert_eq!(dielectric_reflectance((critical + 1e-9).cos(), 1.0 / 1.5), 1.0);
    assert!(dielectric_reflectance((critical - 1e-3).cos(), 1.0 / 1.5) < 1.0);
}

#[test]
fn refraction_follows_snell_and_is_reversible() {
    for degrees in [0.0, 20.0, 41.0, 60.0, 89.0] {
        for eta in [1.5, 1.0 / 1.5, 2.4] {
            let wo = at_degrees(degrees, 1.0);
            let Some(wi) = refract(wo, DVec3::Z, eta) else {
                assert_eq!(dielectric_reflectance(wo.z, eta), 1.0);
                continue;
            };
            let sine = |w: DVec3| (1.0 - w.z * w.z).max(0.0).sqrt();
            assert!((sine(wo) - eta * sine(wi)).abs() < 1e-12);
            assert!(wi.z < 0.0 && (wi.length() - 1.0).abs() < 1e-14);
            // Backwards, and with the same share reflected.
            let back = refract(wi, -DVec3::Z, 1.0 / eta).expect("a refracted ray can go back");
            assert!((back - wo).length() < 1e-12);
            assert!((dielectric_reflectance(wo.z, eta) - dielectric_reflectance(-wi.z, 1.0 / eta)).abs() < 1e-12);
        }
    }
}

/// A metal that does not absorb is a dielectric; at normal incidence ((n−1)² + k²)/((n+1)² + k²).
#[test]
fn metals_have_their_known_values() {
    for degrees in [0.0, 20.0, 56.3, 80.0, 89.9] {
        let cosine = at_degrees(degrees, 0.0).z;
        for eta in [1.2, 1.5, 4.0] {
            let metal = conductor_reflectance(cosine, Spectrum::grey(eta), Spectrum::BLACK).r();
            assert!((metal - dielectric_reflectance(cosine, eta)).abs() < 1e-12, "{degrees} {eta}: {metal}");
        }
    }
    let (eta, k) = (Spectrum::new(0.18, 0.42, 1.37), Spectrum::new(3.42, 2.35, 1.77));
    let squared = |color: Spectrum| color * color;
    let expected = (squared(eta - Spectrum::WHITE) + squared(k)) / (squared(eta + Spectrum::WHITE) + squared(k));
    assert!(conductor_reflectance(1.0, eta, k).distance(expected) < 1e-12);
    assert!(conductor_reflectance(0.0, eta, k).distance(Spectrum::WHITE) < 1e-12);
}

/// Aluminium of n = 1.1, k = 7 at 60°, worked out with complex numbers: |rs|² and |rp|² from Snell's law for n + ik.
#[test]
fn a_metal_agrees_with_complex_arithmetic() {
    let (n, k) = (1.1_f64, 7.0_f64);
    for degrees in [15.0_f64, 60.0, 86.0] {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        // (n + ik)·cosθt = √((n + ik)² − sin²θ) = a + ib.
        let (real, imaginary) = (n * n - k * k - sine * sine, 2.0 * n * k);
        let modulus = real.hypot(imaginary);
        let (a, b) = ((0.5 * (modulus + real)).sqrt(), (0.5 * (modulus - real)).sqrt());
        let perpendicular = ((cosine - a).powi(2) + b * b) / ((cosine + a).powi(2) + b * b);
        // rp = ((n + ik)²cosθ − (a + ib)) / ((n + ik)²cosθ + (a + ib))
        let (x, y) = ((n * n - k * k) * cosine, 2.0 * n * k * cosine);
        let parallel = ((x - a).powi(2) + (y - b).powi(2)) / ((x + a).powi(2) + (y + b).powi(2));
        let found = conductor_reflectance(cosine, Spectrum::grey(n), Spectrum::grey(k)).r();
        assert!((found - 0.5 * (perpendicular + parallel)).abs() < 1e-12, "{degrees}: {found}");
    }
}

#[test]
fn schlick_meets_both_ends() {
    let f0 = Spectrum::new(0.04, 0.5, 1.0);
    assert_eq!(schlick_reflectance(1.0, f0), f0);
    assert!(schlick_reflectance(0.0, f0).distance(Spectrum::WHITE) < 1e-15);
    assert!((normal_incidence_reflectance(1.5) - 0.04).abs() < 1e-15);
    // Half-way: 0.04 + 0.96/32.
    assert!((schlick_reflectance(0.5, f0).r() - 0.07).abs() < 1e-15);
}
