//! `[[import]]`: scenes of other programs within one of ours.

use std::f64::consts::FRAC_PI_2;

use glam::DMat3;
use gpt::scene::{Light, MaterialKind, Projection, Scene};
use gpt::spectrum::Spectrum;

use super::gltf::File;
use super::{Folder, picture, refusal};

const LIGHT: &str = "[[light]]\ntype = \"environment\"\nradiance = 0.5\n";
const CAMERA: &str = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nvfov = 50\n";
const BLUE: &str = "[[material]]\nname = \"blue\"\ntype = \"diffuse\"\nreflectance = [0.1, 0.2, 0.9]\n";

fn folder(text: &str) -> Folder {
    let mut file = File::new();
    file.root["materials"][0]["name"] = "red".into();
    Folder::new(&[("a.glb", &file.binary()), ("scene.toml", text.as_bytes())])
}

fn read(text: &str) -> Scene {
    folder(text).valid("scene.toml")
}

#[test]
fn shapes_and_lights_come_along_and_settings_do_not() {
    let scene = read(&format!("{CAMERA}{LIGHT}[[import]]\nfile = \"a.glb\"\n"));
    assert_eq!((scene.shapes.len(), scene.lights.len(), scene.film.size), (1, 2, [512, 512]));
    assert_eq!(scene.camera.position.z, 5.0);
    assert_eq!(scene.materials[scene.shapes[0].material].name, "a/red");
    assert_eq!(scene.name, "scene");
}

#[test]
fn the_files_camera_stands_where_none_is_written() {
    let scene = read(&format!("{LIGHT}[[import]]\nfile = \"a.glb\"\ncamera = \"eye\"\n"));
    assert!(
        matches!(scene.camera.projection, Projection::Perspective { vertical_fov_degrees } if vertical_fov_degrees == 0.7_f64.to_degrees())
    );
    let message = refusal(folder(&format!("{CAMERA}{LIGHT}[[import]]\nfile = \"a.glb\"\ncamera = \"eye\"\n")).load("scene.toml"));
    assert!(message.contains("scene.toml:10:10") && message.contains("[camera]"), "{message}");
    let message = refusal(folder(&format!("{LIGHT}[[import]]\nfile = \"a.glb\"\ncamera = \"ear\"\n")).load("scene.toml"));
    assert!(message.contains("a.glb") && message.contains("`ear`"), "{message}");
}

/// The import, moved, is the scene that has the transform written in it.
#[test]
fn all_of_it_is_moved() {
    let moved =
        format!("{CAMERA}{LIGHT}[[import]]\nfile = \"a.glb\"\ntransform = [{{ scale = 2 }}, {{ translate = [1, 0, 0] }}]\n");
    let by_hand = format!(
        "{CAMERA}{LIGHT}[[material]]\nname = \"m\"\ntype = \"diffuse\"\nreflectance = [0.7, 0.2, 0.1]\n\
         [[shape]]\ntype = \"mesh\"\nmaterial = \"m\"\npositions = [[-1, -1, 0], [1, -1, 0.5], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n\
         transform = [{{ scale = 2 }}, {{ translate = [1, 0, 0] }}]\n\
         [[light]]\ntype = \"point\"\nposition = [3, 4, 6]\nintensity = [40, 20, 10]\n"
    );
    assert_eq!(picture(&read(&moved)), picture(&read(&by_hand)));
    // The control: without the transform.
    assert_ne!(picture(&read(&format!("{CAMERA}{LIGHT}[[import]]\nfile = \"a.glb\"\n"))), picture(&read(&by_hand)));
}

#[test]
fn materials_take_the_place_of_others() {
    let text =
        |theirs: &str| format!("{CAMERA}{LIGHT}{BLUE}[[import]]\nfile = \"a.glb\"\nmaterials = {{ {theirs} = \"blue\" }}\n");
    let scene = read(&text("red"));
    let MaterialKind::Diffuse { reflectance } = scene.materials[scene.shapes[0].material].kind else { panic!("no diffuse") };
    assert_eq!(reflectance, gpt::scene::ColorInput::Constant(Spectrum::new(0.1, 0.2, 0.9)));
    let message = refusal(folder(&text("rod")).load("scene.toml"));
    assert!(message.contains("no material named `rod`"), "{message}");
    let message = refusal(folder(&text("red").replace("\"blue\" }", "\"absent\" }")).load("scene.toml"));
    assert!(message.contains("absent"), "{message}");
}

