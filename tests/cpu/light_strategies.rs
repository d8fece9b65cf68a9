//! Ways of sampling the same light make the same picture: Welch's t-test on every tile and the whole picture, over replications.

use std::sync::Arc;

use crate::common::effort::in_full;
use glam::Vec3;
use gpt::compare::image_tests::{ImageView, TileSettings, compare_replications};
use gpt::cpu::ReferenceRenderer;
use gpt::film::Band;
use gpt::learn::{Effort, settle};
use gpt::load;
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
        [first, second].map(|all| all.iter().map(|pixels| ImageView { width: SIDE, pixels }).collect::<Vec<ImageView>>());
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
#[ignore = "slow"]
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
#[ignore = "slow"]
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
#[ignore = "slow"]
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
        named("cells", lamps(LightChoice::Cells, Estimator::Mis)),
        named("cells, nee", lamps(LightChoice::Cells, Estimator::Nee)),
    ]);
}

/// Cells choose the environment and its portals as well as lamps and the sun.
#[test]
#[ignore = "slow"]
fn cells_of_lights_at_infinity_change_no_picture() {
    let sun = "[[light]]\ntype = \"directional\"\ndirection = [-0.4, -1, -0.3]\nirradiance = 0.5\n";
    let lit = |light_choice, estimator| {
        let mut scene = load(&[LAMP, SKY, PORTAL, sun]);
        (scene.render.light_choice, scene.render.estimator) = (light_choice, estimator);
        scene.render.spp *= if estimator == Estimator::Nee { 2 } else { 1 };
        scene
    };
    let named = |name: &str, scene| (name.to_owned(), scene);
    assert_all_agree(vec![
        named("power", lit(LightChoice::Power, Estimator::Mis)),
        named("cells", lit(LightChoice::Cells, Estimator::Mis)),
        named("cells, nee", lit(LightChoice::Cells, Estimator::Nee)),
    ]);
}

/// The words by which lights are chosen in cells, if they are.
fn learned(scene: &Scene) -> Option<Vec<u32>> {
    let settled = settle(scene, Effort::default()).expect("the reference can render the scene");
    settled.integrator.and_then(|integrator| integrator.light_cells().map(|cells| cells.words().to_vec()))
}

/// A hall of 8 × 8 small panels, each behind a screen of its own; of one, many triangles.
fn hall(triangles: usize) -> Scene {
    let mut text = String::new();
    for (x, z) in (0..8).flat_map(|x| (0..8).map(move |z| (f64::from(x) - 4.0, f64::from(z) - 4.0))) {
        text += &format!(
            "[[shape]]\ntype = \"rectangle\"\ncorner = [{x}, 3, {z}]\nedge_u = [0.2, 0, 0]\nedge_v = [0, 0, 0.2]\nmaterial = \"lamp\"\n\
             [[shape]]\ntype = \"rectangle\"\ncorner = [{x}, 0.2, {z}]\nedge_u = [0.9, 0, 0]\nedge_v = [0, 2.5, 0]\nmaterial = \"white\"\n"
        );
    }
    if triangles > 0 {
        let place = |corner: usize| [0.1 * (corner % 50) as f64 - 2.5, 4.0, 0.08 * (corner / 50) as f64 - 2.4];
        let positions: Vec<[f64; 3]> = (0..triangles + 51).map(place).collect();
        // None from one end of a row to the other.
        let faces: Vec<[usize; 3]> =
            (0..triangles).filter(|face| face % 50 < 49).map(|face| [face, face + 1, face + 51]).collect();
        text += &format!("[[shape]]\ntype = \"mesh\"\npositions = {positions:?}\nfaces = {faces:?}\nmaterial = \"lamp\"\n");
    }
    let mut scene = load(&[&text]);
    scene.film.size = [256, 256];
    scene
}

/// The seed, the number of samples and the way light is sampled change nothing; the camera and the size of the film do.
#[test]
#[ignore = "slow"]
fn what_is_learned_of_lights_depends_on_the_scene_and_its_film_alone() {
    let scene = hall(0);
    let words = learned(&scene).expect("there are many lights, and `auto` tries them");
    assert_eq!(learned(&scene).as_ref(), Some(&words), "from run to run");
    let mut other = scene.clone();
    (other.render.seed, other.render.spp, other.render.light_choice) = (9, 3, LightChoice::Cells);
    assert_eq!(learned(&other), Some(words.clone()));
    let mut larger = scene.clone();
    larger.film.size = [512, 256];
    let mut moved = scene.clone();
    moved.camera.position.x += 0.5;
    for other in [larger, moved] {
        assert_ne!(learned(&other), Some(words.clone()));
    }
}

