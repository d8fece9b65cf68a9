//! Samples follow the densities that are stated.

use rayon::prelude::*;

use super::*;
use crate::compare::sidak;
use crate::effort::in_full;
use crate::statistics::{DirectionalReport, SphereBins, density_by_differences, test_directional_sampler};

const TILTED: &str = "tilted";
/// From in front, at grazing angles, from behind.
const ANGLES: [f64; 4] = [8.0, 50.0, 84.0, 130.0];

fn non_delta_part(bsdf: &Bsdf, [u1, u2, u_lobe]: [f64; 3]) -> Option<DVec3> {
    let sample = bsdf.sample(u_lobe, u1, u2)?;
    matches!(sample.density, Density::SolidAngle(_)).then_some(sample.wi)
}

/// Bins about the mirror direction, fine close to it: that is where the narrow lobes are.
fn follow(bsdf: &Bsdf, seed: u64, samples: u64) -> DirectionalReport {
    let edges: Vec<f64> = (1..16).map(|i| 1.0 - 2.0 * (1.0 - f64::from(i) / 16.0).powi(2)).collect();
    let bins = SphereBins::with_cosine_edges(bsdf.view.mirrored(), &edges, 10);
    test_directional_sampler(&bins, samples, seed, |u| non_delta_part(bsdf, u), |wi| bsdf.evaluate(wi).pdf)
}

fn surfaces() -> Vec<(String, Bsdf)> {
    let single = non_delta_lobes().into_iter().map(|(name, lobe, _)| (name, vec![(lobe, 1.0)]));
    let mixtures =
        mixtures().into_iter().filter(|(name, _)| *name != "mirror and glass").map(|(name, lobes)| (name.to_owned(), lobes));
    let cases: Vec<_> = single.chain(mixtures).collect();
    let mut surfaces = Vec::new();
    for (name, lobes) in &cases {
        for degrees in ANGLES {
            surfaces.push((format!("{name} at {degrees}"), Bsdf::mixture(view(degrees, 0.0), lobes.clone())));
        }
        surfaces.push((format!("{name}, {TILTED}"), Bsdf::mixture(view(40.0, 25.0), lobes.clone())));
    }
    // Coats and fibres lie on the outside: from within, what is smooth below them has single directions alone.
    let all = surfaces.len();
    surfaces.retain(|(_, bsdf)| has_density(bsdf));
    let left_out = all - surfaces.len();
    assert!(left_out == 1 || asks_for_one(), "one example is smooth seen from behind, and rough from in front: {left_out}");
    surfaces
}

fn has_density(bsdf: &Bsdf) -> bool {
    cube_points(64, 9).any(|[u, v, _]| bsdf.evaluate(crate::reference::warp::uniform_sphere(u, v)).pdf > 0.0)
}

#[test]
fn samples_follow_their_densities() {
    let surfaces = surfaces();
    let level = sidak(0.01, surfaces.len());
    let most = if in_full("100,000 directions of every surface instead of 30,000") { 100_000 } else { 30_000 };
    surfaces.par_iter().for_each(|(name, bsdf)| {
        // By its name (FNV-1a), so that another surface changes the draws of none.
        let seed = name
            .bytes()
            .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
        // The density of a tilted lobe jumps where the horizon cuts it, and integrating it takes long.
        let samples = if name.ends_with(TILTED) { most / 5 } else { most };
        let report = follow(bsdf, seed & !0xffff_ffff, samples);
        assert!(report.passes(level), "{name}: {report:?}");
        assert!(report.chi_squared.degrees_of_freedom > 10, "{name}: {report:?}");
    });
}

/// With more samples, at one angle of each.
#[test]
#[ignore = "long: a million directions of every lobe"]
fn long_many_samples_follow_their_densities() {
    let cases = non_delta_lobes();
    let level = sidak(0.01, cases.len());
    cases.into_par_iter().enumerate().for_each(|(index, (name, lobe, _))| {
        let report = follow(&single(lobe, view(35.0, 0.0)), (100 + index as u64) << 32, 1_000_000);
        assert!(report.passes(level), "{name}: {report:?}");
    });
}