#[test]
fn the_same_file_may_come_twice() {
    let twice = format!(
        "{CAMERA}{LIGHT}[[import]]\nfile = \"a.glb\"\n[[import]]\nfile = \"a.glb\"\ntransform = [{{ translate = [2, 0, 0] }}]\n"
    );
    let scene = read(&twice);
    assert_eq!((scene.shapes.len(), scene.lights.len()), (2, 3));
    assert_ne!(scene.materials[0].name, scene.materials[1].name);
}

#[test]
fn what_is_wrong_is_told_where_it_stands() {
    for (import, said) in [
        ("file = \"absent.glb\"", "there is no file"),
        ("file = \"scene.toml\"", ".gltf, .glb, .xml or .pbrt"),
        ("file = 3", "expected"),
        ("file = \"a.glb\"\nfoo = 1", "foo"),
        ("file = \"a.glb\"\ntransform = [{ scale = 0 }]", "scale"),
    ] {
        let message = refusal(folder(&format!("{CAMERA}{LIGHT}[[import]]\n{import}\n")).load("scene.toml"));
        assert!(message.contains("scene.toml:") && message.contains(said), "{import}: {message}");
    }
}

const MITSUBA: &str = "<scene version=\"3.0.0\"><shape type=\"sphere\"><float name=\"radius\" value=\"0.5\"/>\
    <bsdf type=\"diffuse\"><texture type=\"checkerboard\" name=\"reflectance\"/></bsdf></shape>\
    <emitter type=\"point\"><point name=\"position\" value=\"1, 2, 3\"/></emitter></scene>";

const FOG: &str = "<scene version=\"3.0.0\"><integrator type=\"volpath\"/><sensor type=\"perspective\"><transform name=\"to_world\">\
    <lookat origin=\"0, 0, 5\" target=\"0, 0, 0\" up=\"0, 1, 0\"/></transform><ref id=\"fog\"/></sensor><medium type=\"homogeneous\" id=\"fog\">\
    <float name=\"sigma_t\" value=\"0.2\"/><phase type=\"hg\"/></medium><shape type=\"sphere\"><bsdf type=\"dielectric\"/><medium type=\"homogeneous\" \
    name=\"interior\"/><ref name=\"exterior\" id=\"fog\"/></shape><emitter type=\"point\"><point name=\"position\" value=\"1, 2, 3\"/></emitter></scene>";

/// Media come along with their names, and the camera keeps the one that it is within: the file by itself, imported, and imported from what is
/// written of it are one picture.
#[test]
fn media_come_along() {
    // Settings stay behind.
    let text = "[render]\nmax_depth = 0\n[film]\nfilter = { type = \"gaussian\", radius = 1.5 }\n[[import]]\nfile = \"a.xml\"\n";
    let folder = Folder::new(&[("a.xml", FOG.as_bytes()), ("scene.toml", text.as_bytes())]);
    let (alone, imported) = (folder.valid("a.xml"), folder.valid("scene.toml"));
    let names = |scene: &Scene| scene.media.iter().map(|medium| medium.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&alone), ["fog", "homogeneous"]);
    assert_eq!(names(&imported), ["a/fog", "a/homogeneous"]);
    assert_eq!(picture(&imported), picture(&alone));
    assert_eq!(picture(&folder.written("scene.toml")), picture(&alone));
    // The control: the same without fog around the camera.
    let clear = FOG.replacen("<ref id=\"fog\"/>", "", 1);
    let folder = Folder::new(&[("a.xml", clear.as_bytes()), ("scene.toml", text.as_bytes())]);
    assert_ne!(picture(&folder.valid("scene.toml")), picture(&alone));
}

