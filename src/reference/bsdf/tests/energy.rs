//! How much of the light comes back, and whether light could go the other way.

use super::*;
use crate::compare::{Moments, TestResult, one_sample_t_test_beyond, sidak, welch_t_test};
use crate::scene::LobeSupport;

/// Independent estimates of the radiance that a uniform environment of 1 leaves towards wo.
fn reflected_radiance(bsdf: &Bsdf, seed: u64) -> [Moments; 3] {
    estimate(seed, |[u1, u2, u_lobe]| bsdf.sample(u_lobe, u1, u2).map_or(Spectrum::BLACK, |sample| sample.weight))
}

/// The share of power that a single material scatters: its mean weight with refraction's scaling of radiance,
/// 1/eta², made good.
fn albedo(bsdf: &Bsdf, seed: u64) -> [Moments; 3] {
    estimate(seed, |[u1, u2, u_lobe]| bsdf.sample(u_lobe, u1, u2).map_or(Spectrum::BLACK, |s| s.weight * s.eta * s.eta))
}

fn estimate(seed: u64, weight: impl Fn([f64; 3]) -> Spectrum) -> [Moments; 3] {
    let mut moments = [Moments::default(); 3];
    for replication in 0..16 {
        let count = 4096;
        let mean = cube_points(count, seed * 16 + replication).map(&weight).sum::<Spectrum>() / f64::from(count);
        moments.iter_mut().zip(mean.to_rgb()).for_each(|(moments, value)| moments.push(value));
    }
    moments
}

const ANGLES: [f64; 6] = [0.0, 30.0, 60.0, 85.0, 100.0, 160.0];

#[test]
fn no_lobe_makes_energy() {
    for (seed, (name, lobe, _)) in (0..).zip(non_delta_lobes().into_iter().chain(delta_lobes())) {
        for degrees in ANGLES {
            for channel in albedo(&single(lobe, view(degrees, 0.0)), seed) {
                assert!(channel.mean() <= 1.0 + 5.0 * channel.standard_error() + 1e-9, "{name} at {degrees}: {channel:?}");
            }
        }
    }
}

/// Lobes whose albedo is known: Lambert's, and those of single directions.
#[test]
fn known_albedos() {
    for degrees in ANGLES {
        let view = view(degrees, 0.0);
        let eta = if view.front { 1.5 } else { 1.0 / 1.5 };
        let fresnel = dielectric_reflectance(view.wo.z.abs(), eta);
        let boundary = tinted(1.5);
        let gold_reflects = {
            let Lobe::Conductor(Conductor { fresnel, .. }) = gold(0.0) else { panic!("gold is a conductor") };
            fresnel.at(view.wo.z.abs())
        };
        let cases = [
            (diffuse(orange()), orange()),
            (mirror(0.8), Spectrum::grey(0.8)),
            (glass(boundary), boundary.reflectance * fresnel + boundary.transmittance * (1.0 - fresnel)),
            (gold(0.0), gold_reflects),
            (Lobe::Null(Null), Spectrum::WHITE),
            (thin_glass(boundary), {
                // F + TFT + TFFFT + …, light going to and fro.
                let once = dielectric_reflectance(view.wo.z.abs(), 1.5);
                let reflected = 2.0 * once / (1.0 + once);
                boundary.reflectance * reflected + boundary.transmittance * (1.0 - reflected)
            }),
        ];
        for (seed, (lobe, expected)) in (50..).zip(cases) {
            assert_albedo(&single(lobe, view), seed, expected, 6 * ANGLES.len());
        }
    }
}

fn assert_albedo(bsdf: &Bsdf, seed: u64, expected: Spectrum, tests: usize) {
    let level = sidak(0.01, 3 * tests);
    for (moments, expected) in albedo(bsdf, seed).iter().zip(expected.to_rgb()) {
        let rejects = |truth: f64| one_sample_t_test_beyond(moments, truth, 1e-5).p_value < level;
        assert!(!rejects(expected), "{bsdf:?}: {moments:?}, expected {expected}");
        assert!(expected < 0.05 || rejects(1.01 * expected), "1 % more would pass: {bsdf:?} {moments:?}");
    }
}

/// A mixture reflects Σ wᵢ of what its lobes do, whatever their kinds and however one is chosen.
#[test]
fn mixtures_reflect_the_mean() {
    let cases = mixtures();
    let level = sidak(0.01, 3 * ANGLES.len() * cases.len());
    for (seed, (name, lobes)) in (100..).zip(cases) {
        for degrees in ANGLES {
            let view = view(degrees, 0.0);
            let mixed = reflected_radiance(&Bsdf::mixture(view, lobes.clone()), seed);
            let part = |(seed, &(lobe, weight)): (u64, &(Lobe, f64))| (reflected_radiance(&single(lobe, view), seed), weight);
            let parts: Vec<_> = (1000 + 50 * seed..).zip(&lobes).map(part).collect();
            for channel in 0..3 {
                let expected: f64 = parts.iter().map(|(moments, weight)| moments[channel].mean() * weight).sum();
                let variances = parts.iter().map(|(moments, weight)| (moments[channel].standard_error() * weight).powi(2));
                let error = (variances.sum::<f64>() + mixed[channel].standard_error().powi(2)).sqrt();
                let against = |expected: f64| TestResult::beyond_margin(mixed[channel].mean() - expected, 1e-5, error, 15.0);
                assert!(against(expected).p_value >= level, "{name} at {degrees}: {:?} {expected}", mixed[channel]);
                assert!(against(1.02 * expected).p_value < level, "{name} at {degrees}: 2 % more would pass");
            }
        }
    }
}

