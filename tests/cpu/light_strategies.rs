//! Ways of sampling the same light make the same picture: Welch's t-test on every tile and the whole picture, over replications.

use gpt::compare::image_tests::{Picture, TileSettings, compare_replications};
use gpt::film::Band;
use gpt::load;
use gpt::reference::ReferenceRenderer;
use gpt::renderer::{RenderRequest, Renderer, Silent};
use gpt::scene::{Estimator, LightChoice, LightSampling, Scene};

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