/// Every list of a scene file with one entry: its key, and the keys of the entry.
const LISTS: [(&str, &str); 8] = [
    ("texture", "name = \"squares\"; type = \"checker\"; a = 0.2; b = 0.8"),
    ("medium", "name = \"air\"; absorption = 0.1; scattering = 0.2"),
    ("material", "name = \"own\"; type = \"diffuse\"; reflectance = { texture = \"squares\" }; interior = \"air\""),
    ("shape", "type = \"sphere\"; center = [1, 1, 0]; radius = 0.3; material = \"own\"; node = \"mover\""),
    (
        "group",
        "name = \"pair\"; shape = [{ type = \"mesh\", positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], faces = [[0, 1, 2]], uvs = [[0, 0], [1, 0], [0, 1]], material = \"own\" }]",
    ),
    ("instance", "group = \"pair\"; transform = [{ translate = [-1, 0.5, 0] }]"),
    ("light", "type = \"environment\"; radiance = 0.5"),
    ("node", "name = \"mover\"; keyframes = [{ time = 0, translate = [0, 0, 0] }, { time = 1, translate = [1, 0, 0] }]"),
];

/// The scene with these lists written inline, the others as tables. `import` is inline where `inline_import` says so.
fn mixed(imported: &str, inline: &dyn Fn(&str) -> bool, inline_import: bool) -> String {
    let (mut head, mut tail) = (String::new(), String::new());
    for (key, entry) in LISTS {
        if inline(key) {
            head += &format!("{key} = [\n  {{ {} }},\n]\n", entry.replace(';', ","));
        } else {
            tail += &format!("[[{key}]]\n{}\n", entry.replace("; ", "\n"));
        }
    }
    if inline_import {
        head += &format!("import = [{{ file = \"{imported}\" }}]\n");
    } else {
        tail += &format!("[[import]]\nfile = \"{imported}\"\n");
    }
    format!("camera = {{ position = [0, 0, 5], look_at = [0, 0, 0], vfov = 50 }}\n{head}{tail}")
}

/// Lists written inline and as tables stand beside every kind of import alike.
#[test]
fn lists_of_either_form_stand_beside_imports() {
    let model = File::new().binary();
    let json = File::new().text();
    for imported in ["a.glb", "a.gltf", "a.xml"] {
        let read = |text: &str| {
            let files =
                [("a.glb", &model[..]), ("a.gltf", &json), ("a.xml", MITSUBA.as_bytes()), ("scene.toml", text.as_bytes())];
            Folder::new(&files).valid("scene.toml")
        };
        let tables = read(&mixed(imported, &|_| false, false));
        assert_eq!((tables.shapes.len(), tables.lights.len(), tables.instances.len()), (2, 2, 1), "{imported}");
        let expected = picture(&tables);
        for inline_import in [false, true] {
            assert_eq!(picture(&read(&mixed(imported, &|_| true, inline_import))), expected, "{imported}");
            for (only, _) in LISTS {
                let scene = read(&mixed(imported, &|key| key == only, inline_import));
                assert_eq!(picture(&scene), expected, "{imported}: {only} inline");
            }
        }
        // The control: without its own light the scene is darker.
        let darker = mixed(imported, &|_| true, true).replace("radiance = 0.5", "radiance = 0.1");
        assert_ne!(picture(&read(&darker)), expected, "{imported}");
    }
}

/// Mistakes in either form are told in the line in which they stand, and so are those of lists that are none.
#[test]
fn mistakes_beside_imports_are_told_in_their_lines() {
    let refused = |text: &str| refusal(folder(text).load("scene.toml"));
    for (key, entry) in LISTS {
        for inline in [true, false] {
            let text = mixed("a.glb", &|other| inline || other != key, inline);
            let wrong = entry.replacen(" = ", "x = ", 1);
            let text = if inline {
                text.replace(&entry.replace(';', ","), &wrong.replace(';', ","))
            } else {
                text.replace(&entry.replace("; ", "\n"), &wrong.replace("; ", "\n"))
            };
            let unknown = wrong.split(" = ").next().expect("a key");
            let line = 1 + text.lines().position(|line| line.contains(&format!("{unknown} = "))).expect("it is written");
            let message = refused(&text);
            // A kind that is missing is told about its table.
            let near = [line, line - 1].map(|line| format!("scene.toml:{line}:"));
            assert!(near.iter().any(|place| message.contains(place)), "{key}, inline {inline}: {line}: {message}\n{text}");
        }
        let text = mixed("a.glb", &|_| true, true).replace(&format!("{key} = [\n"), &format!("{key} = 5\nother = [\n"));
        let message = refused(&text);
        let line = 1 + text.lines().position(|line| line == format!("{key} = 5")).expect("it is written");
        assert!(message.contains(&format!("scene.toml:{line}:")), "{key}: {message}");
    }
}