/// f(wo, wi) = f(wi, wo); through a dielectric f(wo, wi)·n(wi)² = f(wi, wo)·n(wo)² (Veach 1997, section 5.2.3). Honsdorf's
/// perturbed refraction has no such symmetry.
#[test]
fn scattering_is_reciprocal() {
    // Nor has the coat of the principled material, which shades what lies below by wo's angle alone.
    let is_reciprocal = |lobe: &Lobe| match lobe {
        // Nor has what is made good by wo's angle alone.
        Lobe::Principled(principled) => principled.layers.coat == 0.0 && !principled.layers.compensates,
        _ => lobe.kind() != LobeKind::PhongGlass,
    };
    for (name, lobe, ior) in non_delta_lobes().into_iter().filter(|(_, lobe, _)| is_reciprocal(lobe)) {
        let (mut reflected, mut transmitted) = (0, 0);
        for [a, b, c] in cube_points(3000, 11) {
            let wo = crate::reference::warp::uniform_sphere(a, b);
            let wi = crate::reference::warp::uniform_sphere(c, (a * 7.0 + b * 5.0).fract());
            let f = |wo: DVec3, wi: DVec3| lobe.evaluate(&View::new(wo, DVec3::Z, DVec3::Z), wi).value / wi.z.abs();
            let (there, back) = (f(wo, wi), f(wi, wo));
            let through = wo.z * wi.z < 0.0;
            let iors = match lobe {
                Lobe::RoughSpectralGlass(glass) => glass.dielectric.iors,
                Lobe::Principled(principled) => principled.iors.unwrap_or(Spectrum::grey(ior)),
                _ => Spectrum::grey(ior),
            };
            let index = |w: DVec3| if w.z > 0.0 { Spectrum::WHITE } else { iors };
            let difference = there / (index(wo) * index(wo)) - back / (index(wi) * index(wi));
            assert!(difference.to_vector().length() <= 1e-9 * there.to_vector().length(), "{name}: {wo} {wi}: {there} {back}");
            if !there.is_black() {
                *(if through { &mut transmitted } else { &mut reflected }) += 1;
            }
        }
        assert!(reflected > 500, "{name}: {reflected}");
        let transmits = match lobe {
            Lobe::Principled(principled) => principled.layers.transmission > 0.0 || principled.layers.diffuse_transmission > 0.0,
            _ => lobe.kind().support() == LobeSupport::Sphere,
        };
        assert_eq!(transmitted > 100, transmits, "{name}: {transmitted}");
    }
}

/// The directional albedo of white GGX microfacets, by alpha and at these angles in degrees: what is missing to 1 would have met a
/// second microfacet, and single scattering leaves it out. At alpha 1 and normal incidence it is 1 − ln 2.
const WHITE_ALBEDO_ANGLES: [f64; 4] = [0.0, 45.0, 70.0, 85.0];
const WHITE_ALBEDO: [(f64, [f64; 4]); 5] = [
    (0.05, [0.997, 0.996, 0.985, 0.902]),
    (0.25, [0.916, 0.886, 0.839, 0.901]),
    (0.5, [0.688, 0.683, 0.731, 0.872]),
    (0.75, [0.464, 0.510, 0.628, 0.827]),
    (1.0, [1.0 - std::f64::consts::LN_2, 0.377, 0.532, 0.780]),
];

#[test]
fn energy_lost_between_microfacets_is_as_documented() {
    let level = sidak(0.01, 20);
    for (alpha, documented) in WHITE_ALBEDO {
        for (degrees, documented) in WHITE_ALBEDO_ANGLES.into_iter().zip(documented) {
            let measured = albedo(&single(white_metal(alpha), view(degrees, 0.0)), 9)[0];
            println!("alpha {alpha} at {degrees}°: {:.4} ± {:.1e}", measured.mean(), measured.standard_error());
            // Documented to three digits.
            let rejects = |truth: f64| one_sample_t_test_beyond(&measured, truth, 6e-4).p_value < level;
            assert!(!rejects(documented), "alpha {alpha} at {degrees}: {measured:?}, documented {documented}");
            assert!(rejects(1.01 * documented), "alpha {alpha} at {degrees}: 1 % more would pass: {measured:?}");
        }
    }
    let closed = albedo(&single(white_metal(1.0), view(0.0, 0.0)), 10)[0];
    assert!(one_sample_t_test_beyond(&closed, 1.0 - std::f64::consts::LN_2, 1e-5).p_value > 0.001, "{closed:?}");
}