/// Lists of lights help where they hold what reaches a place.
#[test]
#[ignore = "slow"]
fn cells_of_lights_are_taken_where_lists_hold_the_light() {
    let choice =
        |scene: &Scene| settle(scene, Effort::default()).expect("the reference can render the scene").scene.render.light_choice;
    assert_eq!(choice(&hall(0)), LightChoice::Cells);
    assert_eq!(choice(&hall(3000)), LightChoice::Tree);
    // Too few samples, one light, nothing sampled.
    let mut small = hall(0);
    small.render.spp = 1;
    let mut by_bsdf = hall(0);
    by_bsdf.render.estimator = Estimator::Bsdf;
    let mut one = load(&[LAMP]);
    one.film.size = [256, 256];
    for scene in [&small, &by_bsdf, &one] {
        assert_eq!(choice(scene), LightChoice::Auto);
        assert_eq!(learned(scene), None);
    }
    for asked_for in [LightChoice::Power, LightChoice::Tree] {
        let mut scene = hall(0);
        scene.render.light_choice = asked_for;
        assert_eq!((choice(&scene), learned(&scene)), (asked_for, None));
    }
}

/// The choice among few lights falls on cells if the light that power prefers does not reach what the others
/// light: a weak lamp beside a strong one behind a wall. It does not if all of them light what is seen, nor
/// if there are several triangles of one lamp.
#[test]
#[ignore = "slow"]
fn cells_of_few_lights_are_taken_where_a_trial_run_finds_them_better() {
    let settled = |parts: &[&str]| {
        let mut scene = load(parts);
        scene.film.size = [256, 256];
        let settled = settle(&scene, Effort::default()).expect("the reference can render the scene");
        let has_cells = settled.integrator.is_some_and(|integrator| integrator.light_cells().is_some());
        assert_eq!(has_cells, settled.scene.render.light_choice == LightChoice::Cells);
        (settled.scene.render.light_choice, settled.because.light_choice)
    };
    let strong = "[[shape]]\ntype = \"rectangle\"\ncorner = [-4, 0.1, -4.5]\nedge_u = [8, 0, 0]\nedge_v = [0, 3, 0]\nmaterial = \"lamp\"\n\
                  [[shape]]\ntype = \"rectangle\"\ncorner = [-6, 0, -4]\nedge_u = [12, 0, 0]\nedge_v = [0, 5, 0]\nmaterial = \"white\"\n";
    let weak = "[[shape]]\ntype = \"sphere\"\ncenter = [0.9, 0.5, 0.7]\nradius = 0.1\nmaterial = \"lamp\"\n";
    let (choice, because) = settled(&[strong, weak]);
    assert_eq!(choice, LightChoice::Cells, "{because:?}");
    let above = |x: &str| LAMP.replace("[0.8, 1.8, 0.7]\nradius = 0.5", &format!("[{x}, 40, 0.7]\nradius = 3"));
    let (choice, because) = settled(&[&above("4"), &above("-4")]);
    assert_eq!(choice, LightChoice::Power, "{because:?}");
    assert!(because.is_some_and(|because| because.contains("error × cost of power")));
    let panel = "[[shape]]\ntype = \"mesh\"\npositions = [[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]]\nfaces = [[0, 1, 2], [0, 2, 3]]\n\
                 material = \"lamp\"\n";
    assert_eq!(settled(&[panel]), (LightChoice::Auto, None));
}

