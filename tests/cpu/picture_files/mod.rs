//! Picture files whose headers change what their pixels mean or where they lie: each reader has the same truth for every pixel, or a warning.

mod coded;
mod exr_bytes;
mod open_exr;
mod radiance;

use std::path::Path;

use gpt::load::{self, LoadOptions};
use gpt::output::{ReadPicture, read_picture};
use gpt::scene::{EnvironmentRadiance, Light, Scene, TextureKind};

/// A picture of these bytes, read as `gpt compare` and others do, and as textures are; which both have to show.
fn read(name: &str, bytes: &[u8]) -> ReadPicture {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("the picture");
    let picture = read_picture(&path).unwrap_or_else(|error| panic!("{error}"));
    let texture = load::read_image(&path, None).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!([texture.width, texture.height], [picture.image.width, picture.image.height], "{name}");
    for (place, pixel) in picture.image.pixels.iter().enumerate() {
        let texel = texture.texels.color(place).to_array();
        // A negative number is no colour of a texture.
        let same = texel.iter().zip(pixel).all(|(a, b)| (a - b.max(0.0)).abs() <= 1e-5 * (1.0 + b.abs()));
        assert!(same, "{name}: {texel:?} and {pixel:?} at {place}");
    }
    picture
}

/// Why a picture of these bytes is refused, by all readers alike.
fn refusal(name: &str, bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("the picture");
    let of_texture = load::read_image(&path, None).expect_err("it is refused");
    let error = read_picture(&path).expect_err("it is refused").to_string();
    assert!(error.contains(&of_texture), "{error} and {of_texture}");
    error
}

/// Holds a picture against the truth, column and row.
fn expect(picture: &ReadPicture, [width, height]: [u32; 2], tolerance: f32, truth: impl Fn(usize, usize) -> [f32; 3]) {
    assert_eq!([picture.image.width, picture.image.height], [width, height]);
    for (place, pixel) in picture.image.pixels.iter().enumerate() {
        let (column, row) = (place % width as usize, place / width as usize);
        let expected = truth(column, row);
        let is_near = pixel.iter().zip(expected).all(|(a, b)| (a - b).abs() <= tolerance * (1.0 + b.abs()));
        assert!(is_near, "{pixel:?} and not {expected:?} at column {column}, row {row}");
    }
}

/// The scene of this text, whose pictures lie in the folder.
fn scene(folder: &Path, text: &str, strict: bool) -> Result<Scene, String> {
    let path = folder.join("scene.toml");
    std::fs::write(&path, format!("[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\nvfov = 40\n{text}")).expect("the scene");
    let options = LoadOptions { strict, ..LoadOptions::default() };
    load::load_with(Some(path.as_os_str()), &options).map_err(|error| error.to_string())
}

/// A scene that has the file for its environment, and one that has it for a texture.
const AS_MAP: &str = "[[light]]\ntype = \"environment\"\nfile = \"a.exr\"\n";
const AS_TEXTURE: &str =
    "[[texture]]\nname = \"t\"\ntype = \"image\"\nfile = \"a.exr\"\n[[light]]\ntype = \"environment\"\nradiance = 1\n";

/// The map of the scene's environment, its rows and how it is turned.
fn environment(scene: &Scene) -> &gpt::scene::Environment {
    match &scene.lights[0] {
        Light::Environment(environment) => environment,
        other => panic!("{other:?}"),
    }
}

fn texel(scene: &Scene, column: u32, row: u32) -> [f32; 3] {
    let image = match (&scene.textures.first().map(|texture| &texture.kind), scene.lights.first()) {
        (Some(TextureKind::Image(image)), _) => &image.image,
        (_, Some(Light::Environment(environment))) => match &environment.radiance {
            EnvironmentRadiance::Map(image) => image,
            other => panic!("{other:?}"),
        },
        other => panic!("{other:?}"),
    };
    image.texels.color((row * image.width + column) as usize).to_array()
}

/// Every header that is named is a warning, which `strict` refuses, as a texture and as an environment.
fn expect_named(name: &str, bytes: &[u8], word: &str) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join(name), bytes).expect("the picture");
    for text in [AS_MAP, AS_TEXTURE] {
        let text = text.replace("a.exr", name);
        let warnings = scene(folder.path(), &text, false).unwrap_or_else(|error| panic!("{error}")).warnings;
        let named = warnings.iter().filter(|warning| warning.contains(word) && warning.contains(name)).count();
        assert_eq!(named, 1, "{word}: {warnings:?}");
        let refused = scene(folder.path(), &text, true).expect_err("strict refuses");
        assert!(refused.contains(word), "{refused}");
    }
    let read = read_picture(&folder.path().join(name)).expect("it can be read");
    assert!(read.notes.iter().any(|note| note.contains(word)), "{word}: {:?}", read.notes);
}