/// A density that leans by a hundredth to one side is found out, for a lobe and for a mixture.
#[test]
fn wrong_densities_are_rejected() {
    for lobes in [vec![(diffuse(orange()), 1.0)], vec![(diffuse(orange()), 0.5), (mirror(1.0), 0.5)]] {
        let bsdf = Bsdf::mixture(view(35.0, 0.0), lobes);
        let bins = SphereBins::uniform(DVec3::Z, 16, 12);
        let leaning = |wi: DVec3| (1.0 + 0.02 * wi.x.signum()) * bsdf.evaluate(wi).pdf;
        let report = test_directional_sampler(&bins, 1_000_000, 0, |u| non_delta_part(&bsdf, u), leaning);
        assert!(!report.passes(1e-6), "{report:?}");
    }
}

/// Lobes that draw directions by one map of (u1, u2) each. With one tint black, glass only reflects or only transmits.
fn maps() -> Vec<(&'static str, Lobe, f64)> {
    let only = |reflect: bool| {
        let (on, off) = (Spectrum::WHITE, Spectrum::BLACK);
        let (reflectance, transmittance) = if reflect { (on, off) } else { (off, on) };
        move |ior| Dielectric { ior, reflectance, transmittance }
    };
    vec![
        ("diffuse", diffuse(orange()), 30.0),
        ("glossy", glossy(30.0), 30.0),
        ("phong, specular alone", phong(0.0, 0.9, 20.0), 20.0),
        ("phong, diffuse alone", phong(0.9, 0.0, 20.0), 60.0),
        ("gold", gold(0.3), 45.0),
        ("gold, wide", gold(0.9), 70.0),
        ("gold, narrow", gold(0.01), 20.0),
        ("reflection of rough glass", rough_glass(only(true)(1.5), 0.4), 50.0),
        ("transmission of rough glass, entering", rough_glass(only(false)(1.5), 0.4), 50.0),
        ("transmission of rough glass, leaving", rough_glass(only(false)(1.5), 0.3), 155.0),
        ("transmission of rough glass, narrow", rough_glass(only(false)(1.5), 0.01), 20.0),
        ("reflection of Phong glass", phong_glass(only(true)(1.5), 30.0), 30.0),
        ("transmission of Phong glass", phong_glass(only(false)(1.5), 30.0), 30.0),
    ]
}

#[test]
fn maps_have_the_jacobian_of_their_density() {
    for (name, lobe, degrees) in maps() {
        let bsdf = single(lobe, view(degrees, 0.0));
        let map = |[u1, u2]: [f64; 2]| bsdf.sample(0.5, u1, u2).map_or(DVec3::NAN, |sample| sample.wi);
        let mut compared = 0;
        for (i, j) in (0..16).flat_map(|i| (0..16).map(move |j| (i, j))) {
            let u = [(f64::from(i) + 0.5) / 16.0, (f64::from(j) + 0.5) / 16.0];
            let by_differences = density_by_differences(map, u);
            // Beside the horizon a neighbour may be missing.
            if by_differences.is_nan() {
                continue;
            }
            compared += 1;
            let stated = bsdf.evaluate(map(u)).pdf;
            assert!((stated / by_differences - 1.0).abs() < 1e-4, "{name} at {u:?}: {stated}, {by_differences}");
            assert!((1.01 * stated / by_differences - 1.0).abs() > 1e-3);
        }
        assert!(compared > 150, "{name}: {compared}");
    }
}