/// A rectangle, and triangles that are level, aslant and upright.
#[test]
#[ignore = "slow"]
fn flat_lamps_look_the_same_whatever_their_points_are_drawn_by() {
    let rectangle = "[[shape]]\ntype = \"rectangle\"\ncorner = [-1.5, 1.7, -1]\nedge_u = [3, 0, 0]\nedge_v = [0, 0, 2]\nmaterial = \"lamp\"\n";
    let triangles = "[[shape]]\ntype = \"mesh\"\nmaterial = \"lamp\"\n\
                     positions = [[-1.5, 1.7, -1], [1.5, 1.7, -1], [1.3, 2, 1], [-2, 0.1, -1.5], [1, 0.1, -1.7], [-1.2, 1.5, -1.6]]\n\
                     faces = [[0, 1, 2], [3, 4, 5]]\n";
    for lamp in [rectangle, triangles] {
        let ways = [LightSampling::Area, LightSampling::Cone].into_iter().flat_map(|strategy| {
            [Estimator::Mis, Estimator::Nee].map(|estimator| {
                let mut scene = load(&[lamp]);
                (scene.render.light_sampling, scene.render.estimator) = (strategy, estimator);
                (format!("{strategy:?}, {estimator:?}"), scene)
            })
        });
        assert_all_agree(ways.collect());
    }
}

/// A screen of 8 × 8 texels above the floor.
const SCREEN: &str = "[[texture]]\nname = \"picture\"\ntype = \"checker\"\na = 0\nb = 1\n[[material]]\nname = \"screen\"\ntype = \"emissive\"\n\
                      radiance = { texture = \"picture\", factor = [60, 50, 40] }\n";
const QUAD: &str =
    "[[shape]]\ntype = \"rectangle\"\ncorner = [-2, 1.9, -2]\nedge_u = [4, 0, 0]\nedge_v = [0, 0, 4]\nmaterial = \"screen\"\n";
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
    scene.textures[0].kind = TextureKind::Image(ImageTexture { image, wrap: [TextureWrap::Clamp; 2], filter, scale: [1.0, 1.0] });
    scene
}

/// Texel 5 from the left; the screen's v grows towards the viewer, and rows run the other way.
fn one_bright(x: u32, y: u32) -> f32 {
    f32::from(u8::from((x, y) == (5, 3)))
}

/// Shapes that are lit by the same picture, all round.
const TUBE: &str =
    "[[shape]]\ntype = \"cylinder\"\nfrom = [-2, 2.2, 0]\nto = [2, 2.2, 0.5]\nradius = 0.6\nmaterial = \"screen\"\n";
const GLOBE: &str = "[[shape]]\ntype = \"sphere\"\ncenter = [0.4, 2.3, 0.3]\nradius = 0.8\nmaterial = \"screen\"\n\
                     transform = [{ rotate = [0, 1, 0], degrees = 20 }]\n";
/// Half of the screen's light, and half of another's of its kind; and light where the picture is a weight.
const HALVES: &str = "[[material]]\nname = \"halves\"\ntype = \"blend\"\nmaterials = [\"screen\", \"screen\"]\n\
                      weight = { type = \"constant\", value = 0.5 }\n";
const STENCIL: &str = "[[material]]\nname = \"glow\"\ntype = \"emissive\"\nradiance = [60, 50, 40]\n\
                       [[material]]\nname = \"dark\"\ntype = \"diffuse\"\nreflectance = 0\n\
                       [[material]]\nname = \"stencil\"\ntype = \"blend\"\nmaterials = [\"glow\", \"dark\"]\n\
                       weight = { type = \"texture\", texture = \"picture\" }\n";

