//! Scenes that use what the built-in ones do not: textures, interpolated normals, every shape and light, transforms, mirroring.

use std::fmt::Write as _;
use std::path::PathBuf;

use gpt::cpu::ReferenceRenderer;
use gpt::load;
use gpt::plan::{PlanOptions, StageMode, TraversalChoice};
use gpt::renderer::{RenderRequest, Renderer, Silent};
use gpt::scene::{Estimator, Scene};

use super::assert_agrees;
use super::strategies::compare_unequal;
use crate::common::effort::in_full;

/// A folder with a small colourful texture in it.
fn folder_with_texture() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let texture = image::RgbImage::from_fn(8, 5, |x, y| image::Rgb([(x * 30) as u8, (y * 50) as u8, (x * y * 7 + 20) as u8]));
    texture.save(folder.path().join("texture.png")).expect("the texture is written");
    folder
}

fn load(text: &str, folder: &tempfile::TempDir) -> Scene {
    load::load_toml_str(text, "features", folder.path()).unwrap_or_else(|error| panic!("{error}"))
}

const HEAD: &str = r#"
[film]
size = [48, 36]
[render]
spp = 8
max_depth = 6
[camera]
position = [0.3, 2.2, 6]
look_at = [0, 0.8, 0]
vfov = 45
[[texture]]
name = "picture"
type = "image"
file = "texture.png"
wrap = "mirror"
scale = [1.7, 2.3]
[[texture]]
name = "sharp"
type = "image"
file = "texture.png"
filter = "nearest"
wrap = "clamp"
wrap_v = "mirror"
[[material]]
name = "painted"
type = "diffuse"
reflectance = { texture = "picture" }
[[material]]
name = "tiled"
type = "diffuse"
reflectance = { texture = "sharp" }
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.6
[[material]]
name = "ice"
type = "glass"
ior = 1.31
transmittance = [0.9, 1, 0.95]
[[material]]
name = "warm"
type = "diffuse"
reflectance = 0.3
emission = [2, 1.5, 1]
emission_two_sided = true
[[material]]
name = "lamp"
type = "emissive"
radiance = [9, 8, 7]
[[material]]
name = "gone"
type = "pass"
"#;

/// A wavy grid with texture coordinates, as an inline mesh.
fn wave(material: &str, smooth: bool, transform: &str) -> String {
    let side = 12_usize;
    let (mut positions, mut uvs, mut faces) = (String::new(), String::new(), String::new());
    for y in 0..=side {
        for x in 0..=side {
            let (u, v) = (x as f64 / side as f64, y as f64 / side as f64);
            let _ = write!(positions, "[{}, {}, {}],", 2.0 * u - 1.0, 0.15 * (7.0 * u).sin() * (5.0 * v).cos(), 1.0 - 2.0 * v);
            let _ = write!(uvs, "[{u}, {v}],");
        }
    }
    for y in 0..side {
        for x in 0..side {
            let at = |dx: usize, dy: usize| (y + dy) * (side + 1) + x + dx;
            let _ = write!(faces, "[{}, {}, {}],[{}, {}, {}],", at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1));
        }
    }
    format!(
        "[[shape]]\ntype = \"mesh\"\nmaterial = \"{material}\"\nsmooth = {smooth}\ntransform = {transform}\n\
         positions = [{positions}]\nuvs = [{uvs}]\nfaces = [{faces}]\n"
    )
}

