//! `[[import]]`: scenes of other programs within one of ours.

use gpt::scene::{MaterialKind, Projection, Scene};

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
    assert_eq!(reflectance, gpt::scene::ColorInput::Constant(glam::DVec3::new(0.1, 0.2, 0.9)));
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
        ("file = \"scene.toml\"", ".gltf, .glb or .xml"),
        ("file = 3", "expected"),
        ("file = \"a.glb\"\nfoo = 1", "foo"),
        ("file = \"a.glb\"\ntransform = [{ scale = 0 }]", "scale"),
    ] {
        let message = refusal(folder(&format!("{CAMERA}{LIGHT}[[import]]\n{import}\n")).load("scene.toml"));
        assert!(message.contains("scene.toml:") && message.contains(said), "{import}: {message}");
    }
}
