//! Layers by adding and doubling against published tables, Chandrasekhar's half space, light scattered once, a random walk, and the balance of energy.

use crate::common::media::airlight::{Medium, reflected_by_layer, transmitted_by_layer};
use crate::common::media::half_space::HalfSpace;
use crate::common::media::phase::Phase;
use crate::common::media::slab::{Layer, Solution};
use crate::common::media::{fresnel, quadrature, walk};
use crate::statistics::random::SplitMix64;

fn layer(albedo: f64, thickness: f64, phase: Phase, index: f64) -> Layer {
    Layer { albedo, thickness, phase, index }
}

/// The bound for numbers that are printed with so many digits: one unit of the last one.
fn printed(digits: i32) -> f64 {
    10f64.powi(-digits)
}

#[test]
fn published_tables() {
    let hg = Phase::HenyeyGreenstein;
    // Albedo, thickness, g, index, digits; then the parts of light along the normal that are reflected and transmitted, and those of diffuse light.
    let cases = [
        // Van de Hulst 1980, as Prahl's programs are tested by them.
        (0.9, 2.0, 0.75, 1.0, 5, [Some(0.09739), Some(0.66096), None, None]),
        (0.8, 1.0, 0.0, 1.0, 5, [Some(0.21085), Some(0.54140), Some(0.28015), Some(0.41624)]),
        (0.8, 1.0, 0.8, 1.0, 5, [Some(0.03041), Some(0.76388), Some(0.08416), Some(0.61111)]),
        (0.8, f64::INFINITY, 0.0, 1.0, 5, [Some(0.28525), Some(0.0), Some(0.34187), Some(0.0)]),
        // Giovanelli 1955, whose last digit was found by hand.
        (0.9, f64::INFINITY, 0.0, 1.5, 4, [Some(0.2600), Some(0.0), None, None]),
    ];
    for (albedo, thickness, g, index, digits, expected) in cases {
        let count = if g == 0.0 { 18 } else { 40 };
        let solution = Solution::new(&layer(albedo, thickness, hg(g), index), count, 1, &[1.0]);
        let (along, diffuse) = (solution.parts(1.0), solution.parts_of_diffuse_light());
        let found = [along.reflected, along.transmitted, diffuse.reflected, diffuse.transmitted];
        for (found, expected) in found.into_iter().zip(expected) {
            let Some(expected) = expected else { continue };
            assert!((found - expected).abs() < printed(digits), "{albedo} {thickness} {g} {index}: {found} is not {expected}");
        }
    }
}

/// Without a boundary and without an end the layer is Chandrasekhar's half space.
#[test]
fn a_deep_layer_is_the_half_space_of_the_h_function() {
    let cosines = [0.15, 0.4, 0.75, 1.0];
    for albedo in [0.3, 0.9, 0.999] {
        let solution = Solution::new(&layer(albedo, f64::INFINITY, Phase::Isotropic, 1.0), 24, 1, &cosines);
        let half_space = HalfSpace::new(albedo);
        for light in cosines {
            let (found, expected) = (solution.parts(light).reflected, half_space.plane_albedo(light));
            assert!((found - expected).abs() < 1e-6, "albedo {albedo}, cosine {light}: {found} is not {expected}");
            for eye in cosines {
                let (found, expected) = (solution.radiance([light, eye], 0.7).reflected, half_space.radiance([light, eye]));
                assert!((found - expected).abs() < 1e-6, "albedo {albedo}, cosines {light} {eye}: {found} is not {expected}");
            }
        }
        assert!((solution.parts_of_diffuse_light().reflected - half_space.spherical_albedo()).abs() < 1e-6);
    }
}

/// All that goes in comes out where nothing is absorbed, by any phase function and index; and both ways to sum it up are one.
#[test]
fn lossless_layers_keep_all_light() {
    let hg = Phase::HenyeyGreenstein;
    let phases =
        [(Phase::Isotropic, 12), (Phase::Rayleigh, 12), (hg(0.9), 24), (Phase::blend(hg(0.6), Phase::Rayleigh, 0.4), 16)];
    for (phase, count) in phases {
        for index in [1.0, 1.33, 1.5, 0.8] {
            for thickness in [1e-3, 0.7, 12.0] {
                let solution = Solution::new(&layer(1.0, thickness, phase.clone(), index), count, 1, &[0.7, 1.0]);
                for cosine in [0.7, 1.0] {
                    let parts = solution.parts(cosine);
                    let sum = parts.reflected + parts.transmitted;
                    assert!((sum - 1.0).abs() < 1e-8, "{phase:?}, index {index}, thickness {thickness}: {sum}");
                    let by_flux = solution.parts_by_flux(cosine);
                    assert!((by_flux.reflected - parts.reflected).abs() < 1e-8, "{phase:?}, {index}: {by_flux:?}, {parts:?}");
                    assert!((by_flux.transmitted - parts.transmitted).abs() < 1e-8, "{phase:?}, {index}: {by_flux:?}, {parts:?}");
                }
            }
        }
    }
    // The control.
    let parts = Solution::new(&layer(0.99, 0.7, hg(0.5), 1.33), 12, 1, &[1.0]).parts(1.0);
    assert!(parts.reflected + parts.transmitted < 0.999);
}

