use std::f64::consts::PI;

use super::diffuse::Diffuse;
use super::glass::Dielectric;
use super::lobe::Lobe;
use super::mirror::Mirror;
use super::*;
use crate::reference::warp;
use crate::statistics::{SphereBins, sidak, test_directional_sampler, worst_jacobian_deviation};

/// A unit vector at an angle from +z, in degrees.
fn at_degrees(theta: f64, phi: f64) -> DVec3 {
    let (sin_theta, cos_theta) = theta.to_radians().sin_cos();
    DVec3::new(sin_theta * phi.cos(), sin_theta * phi.sin(), cos_theta)
}

/// A surface with normal +z and shading normal tilted from it, seen at an angle.
fn bsdf(lobe: Lobe, wo_degrees: f64, tilt_degrees: f64) -> Bsdf {
    let view = View::new(at_degrees(wo_degrees, 0.4), DVec3::Z, at_degrees(tilt_degrees, 2.0));
    Bsdf::mixture(view, [(lobe, 1.0)])
}

fn diffuse() -> Lobe {
    Lobe::Diffuse(Diffuse { reflectance: DVec3::new(0.9, 0.5, 0.1) })
}

fn glass(ior: f64) -> Dielectric {
    Dielectric { ior, reflectance: DVec3::ONE, transmittance: DVec3::ONE }
}

const SMOOTH: [fn() -> Lobe; 1] = [diffuse];
const TILTS: [f64; 2] = [0.0, 25.0];

fn smooth_bsdfs() -> Vec<Bsdf> {
    let mut all = Vec::new();
    for lobe in SMOOTH {
        for tilt in TILTS {
            all.extend([0.0, 35.0, 70.0, 88.0, 125.0, 180.0].map(|wo| bsdf(lobe(), wo, tilt)));
        }
    }
    all
}

fn sample(bsdf: &Bsdf, [u1, u2, u_lobe]: [f64; 3]) -> Option<DVec3> {
    bsdf.sample(u_lobe, u1, u2).map(|sample| sample.wi)
}

#[test]
fn smooth_lobes_follow_their_densities() {
    let bsdfs = smooth_bsdfs();
    let level = sidak(0.01, bsdfs.len());
    for (seed, bsdf) in (0..).zip(&bsdfs) {
        // The horizon cuts a tilted lobe at the geometric normal's equator.
        let bins = SphereBins::uniform(bsdf.view.geometric_normal, 16, 12);
        let tilted = bsdf.view.normal() != bsdf.view.geometric_normal;
        let samples = if tilted { 100_000 } else { 1_000_000 };
        let report = test_directional_sampler(&bins, samples, seed, |u| sample(bsdf, u), |wi| bsdf.evaluate(wi).pdf);
        assert!(report.passes(level), "{bsdf:?}: {report:?}");
        assert!(tilted == (report.declined > 0), "{bsdf:?}: {report:?}");
    }
}

/// A density that leans by a hundredth to one side is found out.
#[test]
fn a_wrong_density_is_rejected() {
    let bsdf = bsdf(diffuse(), 35.0, 0.0);
    let bins = SphereBins::uniform(DVec3::Z, 16, 12);
    let leaning = |wi: DVec3| (1.0 + 0.01 * wi.x.signum()) * bsdf.evaluate(wi).pdf;
    let report = test_directional_sampler(&bins, 1_000_000, 0, |u| sample(&bsdf, u), leaning);
    assert!((report.integral.value - 1.0).abs() < 1e-6 && !report.passes(1e-6), "{report:?}");
}

#[test]
fn smooth_lobes_have_the_jacobian_of_their_density() {
    for bsdf in smooth_bsdfs().iter().filter(|bsdf| bsdf.view.normal() == bsdf.view.geometric_normal) {
        let map = |[u1, u2]: [f64; 2]| bsdf.sample(0.5, u1, u2).map_or(DVec3::NAN, |sample| sample.wi);
        let worst = worst_jacobian_deviation(map, |wi| bsdf.evaluate(wi).pdf, 16);
        assert!(worst.relative < 1e-4, "{bsdf:?}: {worst:?}");
    }
}

#[test]
fn sampled_weights_are_value_over_density() {
    for bsdf in smooth_bsdfs() {
        for i in 0..64 {
            let (u1, u2) = (f64::from(i) / 64.0, f64::from(i * 29 % 64) / 64.0);
            let Some(sample) = bsdf.sample(0.5, u1, u2) else { continue };
            let evaluation = bsdf.evaluate(sample.wi);
            let Density::Smooth(pdf) = sample.density else { panic!("{sample:?}") };
            assert!((pdf / evaluation.pdf - 1.0).abs() < 1e-9, "{sample:?} {evaluation:?}");
            assert!((sample.weight - evaluation.value / pdf).length() < 1e-9, "{sample:?} {evaluation:?}");
        }
    }
}