/// An environment is a light of the scene that says so, and not a name that reads like one.
#[test]
fn a_name_like_sky_is_no_environment() {
    let mut file = File::new();
    file.root["materials"][0]["name"] = "sky".into();
    let xml = "<scene version=\"3.0.0\"><shape type=\"sphere\"/><emitter type=\"constant\"/></scene>";
    let text = format!(
        "{CAMERA}[[material]]\nname = \"sky\"\ntype = \"diffuse\"\nreflectance = 0.5\n[[import]]\nfile = \"a.xml\"\n[[light]]\ntype = \"point\"\nposition = [0, 0, 9]\nintensity = 1\n"
    );
    let scene = Folder::new(&[("a.xml", xml.as_bytes()), ("scene.toml", text.as_bytes())]).valid("scene.toml");
    assert_eq!(scene.lights.len(), 2);
    let own = text.replace("type = \"point\"\nposition = [0, 0, 9]\nintensity = 1", "type = \"environment\"\nradiance = 1");
    let scene = Folder::new(&[("a.xml", xml.as_bytes()), ("scene.toml", own.as_bytes())]).valid("scene.toml");
    assert_eq!(scene.lights.len(), 1);
}

/// A map of an import is turned with all of it, about any axis.
#[test]
fn maps_are_turned_along() {
    let map = |file: &str, transform: &str| {
        let turn = r#"<transform name="to_world"><rotate x="1" angle="90"/></transform>"#;
        let turn = if file == "lies" { turn } else { "" };
        let xml = format!(
            r#"<scene version="3.0.0"><emitter type="envmap"><string name="filename" value="m.png"/>{turn}</emitter>
            <shape type="sphere"/></scene>"#
        );
        let text = format!("{CAMERA}[[import]]\nfile = \"a.xml\"\n{transform}");
        let folder = Folder::new(&[("a.xml", xml.as_bytes()), ("scene.toml", text.as_bytes())]);
        image::RgbImage::new(8, 4).save(folder.path("m.png")).expect("a picture");
        let scene = folder.valid("scene.toml");
        let found = scene.lights.iter().find_map(|light| match light {
            Light::Environment(map) => Some((map.turn.unwrap_or_default(), map.rotation_degrees)),
            _ => None,
        });
        found.expect("an environment")
    };
    let lies = DMat3::from_rotation_x(FRAC_PI_2);
    let (rest, degrees) = map("lies", "");
    assert!(rest.abs_diff_eq(lies, 1e-12) && degrees == 0.0, "{rest}");
    let transform = "transform = [{ scale = 2 }, { rotate = [0, 0, 1], degrees = 90 }]\n";
    let (turned, _) = map("lies", transform);
    assert!(turned.abs_diff_eq(DMat3::from_rotation_z(FRAC_PI_2) * lies, 1e-12), "{turned}");
    assert!(!turned.abs_diff_eq(lies * DMat3::from_rotation_z(FRAC_PI_2), 0.1), "the control: the other order");
    assert!(map("stands", transform).0.abs_diff_eq(DMat3::from_rotation_z(FRAC_PI_2), 1e-12));
    // About +Y, the angle alone says so.
    let (upright, degrees) = map("stands", "transform = [{ rotate = [0, 1, 0], degrees = 30 }]\n");
    assert!(upright == DMat3::IDENTITY && (degrees - 30.0).abs() < 1e-9, "{upright} {degrees}");
}
