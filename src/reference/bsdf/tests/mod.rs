//! Every lobe and many mixtures of them, judged by what they state about themselves and by what is known of them.

mod blend_weights;
mod densities;
mod dielectrics;
mod energy;
mod fresnel;
mod mixtures;
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
use super::microfacet::Ggx;
use super::mirror::Mirror;
use super::null::Null;
use super::phong::Phong;
use super::phong_glass::PhongGlass;
use super::rough_glass::RoughGlass;
use super::scatter::{Evaluation, Scatter};
use super::*;
use crate::load::file::{load_toml_str, material_examples};
use crate::reference::intersect::Surface;
use crate::scene::{ColorInput, HemisphereSampling, LobeKind, MaterialKind, Scene};

/// A unit vector at an angle from +z, in degrees.
fn at_degrees(theta: f64, phi: f64) -> DVec3 {
    let (sin_theta, cos_theta) = theta.to_radians().sin_cos();
    DVec3::new(sin_theta * phi.cos(), sin_theta * phi.sin(), cos_theta)
}

/// A surface with front normal +z and shading normal tilted from it, seen at an angle.
fn view(wo_degrees: f64, tilt_degrees: f64) -> View {
    View::new(at_degrees(wo_degrees, 0.4), DVec3::Z, at_degrees(tilt_degrees, 2.0))
}

fn single(lobe: Lobe, view: View) -> Bsdf {
    Bsdf::mixture(view, [(lobe, 1.0)])
}

fn diffuse(reflectance: DVec3) -> Lobe {
    Lobe::Diffuse(Diffuse { reflectance })
}

fn orange() -> DVec3 {
    DVec3::new(0.9, 0.5, 0.1)
}

fn mirror(reflectance: f64) -> Lobe {
    Lobe::Mirror(Mirror { reflectance: DVec3::splat(reflectance) })
}

fn glossy(exponent: f64) -> Lobe {
    Lobe::Glossy(Glossy { reflectance: DVec3::new(0.4, 0.9, 0.6), exponent })
}

fn phong(diffuse: f64, specular: f64, exponent: f64) -> Lobe {
    Lobe::Phong(Phong { diffuse: orange() * diffuse, specular: DVec3::splat(specular), exponent })
}

/// Gold at about 630, 530 and 465 nm.
fn gold(alpha: f64) -> Lobe {
    let fresnel = Fresnel::Complex { eta: DVec3::new(0.18, 0.42, 1.37), k: DVec3::new(3.42, 2.35, 1.77) };
    Lobe::Conductor(Conductor { fresnel, alpha })
}

/// A metal that reflects everything.
fn white_metal(alpha: f64) -> Lobe {
    Lobe::Conductor(Conductor { fresnel: Fresnel::Schlick(DVec3::ONE), alpha })
}

fn clear(ior: f64) -> Dielectric {
    Dielectric { ior, reflectance: DVec3::ONE, transmittance: DVec3::ONE }
}

fn tinted(ior: f64) -> Dielectric {
    Dielectric { ior, reflectance: DVec3::new(0.9, 0.2, 0.0), transmittance: DVec3::new(0.1, 0.8, 0.5) }
}

fn glass(dielectric: Dielectric) -> Lobe {
    Lobe::Glass(Glass { dielectric })
}

fn rough_glass(dielectric: Dielectric, alpha: f64) -> Lobe {
    Lobe::RoughGlass(RoughGlass { dielectric, ggx: Ggx { alpha } })
}

fn phong_glass(dielectric: Dielectric, exponent: f64) -> Lobe {
    Lobe::PhongGlass(PhongGlass { dielectric, exponent })
}

/// The lobes of all examples of the table of materials, with their indices of refraction.
fn examples() -> Vec<(String, Lobe, f64)> {
    let red = "[[material]]\nname = \"red\"\ntype = \"diffuse\"\nreflectance = [0.7, 0.1, 0.1]";
    let mirror = "[[material]]\nname = \"mirror\"\ntype = \"mirror\"";
    let rest = "[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\nvfov = 40\n[[light]]\ntype = \"environment\"\nradiance = 1";
    let lobe = |(name, keys): (&str, String)| {
        let text = format!("{rest}\n{red}\n{mirror}\n[[material]]\nname = \"example\"\n{keys}");
        let scene = load_toml_str(&text, "example.toml", Path::new("")).unwrap_or_else(|error| panic!("{name}: {error}"));
        let kind = &scene.materials.last().expect("it has the example").kind;
        assert_eq!(kind.type_name(), name);
        let lobe = Lobe::of(kind, &Lookup { scene: &scene, uv: DVec2::ZERO, cosine: 1.0 });
        let parameters = kind.lobe();
        assert_eq!(lobe.map(|lobe| lobe.kind()), parameters.map(|parameters| parameters.lobe), "{name}");
        Some((format!("{name}: {}", keys.replace('\n', ", ")), lobe?, parameters?.ior.unwrap_or(1.0)))
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

/// Every lobe that is no delta, narrow and wide, with its index of refraction.
fn non_delta_lobes() -> Vec<(String, Lobe, f64)> {
    let narrow_and_wide = [
        ("glossy 3", glossy(3.0), 1.0),
        ("glossy 60", glossy(60.0), 1.0),
        ("phong", phong(0.5, 0.4, 25.0), 1.0),
        ("gold 0.15", gold(0.15), 1.0),
        ("white metal 0.6", white_metal(0.6), 1.0),
        ("rough glass 0.3", rough_glass(clear(1.5), 0.3), 1.5),
        ("rough glass 0.6, less dense inside", rough_glass(tinted(0.7), 0.6), 0.7),
        ("Phong glass 15", phong_glass(tinted(1.5), 15.0), 1.5),
    ];
    let named = narrow_and_wide.map(|(name, lobe, ior)| (name.to_owned(), lobe, ior));
    named.into_iter().chain(examples().into_iter().filter(|(_, lobe, _)| !lobe.is_delta())).collect()
}

/// Lobes that reflect and transmit in single directions.
fn delta_lobes() -> Vec<(String, Lobe, f64)> {
    let smooth_gold = ("smooth gold".to_owned(), gold(0.0), 1.0);
    [smooth_gold].into_iter().chain(examples().into_iter().filter(|(_, lobe, _)| lobe.is_delta())).collect()
}

/// Weighted lobes: non-delta with non-delta, non-delta with delta, delta with delta, and what nested blends come to.
fn mixtures() -> Vec<(&'static str, Vec<(Lobe, f64)>)> {
    vec![
        ("two diffuse", vec![(diffuse(orange()), 0.3), (diffuse(DVec3::splat(0.2)), 0.7)]),
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
                (diffuse(DVec3::splat(0.3)), 0.1),
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