/// f(wo, wi) = f(wi, wo), and the reflected share of a uniform light is the albedo.
#[test]
fn lambert_is_reciprocal_and_reflects_its_albedo() {
    let (a, b) = (at_degrees(20.0, 0.3), at_degrees(75.0, 4.0));
    let f = |wo: DVec3, wi: DVec3| {
        let bsdf = Bsdf::mixture(View::new(wo, DVec3::Z, DVec3::Z), [(diffuse(), 1.0)]);
        bsdf.evaluate(wi).value / wi.z.abs()
    };
    assert!((f(a, b) - f(b, a)).length() < 1e-15);
    let bsdf = bsdf(diffuse(), 50.0, 0.0);
    let n = 512;
    let cell = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
    let sum: DVec3 = (0..n)
        .flat_map(|i| (0..n).map(move |j| (cell(i), cell(j))))
        .map(|(u, v)| bsdf.evaluate(warp::uniform_hemisphere(u, v)).value)
        .sum();
    let albedo = sum * (2.0 * PI) / f64::from(n * n);
    assert!((albedo - DVec3::new(0.9, 0.5, 0.1)).length() < 1e-5, "{albedo}");
}

#[test]
fn nothing_is_reflected_through_the_surface() {
    for bsdf in smooth_bsdfs() {
        for (theta, phi) in (0..18).flat_map(|i| (0..8).map(move |j| (f64::from(i) * 10.0 + 1.0, f64::from(j)))) {
            let wi = at_degrees(theta, phi);
            let above = wi.dot(bsdf.view.geometric_normal) > 0.0 && wi.dot(bsdf.view.normal()) > 0.0;
            let evaluation = bsdf.evaluate(wi);
            assert_eq!(evaluation.pdf > 0.0, above);
            assert_eq!(evaluation.value != DVec3::ZERO, above);
        }
    }
}

#[test]
fn normals_face_the_viewer() {
    for wo_degrees in [10.0, 89.0, 91.0, 170.0] {
        for tilt in [-60.0, 0.0, 60.0, 120.0] {
            let view = View::new(at_degrees(wo_degrees, 0.0), DVec3::Z, at_degrees(tilt, 0.0));
            assert_eq!(view.front, wo_degrees < 90.0);
            assert!(view.wo.dot(view.geometric_normal) > 0.0);
            assert!(view.wo.dot(view.normal()) > 0.0);
            assert!(view.normal().dot(view.geometric_normal) > 0.0);
        }
    }
}

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

/// Reflected and transmitted power sum to 1 for clear glass and to the tints for tinted glass.
#[test]
fn glass_keeps_the_energy() {
    let tinted = Dielectric { ior: 1.5, reflectance: DVec3::new(0.9, 0.2, 0.0), transmittance: DVec3::new(0.1, 0.8, 0.5) };
    for glass in [glass(1.5), glass(0.7), tinted] {
        for degrees in [0.0, 30.0, 41.7, 41.9, 60.0, 85.0, 100.0, 139.0, 150.0, 180.0] {
            let bsdf = bsdf(Lobe::Glass(glass), degrees, 0.0);
            let eta = if degrees < 90.0 { glass.ior } else { 1.0 / glass.ior };
            let fresnel = dielectric_reflectance(bsdf.view.wo.z.abs(), eta);
            // The lobe is chosen by one number, so a fine grid of it gives the mean.
            let n = 20_000;
            let mean: DVec3 = (0..n)
                .filter_map(|i| bsdf.sample((f64::from(i) + 0.5) / f64::from(n), 0.0, 0.0))
                .map(|sample| sample.weight * sample.eta * sample.eta)
                .sum::<DVec3>()
                / f64::from(n);
            let expected = glass.reflectance * fresnel + glass.transmittance * (1.0 - fresnel);
            assert!((mean - expected).length() < 1e-3, "{glass:?} at {degrees}: {mean} {expected}");
        }
    }
}

#[test]
fn delta_lobes_take_no_part_in_light_sampling() {
    for lobe in [Lobe::Mirror(Mirror { reflectance: DVec3::ONE }), Lobe::Glass(glass(1.5))] {
        let bsdf = bsdf(lobe, 30.0, 0.0);
        let sample = bsdf.sample(0.01, 0.3, 0.7).expect("a delta lobe has a direction");
        assert_eq!(sample.density, Density::Delta);
        assert!((sample.wi - at_degrees(30.0, 0.4 + PI)).length() < 1e-12);
        assert_eq!(bsdf.evaluate(sample.wi), Evaluation::default());
        assert!(!bsdf.has_smooth_lobe());
    }
}
