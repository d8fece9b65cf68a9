//! Every lobe and many mixtures of them, judged by what they state about themselves and by what is known of them.

mod blend_weights;
mod coats;
mod densities;
mod dielectrics;
mod directions;
mod energy;
mod facets;
mod fresnel;
mod mixtures;
mod plastic;
mod rough_diffuse;
mod sides;
mod spectral;
mod views;

use std::collections::BTreeSet;
use std::path::Path;

use glam::{DVec2, DVec3};

use super::conductor::{Conductor, Fresnel};
use super::dielectric::Dielectric;
use super::diffuse::Diffuse;
use super::fresnel::{dielectric_reflectance, refract};
use super::glass::Glass;
use super::glossy::Glossy;
use super::lobe::Lobe;
use super::microfacet::Facets;
use super::mirror::Mirror;
use super::null::Null;
use super::phong::Phong;
use super::phong_glass::PhongGlass;
use super::phong_study::PhongStudy;
use super::plastic::{Base, Plastic};
use super::rough_glass::RoughGlass;
use super::rough_plastic::RoughPlastic;
use super::rough_thin_glass::RoughThinGlass;
use super::scatter::{Evaluation, Scatter};
use super::thin_glass::ThinGlass;
use super::*;
use crate::load::file::{example_materials, material_examples};
use crate::load::load_toml_str;
use crate::reference::intersect::Surface;
use crate::scene::{
    ColorInput, HemisphereSampling, LobeKind, Masking, MaterialKind, MicrofacetDistribution, Microfacets, PhongCosine,
    PhongHorizon, PhongSampling, PlasticInterface, Scene,
};
use crate::spectrum::Spectrum;

/// A unit vector at an angle from +z, in degrees.
fn at_degrees(theta: f64, phi: f64) -> DVec3 {
    let (sin_theta, cos_theta) = theta.to_radians().sin_cos();
    DVec3::new(sin_theta * phi.cos(), sin_theta * phi.sin(), cos_theta)
}

/// A surface with front normal +z and shading normal tilted from it, seen at an angle.
fn view(wo_degrees: f64, tilt_degrees: f64) -> View {
    View::new(at_degrees(wo_degrees, 0.4), DVec3::Z, at_degrees(tilt_degrees, 2.0))
}

/// The principled material of these keys.
fn principled(keys: &str) -> Lobe {
    let text = format!(
        "[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\nvfov = 40\n[[light]]\ntype = \"environment\"\nradiance = 1\n\
         [[material]]\nname = \"m\"\ntype = \"principled\"\n{keys}"
    );
    let scene = load_toml_str(&text, "test.toml", Path::new("")).unwrap_or_else(|error| panic!("{error}"));
    let lookup = Lookup { scene: &scene, uv: DVec2::ZERO.into(), cosine: 1.0, normal: DVec3::Z, front: true, by_camera: false };
    Lobe::of(&scene.materials[0].kind, &lookup).expect("it scatters")
}

fn single(lobe: Lobe, view: View) -> Bsdf {
    Bsdf::mixture(view, [(lobe, 1.0)])
}

fn diffuse(reflectance: Spectrum) -> Lobe {
    Lobe::Diffuse(Diffuse { reflectance })
}

fn orange() -> Spectrum {
    Spectrum::new(0.9, 0.5, 0.1)
}

fn mirror(reflectance: f64) -> Lobe {
    Lobe::Mirror(Mirror { reflectance: Spectrum::grey(reflectance) })
}

fn glossy(exponent: f64) -> Lobe {
    Lobe::Glossy(Glossy { reflectance: Spectrum::new(0.4, 0.9, 0.6), exponent })
}

fn phong(diffuse: f64, specular: f64, exponent: f64) -> Lobe {
    Lobe::Phong(Phong { diffuse: orange() * diffuse, specular: Spectrum::grey(specular), exponent })
}

/// Gold at about 630, 530 and 465 nm.
fn gold(alpha: f64) -> Lobe {
    let fresnel = Fresnel::Complex { eta: Spectrum::new(0.18, 0.42, 1.37), k: Spectrum::new(3.42, 2.35, 1.77) };
    Lobe::Conductor(Conductor { fresnel, facets: Facets::ggx(alpha), tint: Spectrum::WHITE, film: None })
}

/// A metal that reflects everything.
fn white_metal(alpha: f64) -> Lobe {
    white_metal_of(Facets::ggx(alpha))
}