/// White metal of any roughness and masking, under a uniform light: with compensation nothing is missing.
#[test]
fn compensated_metal_keeps_all_light() {
    let angles = [0.0, 40.0, 70.0, 87.0, 89.0, 89.9, 89.97];
    let white = |roughness: f64, masking: &str, compensates: bool| {
        principled(&format!("roughness = {roughness}\nmasking = \"{masking}\"\nenergy_compensation = {compensates}"))
    };
    let mut worst = 0.0_f64;
    for masking in ["separable", "height_correlated"] {
        for roughness in [0.011, 0.04, 0.1, 0.23, 0.3, 0.35, 0.5, 0.7, 1.0] {
            for degrees in angles {
                let reflected = albedo(&single(white(roughness, masking, true), view(degrees, 0.0)), 70)[0];
                let off = (reflected.mean() - 1.0).abs() - 4.0 * reflected.standard_error();
                worst = worst.max(off);
                assert!(off < 2e-3, "{masking}, roughness {roughness} at {degrees}: {reflected:?}");
            }
        }
    }
    println!("off by {worst:.1e} beyond noise");
    // The control: without it, roughness 0.5 loses more than that.
    let plain = albedo(&single(white(0.5, "separable", false), view(30.0, 0.0)), 71)[0];
    assert!(plain.mean() < 0.95, "{plain:?}");
}

/// Under a uniform light fibres reflect what the table says, and all of white cloth never more than arrives.
#[test]
fn sheen_takes_what_it_reflects() {
    for roughness in [0.1, 0.3, 0.6, 1.0] {
        for degrees in [0.0, 40.0, 70.0, 85.0] {
            let keys = format!(
                "base_color = 0\nmetallic = 1\nspecular = 0\nroughness = 0\nsheen_color = 1\nsheen_roughness = {roughness}"
            );
            let fibres = principled(&keys);
            // Black metal reflects Schlick's share at grazing angles, as far as the fibres leave it.
            let Lobe::Principled(parts) = fibres else { panic!("it is principled") };
            let view = view(degrees, 0.0);
            let taken = parts.layers.sheen.taken(view.wo.z);
            let expected = taken + (1.0 - taken) * (1.0 - view.wo.z).powi(5);
            let measured = albedo(&single(fibres, view), 72)[0];
            let off = (measured.mean() - expected).abs() - 5.0 * measured.standard_error();
            // Narrow fibres reflect less, where not more than arrives is to come back.
            let is_as_expected = off < 4e-3 || roughness < 0.2 && measured.mean() < expected;
            assert!(is_as_expected, "roughness {roughness} at {degrees}: {measured:?}, expected {expected}");
            let cloth = principled(&format!(
                "base_color = 1\nmetallic = 0\nspecular = 0\nsheen_color = 1\nsheen_roughness = {roughness}"
            ));
            let all = albedo(&single(cloth, view), 73)[0];
            assert!(all.mean() <= 1.0 + 5.0 * all.standard_error() + 1e-3, "roughness {roughness} at {degrees}: {all:?}");
            assert!(all.mean() >= 0.75, "roughness {roughness} at {degrees}: {all:?}");
        }
    }
}

/// Rough metal and rough glass become the smooth ones as the width goes to 0: the same shares, in the same directions.
#[test]
fn narrow_lobes_meet_the_delta_lobes() {
    let pairs = [(gold(2e-4), gold(0.0)), (rough_glass(tinted(1.5), 2e-4), glass(tinted(1.5)))];
    for (rough, smooth) in pairs {
        for degrees in [5.0, 50.0, 75.0, 155.0] {
            let view = view(degrees, 0.0);
            let [rough, smooth] = [rough, smooth].map(|lobe| single(lobe, view));
            for [u1, u2, u_lobe] in cube_points(2000, 4) {
                let (a, b) = (rough.sample(u_lobe, u1, u2), smooth.sample(u_lobe, u1, u2));
                // The few samples on the border between reflection and transmission, or in the distribution's long tail, may differ.
                let (Some(a), Some(b)) = (a, b) else { continue };
                if (a.wi - b.wi).length() < 0.05 {
                    assert!(a.weight.distance(b.weight) < 0.02 * b.weight.to_vector().length(), "{a:?} {b:?}");
                }
            }
            let [a, b] = [albedo(&rough, 2), albedo(&smooth, 3)];
            for (a, b) in a.iter().zip(&b) {
                let difference = welch_t_test(a, b);
                assert!((a.mean() - b.mean()).abs() < 1e-3 || difference.p_value > 1e-4, "{a:?} {b:?}");
            }
            let near = |bsdf: &Bsdf| {
                let mean: DVec3 =
                    cube_points(4000, 6).filter_map(|[u1, u2, u]| bsdf.sample(0.5 * u, u1, u2)).map(|sample| sample.wi).sum();
                mean.normalize()
            };
            assert!(near(&rough).angle_between(near(&smooth)) < 0.02, "{:?}", (near(&rough), near(&smooth)));
        }
    }
}
