//! Textures and material libraries that are wrong.

use std::path::Path;

use gpt::load;

use super::GOOD;
use crate::common::files::{TRIANGLE, folder_with, png_bytes};

#[test]
fn bad_textures_name_the_key() {
    let folder = folder_with(&[
        ("plain.obj", TRIANGLE.as_bytes()),
        ("uv.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"),
        ("good.png", &png_bytes([255, 0, 0])),
        ("notes.png", b"these are not pixels"),
        ("cut.png", &png_bytes([255, 0, 0])[..40]),
    ]);
    let load = |file: &str, mesh: &str| {
        let texture =
            format!("reflectance = {{ texture = \"t\" }}\n[[texture]]\nname = \"t\"\ntype = \"image\"\nfile = \"{file}\"");
        let text = GOOD
            .replace("reflectance = 0.5", &texture)
            .replace("type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1", &format!("type = \"mesh\"\nfile = \"{mesh}\""));
        load::load_toml_str(&text, "test.toml", folder.path()).map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(load("good.png", "uv.obj"), Ok(()));
    let complaint = |file, mesh| load(file, mesh).err().unwrap_or_default();
    let absent = complaint("absent.png", "uv.obj");
    assert!(absent.starts_with("test.toml:17:8: texture[0].file: ") && absent.contains("cannot be read"), "{absent}");
    let notes = complaint("notes.png", "uv.obj");
    assert!(notes.starts_with("test.toml:17:8: texture[0].file: ") && notes.contains("is not a valid image"), "{notes}");
    assert!(complaint("cut.png", "uv.obj").contains("is not a valid image"));
    let without_uv = complaint("good.png", "plain.obj");
    assert!(
        without_uv.contains("shape[0].material: the material `grey` uses a texture, which needs uv coordinates"),
        "{without_uv}"
    );
}

/// A product has two textures, and their values are those of both.
#[test]
fn bad_products_of_textures_name_the_key() {
    let load = |times: [&str; 2], keys: &str| {
        let texture = |name: &str, value: &str, times: &str| {
            let times = if times.is_empty() { String::new() } else { format!("times = \"{times}\"\n") };
            format!("[[texture]]\nname = \"{name}\"\ntype = \"perlin\"\na = {value}\nb = {value}\n{times}")
        };
        let textures = texture("first", "0.5", times[0]) + &texture("second", "1.5", times[1]);
        let text = GOOD.replace("reflectance = 0.5", &format!("{keys}\n{textures}"));
        load::load_toml_str(&text, "test.toml", Path::new("")).map(|_| ()).map_err(|error| error.to_string())
    };
    let used = "reflectance = { texture = \"first\" }";
    assert_eq!(load(["second", ""], used), Ok(()));
    let bright = load(["second", ""], "reflectance = { texture = \"second\" }").err().unwrap_or_default();
    assert!(bright.contains("found 1.5 in the texture `second`"), "{bright}");
    let bright = load(["second", ""], "reflectance = { texture = \"first\", factor = 2 }").err().unwrap_or_default();
    assert!(bright.contains("found 1.5 in the texture `first` times its factor"), "{bright}");
    for times in [["first", ""], ["second", "first"]] {
        let message = load(times, used).err().unwrap_or_default();
        assert!(message.contains("which is multiplied by another texture itself"), "{message}");
    }
    let message = load(["thrid", ""], used).err().unwrap_or_default();
    assert!(message.contains("thrid"), "{message}");
    let message = load(["second", ""], "reflectance = 0.5\nbump_map = \"first\"").err().unwrap_or_default();
    assert!(message.contains("normal and bump maps cannot be products"), "{message}");
}
