//! Materials come back.

use super::{HEAD, POINT, RED, SQUARE, Trip, round_trip, scene};
use crate::load::file::material_examples;
use crate::load::load_toml_str;
use crate::scene::{BlendWeight, ColorInput, Material, MaterialKind, Principled, Scene};
use crate::spectrum::Spectrum;

/// The material of the first shape.
fn shown(scene: &Scene) -> &Material {
    &scene.materials[scene.shapes[0].material]
}

fn trip(keys: &str) -> (Scene, Trip) {
    let written = scene(&format!("[[material]]\nname = \"probe\"\n{keys}\n{SQUARE}{POINT}"));
    let trip = round_trip(&written);
    (written, trip)
}

/// All numbers of one are near those of the other, and both are of one form.
fn are_alike(a: &Material, b: &Material) -> bool {
    let (first, second) = (a.numbers(), b.numbers());
    a.has_form_of(b) && first.len() == second.len() && first.iter().zip(&second).all(|(a, b)| (a - b).abs() < 1e-6)
}

#[test]
fn lambert_s_law_is_the_same_there() {
    let (written, trip) = trip("type = \"diffuse\"\nreflectance = [0.6, 0.1, 0.25]");
    assert_eq!((trip.lost.len(), trip.back.len()), (0, 0), "{:?}", trip.lost);
    assert!(matches!(shown(&trip.read).kind, MaterialKind::Diffuse { .. }));
    assert!(are_alike(shown(&trip.read), shown(&written)), "{:?}", shown(&trip.read));
    let (other, _) = self::trip("type = \"diffuse\"\nreflectance = [0.6, 0.1, 0.26]");
    assert!(!are_alike(shown(&trip.read), shown(&other)), "the control");
}

/// The material with all of the thickness of its film, if it has one, in one number.
fn with_whole_film(material: &Material) -> Material {
    let mut material = material.clone();
    if let MaterialKind::Principled(principled) = &mut material.kind
        && let Some(film) = &mut principled.thin_film
        && let ColorInput::Constant(thickness) = film.thickness
    {
        film.thickness = ColorInput::grey(thickness.r() + std::mem::take(&mut film.offset));
    }
    material
}

/// All numbers of every example of which nothing is reported.
#[test]
fn principled_materials_come_back() {
    let mut exact = 0;
    for (_, keys) in material_examples().filter(|(name, _)| *name == "principled") {
        let text = format!("{HEAD}[[material]]\nname = \"probe\"\n{keys}{SQUARE}{POINT}");
        let written = load_toml_str(&text, "test.toml", std::path::Path::new("")).unwrap();
        let trip = round_trip(&written);
        assert!(trip.back.is_empty() || trip.back == ["KHR_materials_iridescence below a clear coat"], "{keys} {:?}", trip.back);
        if trip.lost.is_empty() && written.materials[0].interior.is_none() {
            // A scene that fills bodies with their scattering says so by a medium.
            let MaterialKind::Principled(principled) = &shown(&written).kind else { panic!("{keys}") };
            if principled.subsurface.is_none() {
                exact += 1;
                assert!(
                    are_alike(shown(&trip.read), &with_whole_film(shown(&written))),
                    "{keys}\n{:?}\n{:?}",
                    shown(&trip.read),
                    shown(&written)
                );
            }
        }
    }
    assert!(exact >= 12, "{exact}");
}

#[test]
fn light_of_surfaces_comes_back() {
    let light = "type = \"emissive\"\nradiance = [5, 6, 7]\ntwo_sided = true";
    let (written, trip) = trip(light);
    assert_eq!((trip.lost.len(), trip.back.len()), (0, 0), "{:?}", trip.lost);
    let emitted = |scene: &Scene| shown(scene).emission.map(|emission| (emission.radiance, emission.two_sided));
    let near = |a: ColorInput, b: ColorInput| match (a, b) {
        (ColorInput::Constant(a), ColorInput::Constant(b)) => a.distance(b) < 1e-9,
        _ => false,
    };
    let (Some(read), Some(expected)) = (emitted(&trip.read), emitted(&written)) else { panic!("no light") };
    assert!(near(read.0, expected.0) && read.1 && expected.1, "{read:?}");
    // Light of one side: the other side is not there.
    let (_, one_sided) = self::trip(&light.replace("\ntwo_sided = true", ""));
    assert_eq!(one_sided.lost, ["light of one side"]);
    assert_eq!(emitted(&one_sided.read).map(|(_, two_sided)| two_sided), Some(false));
    assert!(matches!(&shown(&one_sided.read).kind, MaterialKind::Blend { weight: BlendWeight::Front, .. }));
    // Nobody sees the other side of a ball.
    let ball = "[[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"probe\"\n";
    let one_sided = light.replace("\ntwo_sided = true", "");
    let ball = round_trip(&scene(&format!("[[material]]\nname = \"probe\"\n{one_sided}\n{ball}{POINT}")));
    assert_eq!(ball.lost, ["shape `sphere`"]);
    let (other, _) = self::trip(&light.replace('7', "8"));
    assert!(!near(read.0, emitted(&other).unwrap().0), "the control");
}

