//! Media that are exported and read again are what they were.

use std::ffi::OsStr;

use glam::DVec3;
use tempfile::tempdir;

use super::share_scattered;
use crate::load::{LoadOptions, load_toml_str, load_with};
use crate::scene::{Medium, PhaseKind, Scene};
use crate::scene_writer::as_mitsuba;

const HEAD: &str = "[camera]\nposition = [0, 0, 20]\nlook_at = [0, 0, 0]\nvfov = 40\n";
const POINT_LIGHT: &str = "[[light]]\ntype = \"point\"\nposition = [9, 9, 9]\nintensity = 9\n";
const MEDIA: &str = "medium = \"fog\"\n\
    [[medium]]\nname = \"fog\"\nabsorption = 0.25\nscattering = 0.5\nphase = { type = \"henyey_greenstein\", g = 0.5 }\n\
    [[medium]]\nname = \"milk\"\nabsorption = [0, 1, 3]\nscattering = [4, 3, 2]\n\
    phase = { type = \"blend\", phases = [{ type = \"rayleigh\" }, { type = \"isotropic\" }, { type = \"henyey_greenstein\", g = -0.5 }], weights = [1, 2, 1] }\n\
    [[medium]]\nname = \"smoke\"\nabsorption = 1\nscattering = 0\n";
const SHAPES: &str = "[[material]]\nname = \"glass\"\ntype = \"glass\"\n\
    [[material]]\nname = \"milk\"\ntype = \"glass\"\ninterior = \"milk\"\n\
    [[material]]\nname = \"smoke\"\ntype = \"pass\"\ninterior = \"smoke\"\n\
    [[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"milk\"\n\
    [[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 2\nmaterial = \"smoke\"\n\
    [[shape]]\ntype = \"box\"\nmin = [3, 0, 0]\nmax = [4, 1, 1]\nmaterial = \"glass\"\n";

/// The text of the scene as one of Mitsuba, that scene, and what was reported of the way there and back.
fn round_trip(scene: &Scene) -> (String, Scene, Vec<String>) {
    let folder = tempdir().unwrap();
    let path = folder.path().join("out.xml");
    let written = as_mitsuba(scene, "test", &path).unwrap();
    let mut said: Vec<String> = Vec::new();
    let mut note = |report: &crate::scene::ImportReport| {
        said.extend(report.dropped.iter().chain(&report.approximated).map(|item| format!("{}: {}", item.what, item.instead)));
    };
    note(&written.report);
    let text = String::from_utf8(written.content.clone()).unwrap();
    written.write(&path, &LoadOptions::default().log).unwrap();
    let read = load_with(Some(OsStr::new(&path)), &LoadOptions::default()).unwrap_or_else(|error| panic!("{error}\n{text}"));
    note(&read.import_report);
    (text, read, said)
}

fn scene(tables: &str) -> Scene {
    load_toml_str(&format!("{HEAD}{tables}{POINT_LIGHT}"), "test.toml", std::path::Path::new(""))
        .unwrap_or_else(|error| panic!("{error}\n{tables}"))
}

/// The medium of a shape.
fn within(scene: &Scene, shape: usize) -> Option<&Medium> {
    scene.materials[scene.shapes[shape].material].interior.map(|id| &scene.media[id])
}

fn assert_same(found: Option<&Medium>, expected: Option<&Medium>) {
    let (Some(found), Some(expected)) = (found, expected) else {
        assert!(found.is_none() && expected.is_none(), "{found:?} instead of {expected:?}");
        return;
    };
    for (found, expected) in [(found.absorption, expected.absorption), (found.scattering, expected.scattering)] {
        assert!((found - expected).map(f64::abs).max_component() < 1e-12, "{found} instead of {expected}");
    }
    // In any order.
    let lobes = |medium: &Medium| -> Vec<(String, f64)> {
        let name = |kind: PhaseKind| format!("{kind:?}");
        let mut lobes: Vec<_> = medium.phase.0.iter().map(|lobe| (name(lobe.kind), lobe.weight)).collect();
        lobes.sort_by(|a, b| a.0.cmp(&b.0));
        lobes
    };
    let (found, expected) = (lobes(found), lobes(expected));
    assert_eq!(found.len(), expected.len(), "{found:?} instead of {expected:?}");
    for (found, expected) in found.iter().zip(&expected) {
        assert!(found.0 == expected.0 && (found.1 - expected.1).abs() < 1e-12, "{found:?} instead of {expected:?}");
    }
}

#[test]
fn media_come_back() {
    let scene = scene(&format!("{MEDIA}{SHAPES}"));
    let (text, read, said) = round_trip(&scene);
    assert_eq!(said, Vec::<String>::new(), "{text}");
    let around = |scene: &Scene| scene.camera_medium.map(|id| scene.media[id].clone());
    assert_same(around(&read).as_ref(), around(&scene).as_ref());
    for shape in 0..3 {
        // The box of glass is empty there by its own word, and here because no medium fills it.
        if shape < 2 {
            assert_same(within(&read, shape), within(&scene, shape));
        } else {
            assert!(within(&read, shape).is_none_or(|medium| medium.extinction().is_black()));
        }
    }
    assert_eq!(read.render.max_depth, scene.render.max_depth);
    // Written once more it is the same text.
    let names = |text: &str| {
        text.replace("medium medium", "medium").replace(", around medium milk", "").replace(", around medium smoke", "")
    };
    let again = round_trip(&read).0;
    assert_eq!(names(&again).matches("sigma_t").count(), text.matches("sigma_t").count() + 1, "{again}");
    // The controls: another density, and another phase function.
    for (from, to) in [("absorption = 1\n", "absorption = 1.5\n"), ("g = -0.5", "g = -0.6")] {
        let other = self::scene(&format!("{MEDIA}{SHAPES}").replace(from, to));
        let (_, other, _) = round_trip(&other);
        let are_alike = (0..2).all(|shape| {
            within(&other, shape).map(|m| (m.absorption, m.phase.clone()))
                == within(&read, shape).map(|m| (m.absorption, m.phase.clone()))
        });
        assert!(!are_alike, "{to}");
    }
}