const SHAPES: &str = r#"
[[shape]]
type = "plane"
point = [0, -0.4, 0]
normal = [0, 2, 0]
material = "grey"
[[shape]]
type = "disk"
center = [-1.6, 1, -0.5]
normal = [1, 0.2, 1]
radius = 0.6
material = "warm"
[[shape]]
type = "box"
min = [-0.3, 0, -0.3]
max = [0.3, 0.7, 0.3]
material = "ice"
transform = [{ rotate = [0, 1, 0], degrees = 25 }, { translate = [1.2, 0.1, 1] }]
[[shape]]
type = "sphere"
center = [0, 0, 0]
radius = 0.25
material = "lamp"
transform = [{ scale = 1.4 }, { translate = [-0.4, 2.4, 0.6] }]
[[shape]]
type = "rectangle"
corner = [0.8, 1.6, -1]
edge_u = [0.7, 0, 0.3]
edge_v = [0, -0.1, 0.8]
material = "lamp"
transform = [{ scale = [-1, 1, 1] }]
[[shape]]
type = "rectangle"
corner = [-2, -0.3, -2]
edge_u = [4, 0, 0]
edge_v = [0, 3, -0.4]
material = "tiled"
[[shape]]
type = "sphere"
center = [0, 1, 3]
radius = 0.5
material = "gone"
[[light]]
type = "point"
position = [2, 3, 2]
intensity = [4, 5, 6]
[[light]]
type = "environment"
radiance = [0.1, 0.12, 0.2]
"#;

fn everything(folder: &tempfile::TempDir) -> Scene {
    let smooth = wave("painted", true, "[{ translate = [0, 0.3, 0] }]");
    let mirrored = wave("painted", false, "[{ scale = [-0.5, 0.5, 0.5] }, { translate = [1.5, 1.3, -0.6] }]");
    let glowing = wave("warm", true, "[{ scale = 0.3 }, { rotate = [1, 0, 0], degrees = 80 }, { translate = [-1, 0.6, 1.4] }]");
    load(&[HEAD, &smooth, &mirrored, &glowing, SHAPES].concat(), folder)
}

#[test]
fn every_shape_light_and_texture_agrees() {
    let folder = folder_with_texture();
    let scene = everything(&folder);
    for stages in [StageMode::Fused, StageMode::Wavefront] {
        let options = PlanOptions { stages: Some(stages), ..PlanOptions::default() };
        assert_agrees(&format!("everything, {stages:?}"), &scene, &options);
    }
}

/// A bent sheet of 3 × 3 squares and its two sets of coordinates, of which the second lies across the first; `names` are the keys that have them.
fn sheet(names: [&str; 2], keys: &str) -> String {
    let (mut positions, mut sets, mut faces) = (Vec::new(), [Vec::new(), Vec::new()], Vec::new());
    for (row, column) in (0..4).flat_map(|row| (0..4).map(move |column| (f64::from(row) / 3.0, f64::from(column) / 3.0))) {
        positions.push([2.0 * column - 1.0, 0.4 * (3.0 * column + 2.0 * row).sin(), 2.0 * row - 1.0]);
        sets[0].push([column, row]);
        sets[1].push([0.7 * row + 0.1, 1.3 * column - 0.4 * row]);
    }
    for corner in (0..9).map(|square| square / 3 * 4 + square % 3) {
        faces.extend([[corner, corner + 4, corner + 1], [corner + 1, corner + 4, corner + 5]]);
    }
    let written = names.iter().zip(sets).filter(|(name, _)| !name.is_empty());
    let uvs: Vec<String> = written.map(|(name, uvs)| format!("{name} = {uvs:?}\n")).collect();
    format!("type = \"mesh\"\npositions = {positions:?}\nfaces = {faces:?}\n{}{keys}", uvs.concat())
}

/// Materials that look everything up by the second coordinates, beside some that look up by both and by the first; `by` is the texture's key.
fn by_second(by: &str) -> String {
    format!(
        "[[texture]]\nname = \"second\"\ntype = \"image\"\nfile = \"texture.png\"\nscale = [1.5, 2]\n{by}\n\
         [[material]]\nname = \"other\"\ntype = \"diffuse\"\nreflectance = {{ texture = \"second\" }}\n\
         [[material]]\nname = \"holes\"\ntype = \"diffuse\"\nreflectance = {{ texture = \"second\" }}\nopacity = {{ texture = \"second\", channel = \"r\" }}\n\
         [[material]]\nname = \"shining\"\ntype = \"emissive\"\nradiance = {{ texture = \"second\", factor = 4 }}\n\
         [[material]]\nname = \"rough\"\ntype = \"conductor\"\nreflectance = 0.9\nroughness = {{ texture = \"second\", channel = \"g\" }}\n"
    )
}

