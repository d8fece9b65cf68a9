//! Ways of sampling the same light make the same picture: Welch's t-test on every tile and the whole picture, over replications.

use std::sync::Arc;

use glam::Vec3;
use gpt::compare::image_tests::{Picture, TileSettings, compare_replications};
use gpt::film::Band;
use gpt::load;
use gpt::reference::ReferenceRenderer;
use gpt::renderer::{RenderRequest, Renderer, Silent};
use gpt::scene::{
    Estimator, ImageData, ImageTexture, LightChoice, LightSampling, Scene, TextureFilter, TextureKind, TextureWrap,
};

const SIDE: u32 = 24;
const REPLICATIONS: u32 = 12;

const SCENE: &str = r#"
[film]
size = [24, 24]
[render]
spp = 64
max_depth = 3
[camera]
position = [0, 2, 5]
look_at = [0, 0.7, 0]
vfov = 40
[[material]]
name = "white"
type = "diffuse"
reflectance = 0.7
[[material]]
name = "lamp"
type = "emissive"
radiance = [6, 5, 4]
[[material]]
name = "gone"
type = "pass"
[[shape]]
type = "rectangle"
corner = [-5, 0, 5]
edge_u = [10, 0, 0]
edge_v = [0, 0, -10]
material = "white"
[[shape]]
type = "sphere"
center = [-0.5, 0.6, 0]
radius = 0.6
material = "white"
"#;

const LAMP: &str = "[[shape]]\ntype = \"sphere\"\ncenter = [0.8, 1.8, 0.7]\nradius = 0.5\nmaterial = \"lamp\"\n";
const SKY: &str = "[[light]]\ntype = \"sky\"\nzenith = [0.3, 0.5, 1]\nhorizon = 1\nground = 0.2\n";
const PORTAL: &str = "[[shape]]\ntype = \"box\"\nmin = [1, 0.5, -1]\nmax = [1.5, 2, 2]\nmaterial = \"gone\"\nportal = true\n\
                      [[shape]]\ntype = \"sphere\"\ncenter = [-2, 2, 1]\nradius = 0.7\nmaterial = \"gone\"\nportal = true\n";

fn load(parts: &[&str]) -> Scene {
    let text = [&[SCENE], parts].concat().concat();
    load::load_toml_str(&text, "strategies", std::path::Path::new("")).unwrap_or_else(|error| panic!("{error}"))
}

/// Pictures of independent seeds, the first of which is `first`.
fn replications(scene: &Scene, first: u32) -> Vec<Vec<[f32; 3]>> {
    (first..first + REPLICATIONS)
        .map(|seed| {
            let mut scene = scene.clone();
            scene.render.seed = seed;
            let mut pixels = Vec::new();
            let mut renderer = ReferenceRenderer::new(&scene).expect("the scene is supported");
            let request = RenderRequest { rows: 0..SIDE, samples: 0..scene.render.spp };
            let report = renderer.render(&request, &Silent, &mut |band: Band| {
                pixels.extend(band.mean);
                Ok(())
            });
            assert_eq!(report.expect("rendering succeeds").non_finite_samples, 0);
            pixels
        })
        .collect()
}

fn agree(first: &[Vec<[f32; 3]>], second: &[Vec<[f32; 3]>]) -> bool {
    let [first, second] =
        [first, second].map(|all| all.iter().map(|pixels| Picture { width: SIDE, pixels }).collect::<Vec<Picture>>());
    let settings = TileSettings { tile: 8, ..TileSettings::default() };
    compare_replications(&first, &second, &settings).expect("the pictures are of one size").agrees()
}

/// Each way against the first, and the first with 1 % of energy added against itself.
fn assert_all_agree(ways: Vec<(String, Scene)>) {
    let mut pictures = ways.iter().zip(0..).map(|((_, scene), index)| replications(scene, 1000 * index));
    let first = pictures.next().expect("there is a first way");
    for ((name, _), others) in ways.iter().skip(1).zip(pictures) {
        assert!(agree(&first, &others), "{name} differs from {}", ways[0].0);
        let brighter: Vec<Vec<[f32; 3]>> =
            others.iter().map(|pixels| pixels.iter().map(|pixel| pixel.map(|channel| 1.01 * channel)).collect()).collect();
        assert!(!agree(&first, &brighter), "{name} with 1 % of energy added passes");
    }
}