/// A sample states the value and the density that evaluating its direction gives.
#[test]
fn sampled_weights_are_value_over_density() {
    for (name, bsdf) in surfaces() {
        let mut compared = 0;
        for [u1, u2, u_lobe] in cube_points(500, 3) {
            let Some(sample) = bsdf.sample(u_lobe, u1, u2) else { continue };
            let Density::SolidAngle(pdf) = sample.density else { continue };
            let Evaluation { value, pdf: evaluated } = bsdf.evaluate(sample.wi);
            compared += 1;
            assert!((pdf / evaluated - 1.0).abs() < 1e-7, "{name}: {sample:?} {evaluated}");
            assert!(
                sample.weight.distance(value / pdf) <= 1e-7 * sample.weight.to_vector().length(),
                "{name}: {sample:?} {value}"
            );
            assert!((sample.wi.length() - 1.0).abs() < 1e-12, "{name}: {sample:?}");
        }
        assert!(compared > 20, "{name}: {compared}");
    }
}

/// The density of a mixture is the mean of its non-delta lobes' by Pᵢ ∝ wᵢ·sᵢ, its value their sum by wᵢ.
#[test]
fn mixtures_are_the_sums_of_their_lobes() {
    for (name, lobes) in mixtures() {
        for degrees in ANGLES {
            let view = view(degrees, 10.0);
            let mixture = Bsdf::mixture(view, lobes.clone());
            // The diffuse lobes are one lobe, whose weight is the largest component of their sum.
            let together: Spectrum = lobes
                .iter()
                .map(|(lobe, weight)| if let Lobe::Diffuse(d) = lobe { d.reflectance * *weight } else { Spectrum::BLACK })
                .sum();
            let share = |lobe: &Lobe, weight: f64| match lobe {
                Lobe::Diffuse(_) => 0.0,
                _ => weight * lobe.sampling_weight(),
            };
            let total = together.max_component() + lobes.iter().map(|(lobe, weight)| share(lobe, *weight)).sum::<f64>();
            for [u, v, _] in cube_points(200, 5) {
                let wi = crate::reference::warp::uniform_sphere(u, v);
                let mut expected = Evaluation::default();
                for (lobe, weight) in &lobes {
                    let one = lobe.evaluate(&view, wi);
                    expected.value += one.value * *weight;
                    expected.pdf += one.pdf * share(lobe, *weight) / total;
                }
                expected.pdf += diffuse(Spectrum::WHITE).evaluate(&view, wi).pdf * together.max_component() / total;
                let found = mixture.evaluate(wi);
                assert!(found.value.distance(expected.value) <= 1e-12 * expected.value.to_vector().length(), "{name}");
                assert!((found.pdf - expected.pdf).abs() <= 1e-12 * expected.pdf, "{name}: {found:?} {expected:?}");
            }
        }
    }
}

/// Cosine-power lobes drawn over the hemisphere, and those whose directions below the surface are flipped, follow densities of their own.
#[test]
fn cosine_power_lobes_follow_the_density_of_their_study() {
    let lost = PhongStudy::default();
    let flipped = PhongStudy { horizon: PhongHorizon::Flipped, ..lost };
    let by_hemisphere = PhongStudy { sampling: PhongSampling::Hemisphere, ..flipped };
    let mut seeds = 21_u64..;
    for lobe in [glossy(4.0), phong(0.3, 0.5, 12.0)] {
        for (study, hemisphere) in [
            (flipped, HemisphereSampling::Cosine),
            (by_hemisphere, HemisphereSampling::Cosine),
            (by_hemisphere, HemisphereSampling::Uniform),
        ] {
            for tilt in [0.0, 25.0] {
                let plain = single(lobe, view(75.0, tilt));
                let studied = single(lobe, view(75.0, tilt).with_phong(study).with_hemisphere(hemisphere));
                let seed = seeds.next().expect("there are more seeds") << 32;
                let samples = if tilt == 0.0 { 200_000 } else { 20_000 };
                let report = follow(&studied, seed, samples);
                assert!(report.passes(sidak(0.01, 12)), "{study:?} {hemisphere:?} {tilt}: {report:?}");
                if tilt == 0.0 {
                    let bins = SphereBins::with_cosine_edges(plain.view.normal(), &[0.2, 0.4, 0.6, 0.8], 4);
                    let mixed_up = test_directional_sampler(
                        &bins,
                        samples,
                        seed,
                        |u| non_delta_part(&studied, u),
                        |wi| plain.evaluate(wi).pdf,
                    );
                    assert!(!mixed_up.passes(1e-6), "{study:?} {hemisphere:?}: {mixed_up:?}");
                }
            }
        }
    }
}

