//! The weights of blends.

use super::super::blend_weight::{mean_weight, weight};
use super::*;
use crate::scene::{BlendWeight, Texture, TextureKind};

fn at(blend_weight: &BlendWeight, cosine: f64) -> f64 {
    let mut scene = Scene::default();
    let (a, b) = (Spectrum::new(0.2, 0.4, 0.6), Spectrum::grey(7.0));
    scene.textures.push(Texture::new("mask", TextureKind::Checker { a, b, scale: [2.0, 2.0] }));
    // The left lower field is a, its right neighbour b.
    let uv = if cosine < 0.5 { DVec2::new(0.1, 0.1) } else { DVec2::new(0.6, 0.1) };
    weight(blend_weight, &Lookup { scene: &scene, uv: uv.into(), cosine, normal: DVec3::Z, front: true, by_camera: false })
}

fn reverse(of: BlendWeight) -> BlendWeight {
    BlendWeight::Reverse { of: Box::new(of) }
}

fn threshold(tau: f64, of: BlendWeight) -> BlendWeight {
    BlendWeight::Threshold { tau, of: Box::new(of) }
}

#[test]
fn heuristics_have_their_formulas() {
    for cosine in [0.0, 0.1, 0.3, 0.5, 0.9, 1.0] {
        let close = |blend_weight: BlendWeight, expected: f64| {
            let found = at(&blend_weight, cosine);
            assert!((found - expected).abs() < 1e-14 && (0.0..=1.0).contains(&found), "{blend_weight:?} at {cosine}: {found}");
        };
        close(BlendWeight::Constant { value: 0.3 }, 0.3);
        close(BlendWeight::Facing { power: 0.2 }, cosine.powf(0.2));
        close(BlendWeight::Facing { power: -1.0 }, 1.0);
        close(BlendWeight::Fresnel { ior: 2.0, exact: false }, 1.0 - (1.0 / 9.0 + 8.0 / 9.0 * (1.0 - cosine).powi(5)));
        close(BlendWeight::Fresnel { ior: 2.0, exact: true }, 1.0 - dielectric_reflectance(cosine, 2.0));
        let luminance = 0.2126 * 0.2 + 0.7152 * 0.4 + 0.0722 * 0.6;
        // The normal is (0, 0, 1).
        close(BlendWeight::Up { axis: DVec3::new(0.6, 0.0, 0.8), power: 2.0 }, 0.64);
        close(BlendWeight::Up { axis: -DVec3::Z, power: 0.5 }, 0.0);
        close(BlendWeight::Texture { texture: 0 }, if cosine < 0.5 { luminance } else { 1.0 });
        let facing = || BlendWeight::Facing { power: 1.0 };
        close(reverse(facing()), 1.0 - cosine);
        close(threshold(0.5, facing()), if cosine >= 0.5 { 1.0 } else { 0.0 });
        // Inside out: 1 − (1 − c ≥ 0.6).
        close(reverse(threshold(0.6, reverse(facing()))), if 1.0 - cosine >= 0.6 { 0.0 } else { 1.0 });
        close(threshold(0.3, threshold(0.5, facing())), if cosine >= 0.5 { 1.0 } else { 0.0 });
    }
}

#[test]
fn the_mean_is_the_value_of_a_constant_and_else_one_half() {
    let constant = || BlendWeight::Constant { value: 0.3 };
    assert_eq!(mean_weight(&constant()), 0.3);
    assert_eq!(mean_weight(&reverse(constant())), 0.7);
    assert_eq!(mean_weight(&threshold(0.3, constant())), 1.0);
    assert_eq!(mean_weight(&threshold(0.31, constant())), 0.0);
    assert_eq!(mean_weight(&threshold(0.7, reverse(constant()))), 1.0);
    for varying in
        [BlendWeight::Facing { power: 1.0 }, BlendWeight::Texture { texture: 0 }, BlendWeight::Fresnel { ior: 1.5, exact: true }]
    {
        assert_eq!(mean_weight(&varying), 0.5);
        assert_eq!(mean_weight(&threshold(0.9, reverse(varying))), 0.5);
    }
}