fn white_metal_of(facets: Facets) -> Lobe {
    Lobe::Conductor(Conductor { fresnel: Fresnel::Schlick(Spectrum::WHITE), facets, tint: Spectrum::WHITE, film: None })
}

fn clear(ior: f64) -> Dielectric {
    Dielectric { ior, reflectance: Spectrum::WHITE, transmittance: Spectrum::WHITE }
}

fn tinted(ior: f64) -> Dielectric {
    Dielectric { ior, reflectance: Spectrum::new(0.9, 0.2, 0.0), transmittance: Spectrum::new(0.1, 0.8, 0.5) }
}

fn glass(dielectric: Dielectric) -> Lobe {
    Lobe::Glass(Glass { dielectric })
}

fn rough_glass(dielectric: Dielectric, alpha: f64) -> Lobe {
    Lobe::RoughGlass(RoughGlass { dielectric, facets: Facets::ggx(alpha) })
}

fn thin_glass(dielectric: Dielectric) -> Lobe {
    Lobe::ThinGlass(ThinGlass { dielectric })
}

fn rough_thin_glass(dielectric: Dielectric, facets: Facets) -> Lobe {
    Lobe::RoughThinGlass(RoughThinGlass { dielectric, facets })
}

/// Plastic whose surface reflects by Fresnel's equations alone.
fn plastic(interface: PlasticInterface, reflectance: Spectrum, nonlinear: bool) -> Lobe {
    let base = Base {
        reflectance,
        specular: Spectrum::WHITE,
        ior: interface.ior,
        internal_reflectance: interface.internal_reflectance(),
        nonlinear,
    };
    match interface.transmittance_table() {
        None => Lobe::Plastic(Plastic { base }),
        Some(&transmittance) => Lobe::RoughPlastic(RoughPlastic { base, facets: Facets::of_plastic(&interface), transmittance }),
    }
}

fn phong_glass(dielectric: Dielectric, exponent: f64) -> Lobe {
    Lobe::PhongGlass(PhongGlass { dielectric, exponent })
}

/// The lobes of all examples of the table of materials, with their indices of refraction.
fn examples() -> Vec<(String, Lobe, f64)> {
    let rest = "[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\nvfov = 40\n[[light]]\ntype = \"environment\"\nradiance = 1";
    let lobe = |(name, keys): (&str, String)| {
        let text = format!("{rest}\n{}\n[[material]]\nname = \"example\"\n{keys}", example_materials());
        let scene = load_toml_str(&text, "example.toml", Path::new("")).unwrap_or_else(|error| panic!("{name}: {error}"));
        let kind = &scene.materials.last().expect("it has the example").kind;
        assert_eq!(kind.type_name(), name);
        let lobe = Lobe::of(
            kind,
            &Lookup { scene: &scene, uv: DVec2::ZERO.into(), cosine: 1.0, normal: DVec3::Z, front: true, by_camera: false },
        );
        let parameters = kind.lobe();
        assert_eq!(lobe.map(|lobe| lobe.kind()), parameters.as_ref().map(|parameters| parameters.lobe), "{name}");
        let parameters = parameters?;
        // Light that goes through a plate is in the same medium again.
        let is_plate = matches!(parameters.lobe, LobeKind::ThinGlass | LobeKind::RoughThinGlass)
            || matches!(kind, MaterialKind::Principled(principled) if principled.thin || principled.let_through() == ColorInput::grey(0.0));
        let ior = parameters.ior.filter(|_| !is_plate).unwrap_or(1.0);
        Some((format!("{name}: {}", keys.replace('\n', ", ")), lobe?, ior))
    };
    let (mut lobes, mut types) = (Vec::new(), BTreeSet::new());
    for (name, keys) in material_examples() {
        types.insert(name);
        lobes.extend(lobe((name, keys)));
    }
    assert_eq!(types, MaterialKind::TYPE_NAMES.iter().copied().collect(), "every type of material has an example");
    let kinds: BTreeSet<LobeKind> = lobes.iter().map(|(_, lobe, _)| lobe.kind()).collect();
    assert_eq!(kinds, LobeKind::ALL.iter().copied().collect(), "every lobe has an example");
    lobes
}