#[test]
fn spheres_look_the_same_whatever_their_points_are_drawn_by() {
    let ways = [LightSampling::Cone, LightSampling::Visible, LightSampling::Area].into_iter().flat_map(|strategy| {
        [Estimator::Mis, Estimator::Nee].map(|estimator| {
            let mut scene = load(&[LAMP]);
            scene.render.light_sampling = strategy;
            scene.render.estimator = estimator;
            // Points of the whole sphere are mostly hidden or far off the shortest way.
            scene.render.spp *= if strategy == LightSampling::Cone { 1 } else { 4 };
            (format!("{strategy:?}, {estimator:?}"), scene)
        })
    });
    assert_all_agree(ways.collect());
}

#[test]
fn portals_change_no_picture() {
    let mut by_bsdf = load(&[SKY]);
    by_bsdf.render.estimator = Estimator::Bsdf;
    by_bsdf.render.spp *= 2;
    let mut by_lights = load(&[SKY, PORTAL]);
    by_lights.render.estimator = Estimator::Nee;
    by_lights.render.spp *= 2;
    let (with, without) = (load(&[SKY, PORTAL]), load(&[SKY]));
    let named = |name: &str, scene| (name.to_owned(), scene);
    assert_all_agree(vec![
        named("no portal", without),
        named("portals", with),
        named("portals, nee", by_lights),
        named("bsdf", by_bsdf),
    ]);
}

/// Lamps of several kinds and sides among walls, a point and a sky.
const LAMPS: &str = "[[shape]]\ntype = \"rectangle\"\ncorner = [-1, 2, -1]\nedge_u = [1.5, 0, 0]\nedge_v = [0, 0, 1.5]\nmaterial = \"lamp\"\n\
                     [[shape]]\ntype = \"sphere\"\ncenter = [1.6, 0.4, 0.7]\nradius = 0.15\nmaterial = \"lamp\"\n\
                     [[shape]]\ntype = \"disk\"\ncenter = [0.4, 1.5, -1]\nnormal = [0.2, -1, 0.3]\nradius = 0.3\nmaterial = \"lamp\"\n\
                     [[shape]]\ntype = \"mesh\"\npositions = [[-2, 0.5, 0], [-2, 1.5, 0], [-1.9, 0.5, 1]]\nfaces = [[0, 1, 2]]\n\
                     material = \"lamp\"\n[[light]]\ntype = \"point\"\nposition = [-1.5, 0.6, 1.2]\nintensity = 0.4\n";

#[test]
fn a_tree_of_lights_changes_no_picture() {
    let lamps = |light_choice, estimator| {
        let mut scene = load(&[LAMPS, "[[light]]\ntype = \"sky\"\nzenith = 0.2\nhorizon = 0.1\nground = 0\n"]);
        (scene.render.light_choice, scene.render.estimator) = (light_choice, estimator);
        scene
    };
    let named = |name: &str, scene| (name.to_owned(), scene);
    assert_all_agree(vec![
        named("power", lamps(LightChoice::Power, Estimator::Mis)),
        named("tree", lamps(LightChoice::Tree, Estimator::Mis)),
        named("tree, nee", lamps(LightChoice::Tree, Estimator::Nee)),
    ]);
}

#[test]
fn rectangles_look_the_same_whatever_their_points_are_drawn_by() {
    let panel = "[[shape]]\ntype = \"rectangle\"\ncorner = [-1.5, 1.7, -1]\nedge_u = [3, 0, 0]\nedge_v = [0, 0, 2]\nmaterial = \"lamp\"\n";
    let ways = [LightSampling::Area, LightSampling::Cone].into_iter().flat_map(|strategy| {
        [Estimator::Mis, Estimator::Nee].map(|estimator| {
            let mut scene = load(&[panel]);
            (scene.render.light_sampling, scene.render.estimator) = (strategy, estimator);
            (format!("{strategy:?}, {estimator:?}"), scene)
        })
    });
    assert_all_agree(ways.collect());
}

/// A screen of 8 × 8 texels above the floor, and a lamp that is one of its texels.
const SCREEN: &str = "[[texture]]\nname = \"picture\"\ntype = \"checker\"\na = 0\nb = 1\n[[material]]\nname = \"screen\"\ntype = \"emissive\"\n\
                      radiance = { texture = \"picture\", factor = [60, 50, 40] }\n";
const QUAD: &str =
    "[[shape]]\ntype = \"rectangle\"\ncorner = [-2, 1.9, -2]\nedge_u = [4, 0, 0]\nedge_v = [0, 0, 4]\nmaterial = \"screen\"\n";
const TEXEL: &str = "[[material]]\nname = \"bright\"\ntype = \"emissive\"\nradiance = [60, 50, 40]\n\
                     [[shape]]\ntype = \"rectangle\"\ncorner = [0.5, 1.9, 0]\nedge_u = [0.5, 0, 0]\nedge_v = [0, 0, 0.5]\nmaterial = \"bright\"\n";