/// By hand: a flipped lobe without its cosine sends on ρ(n+2)/(n+1) from wherever it is seen, and each sample is worth as much. What is lost below the
/// horizon darkens it, and so does the cosine.
#[test]
fn what_a_flipped_lobe_without_its_cosine_sends_on_is_known() {
    let dropped = PhongStudy { cosine: PhongCosine::Dropped, ..PhongStudy::default() };
    let whole = PhongStudy { horizon: PhongHorizon::Flipped, ..dropped };
    for exponent in [0.0, 1.0, 10.0, 300.0] {
        for degrees in [5.0, 60.0, 85.0] {
            let expected = Spectrum::new(0.4, 0.9, 0.6) * ((exponent + 2.0) / (exponent + 1.0));
            let mean = |study: PhongStudy| {
                let bsdf = single(glossy(exponent), view(degrees, 0.0).with_phong(study));
                let weights: Vec<Spectrum> = cube_points(4000, 11)
                    .map(|[u, v, w]| bsdf.sample(w, u, v).map_or(Spectrum::BLACK, |sample| sample.weight))
                    .collect();
                (weights.iter().copied().sum::<Spectrum>() / weights.len() as f64, weights)
            };
            let (albedo, weights) = mean(whole);
            assert!(weights.iter().all(|weight| weight.distance(expected) < 1e-9), "{exponent}, {degrees}");
            assert!(albedo.distance(expected) < 1e-9);
            assert!(
                mean(PhongStudy { horizon: PhongHorizon::Flipped, ..PhongStudy::default() }).0.max_component()
                    < 0.999 * albedo.max_component()
            );
            if degrees > 80.0 {
                assert!(mean(dropped).0.max_component() < 0.97 * albedo.max_component(), "{exponent}");
            }
        }
    }
}

/// Diffuse lobes over the uniform hemisphere: samples follow the other density, and their mean weight is the same reflectance.
#[test]
fn uniform_hemispheres_have_their_own_density_and_the_same_reflectance() {
    for (seed, (lobe, tilt)) in (7_u64..).zip([(diffuse(orange()), 0.0), (diffuse(orange()), 25.0), (phong(0.6, 0.3, 5.0), 0.0)])
    {
        let cosine = single(lobe, view(35.0, tilt));
        let uniform = single(lobe, view(35.0, tilt).with_hemisphere(HemisphereSampling::Uniform));
        let report = follow(&uniform, seed << 32, 200_000);
        assert!(report.passes(sidak(0.01, 3)), "{report:?}");
        // Samples of the one do not follow the density of the other.
        let bins = SphereBins::with_cosine_edges(cosine.view.normal(), &[0.2, 0.4, 0.6, 0.8], 4);
        let mixed_up =
            test_directional_sampler(&bins, 200_000, seed, |u| non_delta_part(&uniform, u), |wi| cosine.evaluate(wi).pdf);
        assert!(!mixed_up.passes(1e-6), "{mixed_up:?}");
        let side = 128;
        let mean = |bsdf: &Bsdf| {
            let at = |i: u32| (f64::from(i) + 0.5) / f64::from(side);
            let grid =
                (0..side * side * 8).map(|i| (at(i % side), at(i / side % side), (f64::from(i / (side * side)) + 0.5) / 8.0));
            let weights = grid.filter_map(|(u1, u2, lobe)| bsdf.sample(lobe, u1, u2)).map(|sample| sample.weight);
            weights.sum::<Spectrum>() / f64::from(side * side * 8)
        };
        let (a, b) = (mean(&cosine), mean(&uniform));
        assert!((a - b).map(f64::abs).max_component() < 0.02 * a.max_component(), "{a} {b}");
    }
}
