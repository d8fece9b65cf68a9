//! Files of other programs, by their endings: what they are, and which program turns them into what is read here.

use std::path::Path;

/// Formats that are read as scenes.
pub const SCENES: &str =
    "scene files (.toml), models (.obj, .ply), glTF (.gltf, .glb), and scenes of Mitsuba (.xml) and pbrt (.pbrt)";
/// The endings of models' names, as a sentence has them.
pub const MODEL_ENDINGS: &str = ".obj, .ply or .ply.gz";

const BLENDER: &str = "Blender reads it and exports Wavefront OBJ, with its materials as MTL (File > Export > Wavefront)";
const BLENDER_USD: &str = "Blender imports USD and exports Wavefront OBJ (File > Export > Wavefront)";
const ASSIMP: &str = "`assimp export MODEL model.obj` (assimp-utils) or Blender makes an OBJ file of it";
const MESHLAB: &str = "MeshLab or `assimp export MODEL model.obj` (assimp-utils) makes an OBJ file of it";
const MAGICK: &str = "ImageMagick makes a PNG of it: `magick PICTURE picture.png`";
const PICTURE: &str = "a scene file names it, as an environment or a texture: see `gpt check --schema`";

/// Ending, what such a file is, and what to do.
const MODELS: [(&[&str], &str, &str); 5] = [
    (&["stl", "off"], "a model of bare triangles", MESHLAB),
    (&["usd", "usda", "usdc", "usdz"], "a USD scene", BLENDER_USD),
    (&["fbx", "dae", "3ds", "x3d", "lwo"], "a model", ASSIMP),
    (&["blend", "abc"], "a Blender or Alembic scene", BLENDER),
    (&["mtl"], "a material library, which an OBJ file names", "name the OBJ file"),
];
const READ_PICTURES: (&[&str], &str, &str) =
    (&["png", "jpg", "jpeg", "exr", "hdr", "tif", "tiff", "bmp", "tga", "webp", "gif", "ppm", "pgm"], "a picture", PICTURE);
const UNREAD_PICTURES: [(&[&str], &str, &str); 2] = [
    (
        &["dds", "ktx", "ktx2", "psd", "xcf", "svg", "avif", "heic", "jxl", "jp2"],
        "a picture in a format that is not read",
        MAGICK,
    ),
    (&["tx", "rat"], "a tiled texture", "`oiiotool TEXTURE -o texture.exr` (openimageio-tools) makes an EXR of it"),
];

/// The format of a file that is not a scene, and advice on using it.
pub fn advice(path: &Path) -> Option<(&'static str, &'static str)> {
    of_ending(path, MODELS.iter().chain([&READ_PICTURES]).chain(&UNREAD_PICTURES))
}

/// Advice on a picture in a format that is not read.
pub fn unread_picture(path: &Path) -> Option<&'static str> {
    of_ending(path, UNREAD_PICTURES.iter()).map(|(_, advice)| advice)
}

type Row = (&'static [&'static str], &'static str, &'static str);

fn of_ending<'r>(path: &Path, mut rows: impl Iterator<Item = &'r Row>) -> Option<(&'static str, &'static str)> {
    let ending = path.extension()?.to_string_lossy().to_ascii_lowercase();
    rows.find(|(endings, ..)| endings.contains(&ending.as_str())).map(|(_, what, advice)| (*what, *advice))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_are_known_in_any_case() {
        assert_eq!(advice(Path::new("a.FBX")).map(|(what, _)| what), Some("a model"));
        assert!(advice(Path::new("a.dds")).is_some_and(|(_, advice)| advice.contains("magick")));
        assert_eq!(advice(Path::new("glb")), None);
    }
}