/// `GPT_TEST_LOBE=velvet` leaves the lobes whose names contain that word, for those who work on one.
fn asked_for(lobes: impl Iterator<Item = (String, Lobe, f64)>) -> Vec<(String, Lobe, f64)> {
    let asked = std::env::var("GPT_TEST_LOBE").unwrap_or_default();
    lobes.filter(|(name, _, _)| name.contains(&asked)).collect()
}

fn asks_for_one() -> bool {
    std::env::var_os("GPT_TEST_LOBE").is_some()
}

/// Every lobe that is no delta, narrow and wide, with its index of refraction.
fn non_delta_lobes() -> Vec<(String, Lobe, f64)> {
    let narrow_and_wide = [
        ("glossy 3", glossy(3.0), 1.0),
        ("glossy 60", glossy(60.0), 1.0),
        ("phong", phong(0.5, 0.4, 25.0), 1.0),
        ("gold 0.15", gold(0.15), 1.0),
        ("white metal 0.6", white_metal(0.6), 1.0),
        (
            "narrow Beckmann metal",
            white_metal_of(Facets { distribution: MicrofacetDistribution::Beckmann, ..Facets::ggx(0.05) }),
            1.0,
        ),
        (
            "wide Beckmann metal",
            white_metal_of(Facets { distribution: MicrofacetDistribution::Beckmann, ..Facets::ggx(0.9) }),
            1.0,
        ),
        ("brushed metal", white_metal_of(Facets { alpha: DVec2::new(0.05, 0.8), anisotropic: true, ..Facets::ggx(0.0) }), 1.0),
        ("rough glass 0.3", rough_glass(clear(1.5), 0.3), 1.5),
        ("rough glass 0.6, less dense inside", rough_glass(tinted(0.7), 0.6), 0.7),
        ("Phong glass 15", phong_glass(tinted(1.5), 15.0), 1.5),
    ];
    let named = narrow_and_wide.map(|(name, lobe, ior)| (name.to_owned(), lobe, ior));
    asked_for(named.into_iter().chain(examples().into_iter().filter(|(_, lobe, _)| !lobe.is_delta())))
}

/// Lobes that reflect and transmit in single directions.
fn delta_lobes() -> Vec<(String, Lobe, f64)> {
    let smooth_gold = ("smooth gold".to_owned(), gold(0.0), 1.0);
    asked_for([smooth_gold].into_iter().chain(examples().into_iter().filter(|(_, lobe, _)| lobe.is_delta())))
}

/// Weighted lobes: non-delta with non-delta, non-delta with delta, delta with delta, and what nested blends come to.
fn mixtures() -> Vec<(&'static str, Vec<(Lobe, f64)>)> {
    vec![
        ("two diffuse", vec![(diffuse(orange()), 0.3), (diffuse(Spectrum::grey(0.2)), 0.7)]),
        ("diffuse and glossy", vec![(diffuse(orange()), 0.6), (glossy(40.0), 0.4)]),
        ("diffuse and mirror", vec![(diffuse(orange()), 0.5), (mirror(1.0), 0.5)]),
        ("mirror and glass", vec![(mirror(0.9), 0.4), (glass(clear(1.5)), 0.6)]),
        ("gold and rough glass", vec![(gold(0.3), 0.35), (rough_glass(clear(1.5), 0.4), 0.65)]),
        (
            "seven of all kinds",
            vec![
                (mirror(0.5), 0.1),
                (diffuse(orange()), 0.2),
                (phong(0.3, 0.3, 12.0), 0.15),
                (Lobe::Null(Null), 0.05),
                (rough_glass(tinted(1.3), 0.5), 0.2),
                (diffuse(Spectrum::grey(0.3)), 0.1),
                (phong_glass(clear(1.5), 9.0), 0.2),
            ],
        ),
    ]
}

/// Points of the unit cube spread evenly: multiples of the powers of the inverse of the root of x⁴ = x + 1, modulo 1, from a
/// random start (Roberts 2018).
fn cube_points(count: u32, seed: u64) -> impl Iterator<Item = [f64; 3]> {
    let mut random = crate::statistics::random::SplitMix64::new(seed << 32);
    let start: [f64; 3] = std::array::from_fn(|_| random.uniform());
    let step = 1.0 / 1.220_744_084_605_759_5_f64;
    (0..count).map(move |i| std::array::from_fn(|axis| (start[axis] + f64::from(i) * step.powi(axis as i32 + 1)).fract()))
}
