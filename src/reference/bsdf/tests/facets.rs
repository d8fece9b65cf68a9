//! Distributions of microfacets, and surfaces made of them.

use std::f64::consts::{FRAC_PI_2, PI};

use super::*;
use crate::effort::in_full;
use crate::scene::material::visible_slopes_below;

fn all_facets() -> Vec<Facets> {
    let mut all = Vec::new();
    for distribution in [MicrofacetDistribution::Ggx, MicrofacetDistribution::Beckmann] {
        for masking in [Masking::HeightCorrelated, Masking::Separable] {
            for [u, v] in [[0.3, 0.3], [0.15, 0.7]] {
                all.push(Facets { alpha: DVec2::new(u, v), distribution, masking, anisotropic: u != v });
            }
        }
    }
    all
}

/// ∫ f over the upper hemisphere, by midpoints of cosine and angle.
fn over_hemisphere(f: impl Fn(DVec3) -> f64) -> f64 {
    let (rows, columns) = (2000, 200);
    let mut sum = 0.0;
    for row in 0..rows {
        // Fine near the pole: cosθ = 1 − s².
        let s = (f64::from(row) + 0.5) / f64::from(rows);
        let z = 1.0 - s * s;
        for column in 0..columns {
            let phi = 2.0 * PI * (f64::from(column) + 0.5) / f64::from(columns);
            let r = (1.0 - z * z).sqrt();
            sum += 2.0 * s * f(DVec3::new(r * phi.cos(), r * phi.sin(), z));
        }
    }
    sum * 2.0 * PI / f64::from(rows * columns)
}

/// Microfacets together are as large as the surface, seen along its normal and, those that are seen, from anywhere: ∫ D·cosθm dm = 1 and
/// ∫ G1·D·(wo·m) dm = cosθo (Heitz 2014, equation 10).
#[test]
fn microfacets_cover_the_surface() {
    for facets in all_facets() {
        let area = over_hemisphere(|m| facets.distribution(m) * m.z);
        assert!((area - 1.0).abs() < 1e-3, "{facets:?}: {area}");
        for wo in [at_degrees(20.0, 0.3), at_degrees(60.0, 1.9), at_degrees(85.0, 4.0)] {
            let visible = over_hemisphere(|m| facets.masking(wo) * facets.distribution(m) * wo.dot(m).max(0.0)) / wo.z;
            assert!((visible - 1.0).abs() < 4e-3, "{facets:?} from {wo}: {visible}");
            // At a grazing angle, one width for the other would show.
            if wo.z > 0.1 {
                continue;
            }
            let other = Facets { alpha: facets.alpha * 1.2, ..facets };
            let mixed_up = over_hemisphere(|m| other.masking(wo) * facets.distribution(m) * wo.dot(m).max(0.0)) / wo.z;
            assert!((mixed_up - 1.0).abs() > 0.02, "{facets:?} from {wo}: {mixed_up}");
        }
    }
}

/// Beckmann's Λ is 0 along the normal and (exp(−1)/√π + erf(1) − 1)/2 at a = 1; what is visible of all slopes is 1 + Λ.
#[test]
fn the_masking_of_beckmann_has_its_known_values() {
    let lambda = |stretched: f64| MicrofacetDistribution::Beckmann.lambda(stretched);
    assert_eq!(lambda(0.0), 0.0);
    assert!((lambda(1.0) - 0.5 * ((-1.0_f64).exp() / PI.sqrt() + 0.842_700_792_949_714_9 - 1.0)).abs() < 1e-10);
    for tangent in [0.2, 1.0, 30.0] {
        let visible = visible_slopes_below(1.0 / tangent, tangent);
        assert!((visible / (1.0 + lambda(tangent * tangent)) - 1.0).abs() < 1e-12, "{tangent}: {visible}");
    }
}

/// Microfacets that are as wide in both directions have none; those that are not turn with the tangent.
#[test]
fn anisotropy_turns_with_the_tangent() {
    let wo = at_degrees(50.0, 0.4);
    for distribution in [MicrofacetDistribution::Ggx, MicrofacetDistribution::Beckmann] {
        let of = |u: f64, v: f64, anisotropic: bool| {
            white_metal_of(Facets { alpha: DVec2::new(u, v), distribution, anisotropic, ..Facets::ggx(0.0) })
        };
        let along = |tangent: DVec3| {
            let tangents = crate::reference::intersect::Tangents::along(tangent, tangent);
            View::new(wo, DVec3::Z, DVec3::Z).with_tangents(Some(tangents))
        };
        let mut differs = 0;
        for [a, b, _] in cube_points(200, 6) {
            let wi = crate::reference::warp::cosine_hemisphere(a, b);
            let value = |lobe: &Lobe, view: &View| lobe.evaluate(view, wi).value.r();
            let round = value(&of(0.4, 0.4, false), &view(50.0, 0.0));
            let turned = along(DVec3::new(0.3, -0.9, 0.5));
            assert!((value(&of(0.4, 0.4, true), &turned) - round).abs() <= 1e-12 * round);
            // A quarter of a turn swaps the widths.
            let brushed = value(&of(0.2, 0.6, true), &along(DVec3::X));
            assert!((value(&of(0.6, 0.2, true), &along(DVec3::Y * 3.0)) - brushed).abs() <= 1e-12 * brushed);
            differs += usize::from((value(&of(0.2, 0.6, true), &along(DVec3::Y)) / brushed - 1.0).abs() > 0.1);
        }
        assert!(differs > 150, "{differs}");
    }
}

/// Narrow along u: light spreads across it.
#[test]
fn the_narrow_direction_is_the_tangent() {
    let facets = Facets { alpha: DVec2::new(0.05, 0.5), anisotropic: true, ..Facets::ggx(0.0) };
    let tangents = crate::reference::intersect::Tangents::along(DVec3::X, DVec3::Y);
    let view = View::new(DVec3::Z, DVec3::Z, DVec3::Z).with_tangents(Some(tangents));
    let lobe = white_metal_of(facets);
    let value = |phi: f64| lobe.evaluate(&view, at_degrees(20.0, phi)).value.r();
    assert!(value(FRAC_PI_2) > 10.0 * value(0.0));
}

/// Microfacets of a plate reflect and let through as much light as those of a white metal reflect: between
/// them nothing else is lost.
#[test]
fn rough_plates_lose_what_metals_lose() {
    let count = if in_full("200,000 directions of rough plates instead of 100,000") { 200_000 } else { 100_000 };
    for facets in all_facets() {
        for degrees in [10.0, 65.0] {
            let view = view(degrees, 0.0);
            let albedo = |lobe: Lobe| {
                let bsdf = single(lobe, view);
                let weights =
                    cube_points(count, 7).filter_map(|[u1, u2, u]| bsdf.sample(u, u1, u2)).map(|sample| sample.weight.r());
                weights.sum::<f64>() / f64::from(count)
            };
            let (metal, plate) = (albedo(white_metal_of(facets)), albedo(rough_thin_glass(clear(1.5), facets)));
            assert!((metal - plate).abs() < 2e-3, "{facets:?} at {degrees}: {metal} {plate}");
            assert!(metal > 0.5 && metal < 1.0);
        }
    }
}