/// The screen as a mesh of so many squares a side.
fn mesh_of_screen(side: u32) -> String {
    let (mut positions, mut uvs, mut faces) = (Vec::new(), Vec::new(), Vec::new());
    for (row, column) in (0..=side).flat_map(|row| (0..=side).map(move |column| (row, column))) {
        let [u, v] = [column, row].map(|place| f64::from(place) / f64::from(side));
        positions.push([4.0 * u - 2.0, 1.9, 4.0 * v - 2.0]);
        uvs.push([u, v]);
    }
    for corner in (0..side * side).map(|square| square / side * (side + 1) + square % side) {
        faces.extend([[corner, corner + 1, corner + side + 2], [corner, corner + side + 2, corner + side + 1]]);
    }
    format!("[[shape]]\ntype = \"mesh\"\npositions = {positions:?}\nuvs = {uvs:?}\nfaces = {faces:?}\nmaterial = \"screen\"\n")
}

/// The scene with this picture on the screen.
fn with_picture(mut scene: Scene, filter: TextureFilter, texel: impl Fn(u32, u32) -> f32) -> Scene {
    let texels: Vec<Vec3> = (0..64).map(|index| Vec3::splat(texel(index % 8, index / 8))).collect();
    let image = Arc::new(ImageData { width: 8, height: 8, texels: texels.into(), has_alpha: false });
    scene.textures[0].kind = TextureKind::Image(ImageTexture { image, wrap: TextureWrap::Clamp, filter, scale: [1.0, 1.0] });
    scene
}

/// Texel 5 from the left; the screen's v grows towards the viewer, and rows run the other way.
fn one_bright(x: u32, y: u32) -> f32 {
    f32::from(u8::from((x, y) == (5, 3)))
}

#[test]
fn screens_look_the_same_whatever_their_points_are_drawn_by() {
    for (filter, shape) in [
        (TextureFilter::Nearest, QUAD.to_owned()),
        (TextureFilter::Bilinear, QUAD.to_owned()),
        (TextureFilter::Bilinear, mesh_of_screen(3)),
    ] {
        let ways = [Estimator::Bsdf, Estimator::Mis, Estimator::Nee].map(|estimator| {
            let texel = |x, y| if one_bright(x, y) > 0.0 { 1.0 } else { 0.02 * (x + y) as f32 };
            let mut scene = with_picture(load(&[SCREEN, &shape]), filter, texel);
            scene.render.estimator = estimator;
            scene.render.spp *= if estimator == Estimator::Bsdf { 8 } else { 1 };
            (format!("{filter:?}, {estimator:?}"), scene)
        });
        assert_all_agree(ways.to_vec());
    }
}

/// The mean over pixels of the variance over replications.
fn variance(scene: &Scene) -> f64 {
    let pictures = replications(scene, 1);
    let count = pictures.len() as f64;
    let of_pixel = |pixel: usize| {
        let values: Vec<f64> = pictures.iter().map(|picture| f64::from(picture[pixel][1])).collect();
        let mean = values.iter().sum::<f64>() / count;
        values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count - 1.0)
    };
    (0..pictures[0].len()).map(of_pixel).sum::<f64>() / pictures[0].len() as f64
}

/// A screen of which one texel shines has at most twice the error of a lamp of that size.
#[test]
fn a_bright_texel_is_found_as_a_lamp_of_its_size_is() {
    let mut lamp = load(&[TEXEL]);
    lamp.render.max_depth = 2;
    let error_of_lamp = variance(&lamp).sqrt();
    for (name, shape) in [("quad", QUAD.to_owned()), ("mesh", mesh_of_screen(8))] {
        let mut screen = with_picture(load(&[SCREEN, &shape]), TextureFilter::Nearest, one_bright);
        screen.render.max_depth = 2;
        let error = variance(&screen).sqrt();
        assert!(error < 2.0 * error_of_lamp, "{name}: {error} and {error_of_lamp}");
        eprintln!("{name}: {error:.5}, a lamp of its size {error_of_lamp:.5}");
        // The control: what is made of two such materials is drawn evenly.
        let halves = "[[material]]\nname = \"halves\"\ntype = \"blend\"\nmaterials = [\"screen\", \"screen\"]\nweight = { type = \"constant\", value = 0.5 }\n";
        let shape = shape.replace("material = \"screen\"", "material = \"halves\"");
        let mut evenly = with_picture(load(&[SCREEN, halves, &shape]), TextureFilter::Nearest, one_bright);
        evenly.render.max_depth = 2;
        let error_of_even = variance(&evenly).sqrt();
        assert!(error_of_even > 4.0 * error_of_lamp, "{name}: {error_of_even}");
    }
}