/// Both sides of shapes are written, by what is around them.
#[test]
fn shapes_say_what_is_around_them() {
    let (text, ..) = round_trip(&scene(&format!("{MEDIA}{SHAPES}")));
    let sides = |of: &str| {
        let shape = text.split("<shape").find(|shape| shape.contains(of)).unwrap_or_else(|| panic!("no {of} in\n{text}"));
        let side = |name: &str| {
            let (_, id) = shape.split_once(&format!("<ref name=\"{name}\" id=\"medium "))?;
            id.split_once('"').map(|(id, _)| id.to_owned())
        };
        [side("interior"), side("exterior")].map(Option::unwrap_or_default)
    };
    assert_eq!(sides("<ref id=\"milk\"/>"), ["milk", "smoke"]);
    assert_eq!(sides("<ref id=\"smoke\"/>"), ["smoke", "fog"]);
    assert_eq!(sides("<ref id=\"glass\"/>"), ["", "fog"]);
    assert!(text.contains("<integrator type=\"volpath\">"), "{text}");
    // The control: without media there are none, and no integrator for them.
    let plain = SHAPES.replace("interior = \"milk\"\n", "").replace("interior = \"smoke\"\n", "");
    let (text, ..) = round_trip(&scene(&plain));
    assert!(!text.contains("medium") && !text.contains("exterior") && text.contains("<integrator type=\"path\">"), "{text}");
}

#[test]
fn what_mitsuba_cannot_say_of_a_medium_is_reported() {
    let glows = format!("{MEDIA}{SHAPES}").replace("scattering = 0\n", "scattering = 0\nemission = 2\n");
    let (_, _, said) = round_trip(&scene(&glows));
    assert_eq!(said.len(), 1);
    assert!(said[0].contains("emission of a medium"), "{said:?}");
    // Bodies of glass that absorb are filled with what absorbs.
    let amber = "[[material]]\nname = \"amber\"\ntype = \"principled\"\nmetallic = 0\ntransmission = 1\nattenuation_color = [1, 0.5, 0.25]\nattenuation_distance = 2\n\
        [[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"amber\"\n";
    let (text, read, _) = round_trip(&scene(amber));
    let medium = within(&read, 0).unwrap_or_else(|| panic!("no medium\n{text}"));
    let expected = [0.0, 0.5_f64.ln() / -2.0, 0.25_f64.ln() / -2.0];
    let difference = (medium.absorption - crate::spectrum::Spectrum::from_rgb(expected)).map(f64::abs).max_component();
    assert!(difference < 1e-12 && medium.scattering.is_black(), "{medium:?}");
}

/// Grids are written as files of Mitsuba's.
#[test]
fn grids_come_back() {
    let cloud = |keys: &str| {
        format!(
            "[[medium]]\nname = \"cloud\"\n{keys}density = {{ resolution = [2, 1, 3], values = [0, 1, 2, 3, 4, 5], bounds = [[-1, 0, 0], [1, 2, 2]], scale = 2 }}\n\
             [[material]]\nname = \"hull\"\ntype = \"pass\"\ninterior = \"cloud\"\n[[shape]]\ntype = \"box\"\nmin = [-2, -2, -2]\nmax = [2, 2, 2]\nmaterial = \"hull\"\n"
        )
    };
    let tints = "mean_free_path = 0.5\nalbedo_grid = { resolution = [1, 2, 1], values = [0.25, 0.5, 0.75, 1, 0.5, 0], filter = \"nearest\", outside = \"border\" }\n";
    for keys in ["absorption = 1\nscattering = 3\n", "absorption = [1, 2, 3]\nscattering = [3, 1, 1]\n", tints] {
        let scene = scene(&cloud(keys));
        let (text, read, said) = round_trip(&scene);
        assert_eq!(said, Vec::<String>::new(), "{text}");
        let (was, is) = (&scene.media[0], within(&read, 0).expect("a medium"));
        let mut largest = 0.0_f64;
        for point in [[-0.9, 0.3, 0.1], [0.2, 1.9, 1.0], [0.7, 1.1, 1.8], [0.5, 0.5, 3.0]].map(DVec3::from_array) {
            let at = |medium: &Medium| {
                let grids = medium.grids.as_ref().expect("grids");
                let density = medium.extinction() * grids.density().value_at(point);
                let albedo = grids.albedo().map(|albedo| albedo.value_at(point));
                [density, density * albedo.unwrap_or(share_scattered(medium.scattering, medium.extinction()))]
            };
            for (was, is) in at(was).into_iter().zip(at(is)) {
                // Voxels have single precision.
                assert!((was - is).map(f64::abs).max_component() < 1e-5, "{point}: {is} instead of {was}\n{text}");
                largest = largest.max(is.max_component());
            }
        }
        assert!(largest > 5.0, "the points show something");
    }
    let glows = cloud("absorption = 1\nemission = 3\ntemperature = { resolution = [1, 1, 1], values = [3000] }\n");
    assert!(round_trip(&scene(&glows)).2.iter().any(|said| said.contains("emission of a medium")));
    let endless = cloud("absorption = 1\n").replace("scale = 2", "outside = \"border\"");
    assert!(round_trip(&scene(&endless)).2.iter().any(|said| said.contains("outside of its grid")));
}