/// Sheets by their second coordinates: of each material, moving, mirrored, in a group, and beside shapes that have one set.
fn sheets(names: [&str; 2], by: &str) -> String {
    let at = |x: f64, y: f64, more: &str| {
        format!(
            "transform = [{{ scale = 0.6 }}, {{ rotate = [1, 0.4, 0], degrees = 60 }}, {{ translate = [{x}, {y}, 0.6] }}]\n{more}"
        )
    };
    let shape = |material: &str, place: String| {
        format!("[[shape]]\n{}material = \"{material}\"\n{place}", sheet(names, "smooth = false\n"))
    };
    [
        by_second(by),
        shape("other", at(-1.6, 0.7, "")),
        shape("holes", at(0.0, 0.7, "motion = { translate = [0.2, 0.1, 0] }\n")),
        shape("shining", at(1.6, 1.9, "")),
        shape("rough", at(1.6, 0.5, "").replace("scale = 0.6", "scale = [-0.6, 0.5, 0.6]")),
        format!(
            "[[group]]\nname = \"sheets\"\n[[group.shape]]\n{}material = \"other\"\n[[instance]]\ngroup = \"sheets\"\n{}",
            sheet(names, "smooth = false\n"),
            at(-1.6, 1.9, "")
        ),
        "[[shape]]\ntype = \"rectangle\"\ncorner = [-4, 0, 4]\nedge_u = [8, 0, 0]\nedge_v = [0, 0, -8]\nmaterial = \"other\"\n"
            .to_owned(),
    ]
    .concat()
}

/// Sheets bent by their second coordinates: by normals, one of them mirrored, by heights, and of a coat; one is placed as an instance.
fn bent_sheets(names: [&str; 2], by: &str) -> String {
    let materials = format!(
        "[[texture]]\nname = \"relief\"\ntype = \"image\"\nfile = \"texture.png\"\ncolor_space = \"linear\"\nscale = [0.8, 1.2]\n{by}\n\
         [[material]]\nname = \"bent\"\ntype = \"diffuse\"\nreflectance = 0.7\nnormal_map = \"relief\"\nnormal_scale = 0.6\n\
         [[material]]\nname = \"bumpy\"\ntype = \"diffuse\"\nreflectance = 0.7\nbump_map = \"relief\"\nbump_scale = 0.3\n\
         [[material]]\nname = \"coated\"\ntype = \"principled\"\nbase_color = 0.2\nmetallic = 0\nroughness = 0.7\n\
         clearcoat = 1\nclearcoat_roughness = 0.4\ncoat_normal_map = \"relief\"\ncoat_normal_scale = 0.6\n"
    );
    let at = |scale: &str, x: f64, y: f64| {
        format!(
            "transform = [{{ scale = {scale} }}, {{ rotate = [1, 0.4, 0], degrees = 60 }}, {{ translate = [{x}, {y}, 0.6] }}]\n"
        )
    };
    let shape = |material: &str, place: String| {
        format!("[[shape]]\n{}material = \"{material}\"\n{place}", sheet(names, "smooth = false\n"))
    };
    [
        materials,
        shape("bent", at("[-0.8, 0.7, 0.8]", -1.2, 0.3)),
        shape("bumpy", at("0.8", 1.2, 0.3)),
        shape("coated", at("0.8", -0.8, 1.8)),
        format!(
            "[[group]]\nname = \"sheets\"\n[[group.shape]]\n{}material = \"bumpy\"\n[[instance]]\ngroup = \"sheets\"\nmaterial = \"coated\"\n{}",
            sheet(names, "smooth = false\n"),
            at("[0.7, 0.8, 0.8]", 1.2, 1.8)
        ),
    ]
    .concat()
}

#[test]
fn maps_of_normals_and_heights_by_second_coordinates_agree() {
    second_coordinates_agree(bent_sheets, StageMode::Fused);
}

#[test]
fn second_texture_coordinates_agree() {
    second_coordinates_agree(sheets, StageMode::Wavefront);
}