#[test]
fn openings_come_back() {
    let blend = |weight: &str| {
        format!(
            "{RED}[[material]]\nname = \"nothing\"\ntype = \"pass\"\n[[material]]\nname = \"probe\"\ntype = \"blend\"\n\
             materials = [\"red\", \"nothing\"]\nweight = {weight}\n{SQUARE}{POINT}"
        )
    };
    let weight_of = |text: &str| {
        let trip = round_trip(&scene(&blend(text)));
        assert_eq!((trip.lost.len(), trip.back.len()), (0, 0), "{:?}", trip.lost);
        let MaterialKind::Blend { materials: [first, second], weight } = shown(&trip.read).kind.clone() else {
            panic!("{:?}", shown(&trip.read))
        };
        assert!(matches!(trip.read.materials[first].kind, MaterialKind::Diffuse { .. }));
        assert!(matches!(trip.read.materials[second].kind, MaterialKind::Pass));
        weight
    };
    assert_eq!(weight_of("{ type = \"constant\", value = 0.25 }"), BlendWeight::Constant { value: 0.25 });
    assert_eq!(weight_of("{ type = \"front\" }"), BlendWeight::Front);
    // A lamp that is there by a share gives off that share of its light, by its alpha alone.
    let lamp = blend("{ type = \"constant\", value = 0.25 }")
        .replace(RED, "[[material]]\nname = \"red\"\ntype = \"emissive\"\nradiance = [0.5, 0.25, 1]\ntwo_sided = true\n");
    let json = round_trip(&scene(&lamp)).json;
    assert_eq!(json["materials"][0]["emissiveFactor"], serde_json::json!([0.5, 0.25, 1.0]));
    assert_ne!(weight_of("{ type = \"constant\", value = 0.5 }"), BlendWeight::Constant { value: 0.25 }, "the control");
}

#[test]
fn others_are_the_nearest_ones() {
    let principled = |keys: &str| -> (Principled, Vec<String>) {
        let (_, trip) = trip(keys);
        let MaterialKind::Principled(principled) = &shown(&trip.read).kind else { panic!("{:?}", shown(&trip.read)) };
        (principled.as_ref().clone(), trip.lost)
    };
    let grey = |input: ColorInput| if let ColorInput::Constant(value) = input { value.r() } else { f64::NAN };
    let (metal, lost) = principled("type = \"conductor\"\npreset = \"silver\"\nroughness = 0.4");
    assert_eq!(lost, ["material of type `conductor`"]);
    assert!((grey(metal.metallic) - 1.0).abs() + (grey(metal.roughness) - 0.4).abs() < 1e-9);
    // Silver reflects so much red along the normal.
    assert!((grey(metal.base_color) - 0.974).abs() < 2e-3, "{:?}", metal.base_color);
    let (wide, _) = principled("type = \"conductor\"\npreset = \"silver\"\nalpha_u = 0.25\nalpha_v = 0.64");
    let anisotropy = grey(wide.anisotropy.unwrap());
    let widened = 0.25 + 0.75 * anisotropy * anisotropy;
    assert!((grey(wide.roughness) - 0.5).abs() < 1e-9 && (widened - 0.64).abs() < 1e-9);
    assert!((wide.anisotropy_rotation_degrees - 90.0).abs() < 1e-9);
    let (glass, lost) = principled("type = \"rough_glass\"\nior = 1.4\nroughness = 0.3");
    assert_eq!(lost, ["material of type `rough_glass`"]);
    assert!((grey(glass.transmission), glass.ior, glass.thin) == (1.0, 1.4, false) && (grey(glass.roughness) - 0.3).abs() < 1e-9);
    let (pane, _) = principled("type = \"glass\"\nthin = true");
    assert!(pane.thin, "the control");
}

/// A sheet that scatters to both sides is one there.
#[test]
fn sheets_come_back() {
    let (_, trip) = trip("type = \"diffuse_transmission\"\nreflectance = [0.4, 0.2, 0.1]\ntransmittance = [0.2, 0.3, 0.05]");
    assert_eq!((trip.lost.len(), trip.back.len()), (0, 0), "{:?}", trip.lost);
    let MaterialKind::Principled(sheet) = &shown(&trip.read).kind else { panic!("{:?}", shown(&trip.read)) };
    let value = |input: ColorInput| if let ColorInput::Constant(value) = input { value } else { Spectrum::BLACK };
    let share = value(sheet.diffuse_transmission).r();
    let [up, down] = [value(sheet.base_color) * (1.0 - share), value(sheet.diffuse_transmission_color) * share];
    assert!(up.distance(Spectrum::new(0.4, 0.2, 0.1)) < 1e-9 && down.distance(Spectrum::new(0.2, 0.3, 0.05)) < 1e-9);
    assert!(up.distance(down) > 0.1, "the control");
}

/// A medium that absorbs and scatters within a body comes back.
#[test]
fn media_come_back() {
    let tables = |medium: &str| {
        format!(
            "[[medium]]\nname = \"milk\"\n{medium}\n[[material]]\nname = \"probe\"\ntype = \"principled\"\nmetallic = 0\nroughness = 0\n\
             transmission = 1\ninterior = \"milk\"\n{SQUARE}{POINT}"
        )
    };
    let milk = "absorption = [0.1, 1, 3]\nscattering = [4, 3, 2]\nphase = { type = \"henyey_greenstein\", g = 0.5 }";
    let trip = round_trip(&scene(&tables(milk)));
    assert_eq!((trip.lost.len(), trip.back.len()), (0, 0), "{:?} {:?}", trip.lost, trip.back);
    let medium = &trip.read.media[shown(&trip.read).interior.expect("it has one")];
    let expected = [Spectrum::new(0.1, 1.0, 3.0), Spectrum::new(4.0, 3.0, 2.0)];
    assert!(medium.absorption.distance(expected[0]) < 1e-6 && medium.scattering.distance(expected[1]) < 1e-6, "{medium:?}");
    let other = round_trip(&scene(&tables(&milk.replace("[4, 3, 2]", "[4, 3, 2.1]"))));
    assert!(other.read.media[0].scattering.distance(expected[1]) > 1e-3, "the control");
}