#[test]
#[ignore = "slow"]
fn screens_look_the_same_whatever_their_points_are_drawn_by() {
    let screens = [
        (TextureFilter::Nearest, QUAD.to_owned()),
        (TextureFilter::Bilinear, QUAD.to_owned()),
        (TextureFilter::Bilinear, TUBE.to_owned()),
        (TextureFilter::Nearest, STENCIL.to_owned() + &GLOBE.replace("\"screen\"", "\"stencil\"")),
        (TextureFilter::Bilinear, HALVES.to_owned() + &mesh_of_screen(3).replace("\"screen\"", "\"halves\"")),
    ];
    let everywhere = in_full("screens of a mesh and of unfiltered rectangles");
    for (_, (filter, shape)) in screens.into_iter().enumerate().filter(|(index, _)| everywhere || (1..4).contains(index)) {
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

/// A lamp that is the part of a surface under the bright texel: of 8 × 8, the third from the left and the sixth from above. Its front is where u, v and it
/// are right-handed, or the other way.
fn lamp_of_texel(is_right_handed: bool, surface: impl Fn(f64, f64) -> [f64; 3]) -> String {
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    let side: u32 = 8;
    for (row, column) in (0..=side).flat_map(|row| (0..=side).map(move |column| (row, column))) {
        let [u, v] = [2 * side + column, 2 * side + row].map(|place| f64::from(place) / f64::from(8 * side));
        positions.push(surface(u, v));
    }
    for corner in (0..side * side).map(|square| square / side * (side + 1) + square % side) {
        faces.extend([[corner, corner + 1, corner + side + 2], [corner, corner + side + 2, corner + side + 1]]);
    }
    if !is_right_handed {
        faces.iter_mut().for_each(|face| face.swap(1, 2));
    }
    format!(
        "[[material]]\nname = \"bright\"\ntype = \"emissive\"\nradiance = [60, 50, 40]\n\
         [[shape]]\ntype = \"mesh\"\npositions = {positions:?}\nfaces = {faces:?}\nmaterial = \"bright\"\n"
    )
}

fn on_quad(u: f64, v: f64) -> [f64; 3] {
    [4.0 * u - 2.0, 1.9, 4.0 * v - 2.0]
}

/// A point of [`TUBE`], level and higher; u grows from −z, counter-clockwise seen from −x.
fn on_tube(u: f64, v: f64) -> [f64; 3] {
    let (sine, cosine) = (std::f64::consts::TAU * u).sin_cos();
    [4.0 * v - 2.0, 3.0 - 0.6 * sine, -0.6 * cosine]
}

/// A point of [`GLOBE`], higher and not turned.
fn on_globe(u: f64, v: f64) -> [f64; 3] {
    let ((sine, cosine), (across, height)) = ((std::f64::consts::TAU * u).sin_cos(), (std::f64::consts::PI * v).sin_cos());
    [0.4 + 0.8 * across * sine, 3.2 - 0.8 * height, 0.3 - 0.8 * across * cosine]
}

/// A screen of which one texel shines has at most twice the error of a lamp of that size, whatever its shape and its material. Neither is in view.
#[test]
#[ignore = "slow"]
fn a_bright_texel_is_found_as_a_lamp_of_its_size_is() {
    let tube = TUBE.replace("2.2, 0.5]", "3, 0]").replace("2.2", "3");
    let globe = GLOBE.replace("2.3", "3.2").replace("transform = [{ rotate = [0, 1, 0], degrees = 20 }]\n", "");
    // Made of so much that it is drawn evenly.
    let mut deep = HALVES.to_owned();
    for level in 0..20 {
        let below = if level == 0 { "halves".to_owned() } else { format!("deep{}", level - 1) };
        let names = format!("\"screen\", \"{below}\"");
        deep += &HALVES.replace("\"halves\"", &format!("\"deep{level}\"")).replace("\"screen\", \"screen\"", &names);
    }
    let error_of = |text: &[&str]| {
        let mut scene = load(text);
        if !scene.textures.is_empty() {
            scene = with_picture(scene, TextureFilter::Nearest, |x, y| f32::from(u8::from((x, y) == (2, 5))));
        }
        scene.camera.look_at.y = 0.2;
        scene.render.max_depth = 2;
        variance(&scene).sqrt()
    };
    let everywhere = in_full("bright texels on tubes and on meshes");
    let screens = [
        ("quad", QUAD, lamp_of_texel(true, on_quad), ["screen", "stencil", "deep19"].as_slice()),
        ("mesh", &mesh_of_screen(8), lamp_of_texel(true, on_quad), &["screen", "halves", "deep19"]),
        ("tube", &tube, lamp_of_texel(false, on_tube), &["screen", "deep19"]),
        ("globe", &globe, lamp_of_texel(false, on_globe), &["screen", "stencil", "deep19"]),
    ];
    for (name, shape, lamp, materials) in screens.into_iter().filter(|(name, ..)| everywhere || ["quad", "globe"].contains(name))
    {
        let error_of_lamp = error_of(&[&lamp]);
        for &material in materials {
            let others = [STENCIL, &deep].concat();
            let error = error_of(&[SCREEN, &others, &shape.replace("\"screen\"", &format!("\"{material}\""))]);
            println!("{name}, {material}: {error:.5}, a lamp of its size {error_of_lamp:.5}");
            // The control is what is drawn evenly.
            let holds = if material == "deep19" { error > 2.5 * error_of_lamp } else { error < 2.0 * error_of_lamp };
            assert!(holds, "{name}, {material}: {error} and {error_of_lamp}");
        }
    }
}