/// A layer whose scattering is faint shows light scattered once, in all directions and azimuths.
#[test]
fn faint_layers_show_light_scattered_once() {
    let faint = 1e-7;
    let hg = Phase::HenyeyGreenstein;
    for (phase, modes) in [(Phase::Isotropic, 1), (Phase::Rayleigh, 3), (hg(0.4), 24)] {
        let medium = Medium { scattering: faint, extinction: 1.0, phase: phase.clone() };
        let solution = Solution::new(&layer(faint, 0.8, phase.clone(), 1.0), 16, modes, &[0.6, 0.9]);
        for azimuth in [0.0, 1.1, 3.0] {
            let sines = 0.8 * (1.0f64 - 0.81).sqrt() * f64::cos(azimuth);
            let found = solution.radiance([0.6, 0.9], azimuth);
            let back = reflected_by_layer(&medium, 0.8, 1.0, [0.6, 0.9], sines - 0.6 * 0.9);
            let on = transmitted_by_layer(&medium, 0.8, 1.0, [0.6, 0.9], sines + 0.6 * 0.9);
            assert!((found.reflected / back - 1.0).abs() < 1e-6, "{phase:?}, {azimuth}: {} is not {back}", found.reflected);
            assert!((found.transmitted / on - 1.0).abs() < 1e-6, "{phase:?}, {azimuth}: {} is not {on}", found.transmitted);
        }
    }
}

/// Radiances integrate to the parts, over all azimuths and cosines.
#[test]
fn radiances_integrate_to_the_parts() {
    let rule = quadrature::gauss_legendre(20, 0.0, 1.0);
    // Squares keep away from where the boundary reflects all.
    let eyes: Vec<f64> = rule.iter().map(|(x, _)| x * x).collect();
    let looked_at = [&eyes[..], &[0.6]].concat();
    for index in [1.0, 1.4] {
        let solution = Solution::new(&layer(0.9, 1.5, Phase::Rayleigh, index), 16, 3, &looked_at);
        let part = solution.parts(0.6);
        let mirrored = fresnel::reflectance(0.6, index);
        let azimuths = [0.3, 0.3 + std::f64::consts::PI, 0.3 + std::f64::consts::FRAC_PI_2, 0.3 - std::f64::consts::FRAC_PI_2];
        let mean = |eye: f64| azimuths.iter().map(|&azimuth| solution.radiance([0.6, eye], azimuth).reflected).sum::<f64>() / 4.0;
        let flux: f64 =
            rule.iter().map(|&(x, weight)| 2.0 * x * weight * std::f64::consts::TAU * x * x * mean(x * x)).sum::<f64>() / 0.6;
        // Light that went through and was mirrored by the far boundary comes back along one direction, to which no weight belongs.
        let far = if index == 1.0 { 0.0 } else { mirrored_by_the_far_boundary(1.5, 0.6, index) };
        assert!(
            (flux + mirrored + far - part.reflected).abs() < 1e-5,
            "index {index}: {flux} {mirrored} {far} {}",
            part.reflected
        );
    }
}

/// The part of a beam that leaves above after it met the far boundary of a layer, unscattered.
fn mirrored_by_the_far_boundary(thickness: f64, cosine: f64, index: f64) -> f64 {
    let part = fresnel::reflectance(cosine, index);
    let inside = fresnel::refracted(cosine, index).expect("it enters");
    let through = (-2.0 * thickness / inside).exp();
    (1.0 - part) * (1.0 - part) * part * through / (1.0 - part * part * through)
}

#[test]
fn a_random_walk_agrees() {
    let hg = Phase::HenyeyGreenstein;
    let cases = [
        (layer(0.95, 1.2, hg(0.6), 1.4), 0.5),
        (layer(0.8, 3.0, Phase::Rayleigh, 1.33), 0.9),
        (layer(0.9, 0.5, Phase::blend(hg(0.8), hg(-0.3), 0.4), 1.0), 0.3),
        (layer(0.9, 2.0, Phase::Isotropic, 0.8), 0.95),
    ];
    let mut random = SplitMix64::new(11);
    for (case, cosine) in cases {
        let parts = Solution::new(&case, 24, 1, &[cosine]).parts(cosine);
        let walked = walk::Layer { albedo: case.albedo, thickness: case.thickness, phase: case.phase.clone(), index: case.index };
        let counts = walk::send(&walked, cosine, 40_000, &mut || random.uniform());
        for (count, part) in [(counts.reflected, parts.reflected), (counts.transmitted, parts.transmitted)] {
            let (found, error) = counts.part(count);
            // Eight looks: one in two thousand fails a walk that is right.
            assert!((found - part).abs() < 4.0 * error, "{case:?}: {found} ± {error} is not {part}");
        }
    }
}