/// The textures of the scene lie by the second of two sets of coordinates, by the only set, and by the first.
/// The short form runs one way.
fn second_coordinates_agree(sheets: fn([&str; 2], &str) -> String, way: StageMode) {
    let folder = folder_with_texture();
    let light = "[[light]]\ntype = \"environment\"\nradiance = 0.5\n";
    let load = |parts: &[&str]| {
        let mut scene = load(&parts.concat(), &folder);
        (scene.film.size, scene.render.spp) = ([32, 24], 6);
        scene
    };
    let scene = load(&[HEAD, &sheets(["uvs", "second_uvs"], "second_uvs = true"), light]);
    let everywhere = in_full("second coordinates by either way to run");
    for stages in [StageMode::Fused, StageMode::Wavefront].into_iter().filter(|stages| everywhere || *stages == way) {
        let options = PlanOptions { stages: Some(stages), ..PlanOptions::default() };
        assert_agrees(&format!("second coordinates, {stages:?}"), &scene, &options);
    }
    // A texture that lies by the only coordinates of its meshes gives an equal scene.
    let only = load(&[HEAD, &sheets(["", "uvs"], ""), light]);
    let first = load(&[HEAD, &sheets(["uvs", "second_uvs"], ""), light]);
    let by_reference = |scene: &Scene| {
        let mut pixels = Vec::new();
        let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..scene.render.spp };
        let mut renderer = ReferenceRenderer::new(scene).expect("the scene is supported");
        let mut on_band = |band: gpt::film::Band| {
            pixels.extend(band.mean.iter().map(|pixel| pixel.map(f32::to_bits)));
            Ok(())
        };
        renderer.render(&request, &Silent, &mut on_band).expect("rendering succeeds");
        pixels
    };
    // Lamps are chosen by the texels on them where the coordinates are the first.
    let (mut scene, mut only, mut first) = (scene, only, first);
    for scene in [&mut scene, &mut only, &mut first] {
        scene.render.estimator = Estimator::Bsdf;
    }
    let expected = by_reference(&only);
    assert!(by_reference(&scene) == expected);
    assert!(by_reference(&first) != expected, "first coordinates show the same");
    let Some(verdict) = compare_unequal(&scene, &first) else { return };
    assert!(verdict.matching_share() < 0.97, "the first coordinates, and nobody notices: {verdict:#?}");
}

#[test]
fn analytic_shapes_agree_as_constants_and_in_the_hierarchy() {
    let folder = folder_with_texture();
    let scene = load(&[HEAD, SHAPES].concat(), &folder);
    for traversal in [TraversalChoice::Auto, TraversalChoice::Bvh] {
        let options = PlanOptions { traversal, ..PlanOptions::default() };
        assert_agrees(&format!("analytic shapes, {traversal:?}"), &scene, &options);
    }
}

/// A model with its material library, textured, through the OBJ reader.
#[test]
fn a_textured_model_agrees() {
    let folder = folder_with_texture();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("the file is written");
    write(
        "tent.obj",
        "mtllib tent.mtl\nv -1 0 0\nv 1 0 0\nv 0 1.4 -0.6\nv 0 0.2 1\nvt 0 0\nvt 1 0\nvt 0.5 1\nvn 0 0.4 0.9\nvn 0.3 0.4 0.9\n\
         usemtl cloth\nf 1/1/1 2/2/2 3/3/1\nusemtl glow\nf 1/1/1 4/3/2 2/2/1\n",
    );
    write("tent.mtl", "newmtl cloth\nKd 0.8 0.9 0.7\nmap_Kd texture.png\nnewmtl glow\nKd 0.2 0.2 0.2\nKe 1 0.7 0.3\n");
    let path: PathBuf = folder.path().join("tent.obj");
    let mut scene = load::load(path.to_str()).unwrap_or_else(|error| panic!("{error}"));
    scene.film.size = [48, 36];
    scene.render.spp = 8;
    assert_agrees("textured model", &scene, &PlanOptions::default());
}
