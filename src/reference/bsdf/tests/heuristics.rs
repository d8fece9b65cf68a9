//! The weights of blends.

use super::super::heuristic::{mean_weight, weight};
use super::*;
use crate::scene::{Heuristic, Texture, TextureKind};

fn at(heuristic: &Heuristic, cosine: f64) -> f64 {
    let mut scene = Scene::default();
    let (a, b) = (DVec3::new(0.2, 0.4, 0.6), DVec3::splat(7.0));
    scene.textures.push(Texture { name: "mask".into(), kind: TextureKind::Checker { a, b, scale: [2.0, 2.0] } });
    // The left lower field is a, its right neighbour b.
    let uv = if cosine < 0.5 { DVec2::new(0.1, 0.1) } else { DVec2::new(0.6, 0.1) };
    weight(heuristic, &Lookup { scene: &scene, uv, cosine })
}

fn reverse(of: Heuristic) -> Heuristic {
    Heuristic::Reverse { of: Box::new(of) }
}

fn threshold(tau: f64, of: Heuristic) -> Heuristic {
    Heuristic::Threshold { tau, of: Box::new(of) }
}

#[test]
fn heuristics_have_their_formulas() {
    for cosine in [0.0, 0.1, 0.3, 0.5, 0.9, 1.0] {
        let close = |heuristic: Heuristic, expected: f64| {
            let found = at(&heuristic, cosine);
            assert!((found - expected).abs() < 1e-14 && (0.0..=1.0).contains(&found), "{heuristic:?} at {cosine}: {found}");
        };
        close(Heuristic::Constant { value: 0.3 }, 0.3);
        close(Heuristic::Facing { power: 0.2 }, cosine.powf(0.2));
        close(Heuristic::Facing { power: -1.0 }, 1.0);
        close(Heuristic::Fresnel { ior: 2.0, exact: false }, 1.0 - (1.0 / 9.0 + 8.0 / 9.0 * (1.0 - cosine).powi(5)));
        close(Heuristic::Fresnel { ior: 2.0, exact: true }, 1.0 - dielectric_reflectance(cosine, 2.0));
        let luminance = 0.2126 * 0.2 + 0.7152 * 0.4 + 0.0722 * 0.6;
        close(Heuristic::Texture { texture: 0 }, if cosine < 0.5 { luminance } else { 1.0 });
        let facing = || Heuristic::Facing { power: 1.0 };
        close(reverse(facing()), 1.0 - cosine);
        close(threshold(0.5, facing()), if cosine >= 0.5 { 1.0 } else { 0.0 });
        // Inside out: 1 − (1 − c ≥ 0.6).
        close(reverse(threshold(0.6, reverse(facing()))), if 1.0 - cosine >= 0.6 { 0.0 } else { 1.0 });
        close(threshold(0.3, threshold(0.5, facing())), if cosine >= 0.5 { 1.0 } else { 0.0 });
    }
}

#[test]
fn the_mean_is_the_value_of_a_constant_and_else_one_half() {
    let constant = || Heuristic::Constant { value: 0.3 };
    assert_eq!(mean_weight(&constant()), 0.3);
    assert_eq!(mean_weight(&reverse(constant())), 0.7);
    assert_eq!(mean_weight(&threshold(0.3, constant())), 1.0);
    assert_eq!(mean_weight(&threshold(0.31, constant())), 0.0);
    assert_eq!(mean_weight(&threshold(0.7, reverse(constant()))), 1.0);
    for varying in
        [Heuristic::Facing { power: 1.0 }, Heuristic::Texture { texture: 0 }, Heuristic::Fresnel { ior: 1.5, exact: true }]
    {
        assert_eq!(mean_weight(&varying), 0.5);
        assert_eq!(mean_weight(&threshold(0.9, reverse(varying))), 0.5);
    }
}
