//! Every shape as what rays meet, as a light, as a portal and in motion: the device's paths against the reference's.

use gpt::load::{self, SceneError};
use gpt::plan::{PlanOptions, StageMode, TraversalChoice};
use gpt::scene::{Estimator, Geometry, Scene};

use super::materials::BUMPS;
use super::{DEVICE, assert_agrees, compare};

/// A floor under a shape of the material `m`.
const STAGE: &str = r#"
[film]
size = [32, 32]
[render]
spp = 8
max_depth = 4
[camera]
position = [1.2, 1.4, 4]
look_at = [0, -0.2, 0]
vfov = 45
shutter = [0, 1]
[[texture]]
name = "checks"
type = "checker"
a = [0.9, 0.2, 0.1]
b = [0.1, 0.3, 0.8]
scale = [6, 4]
[[texture]]
name = "bumps"
type = "image"
file = "bumps.png"
color_space = "linear"
[[material]]
name = "floor"
type = "diffuse"
reflectance = 0.6
[[shape]]
type = "rectangle"
corner = [-4, -1.3, 4]
edge_u = [8, 0, 0]
edge_v = [0, 0, -8]
material = "floor"
[[light]]
type = "sky"
zenith = [0.2, 0.4, 0.9]
horizon = [0.8, 0.8, 0.7]
ground = [0.2, 0.15, 0.1]
"#;

const TURNED: &str = "transform = [{ rotate = [1, 2, 0.5], degrees = 40 }, { scale = 1.1 }, { translate = [0.1, 0.05, -0.1] }]\n";
const MIRRORED: &str = "transform = [{ scale = -0.9 }, { rotate = [1, 2, 0.5], degrees = 40 }]\n";
const MOVING: &str = "motion = [{ rotate = [0.2, 1, 0.3], degrees = 70 }, { scale = 1.2 }, { translate = [0.3, 0.2, -0.1] }]\n";

fn stage(shape: &str, placed: &str, material: &str) -> Result<Scene, SceneError> {
    let text = format!("{STAGE}[[material]]\nname = \"m\"\n{material}\n{shape}material = \"m\"\n{placed}");
    load::load_toml_str(&text, "stage.toml", BUMPS.path())
}

const TEXTURED: &str =
    "type = \"phong\"\ndiffuse = { texture = \"checks\" }\nspecular = 0.3\nexponent = 20\nnormal_map = \"bumps\"";
const PLAIN: &str = "type = \"phong\"\ndiffuse = [0.6, 0.5, 0.3]\nspecular = 0.3\nexponent = 20";
const GLOWING: &str = "type = \"emissive\"\nradiance = [2, 1, 0.5]\ntwo_sided = true";
const ONE_SIDED: &str = "type = \"emissive\"\nradiance = [1, 2, 3]";
const PATTERNED: &str = "type = \"emissive\"\nradiance = { texture = \"checks\" }\ntwo_sided = true";

/// Every shape in all its parts; those that cannot be in one are told from the rest by what they are.
fn scenes() -> Vec<(String, Scene)> {
    let mut scenes = Vec::new();
    for (name, shape) in load::file::shape_examples() {
        let plain = stage(&shape, TURNED, PLAIN).unwrap_or_else(|error| panic!("{error}"));
        let geometry = plain.shapes[1].geometry.clone();
        let mut add = |part: &str, placed: &str, material: &str| {
            let scene = stage(&shape, placed, material).unwrap_or_else(|error| panic!("{name}, {part}: {error}"));
            scenes.push((format!("{name}, {part}"), scene));
        };
        add("turned", TURNED, PLAIN);
        add("glowing", TURNED, GLOWING);
        add("mirrored and glowing on one side", MIRRORED, ONE_SIDED);
        if geometry.lacks_uv().is_none() {
            add("textured", TURNED, TEXTURED);
            add("mirrored and textured", MIRRORED, TEXTURED);
            add("patterned light", MIRRORED, PATTERNED);
        }
        if !geometry.is_infinite() {
            add("portal", &format!("portal = true\n{TURNED}"), "type = \"pass\"");
            add("moving", &format!("{MOVING}{TURNED}"), PLAIN);
            add("moving light", &format!("{MOVING}{TURNED}"), GLOWING);
        }
    }
    scenes
}

#[test]
fn every_shape_agrees_in_every_part() {
    let by_wavefront =
        PlanOptions { traversal: TraversalChoice::Bvh, stages: Some(StageMode::Wavefront), ..PlanOptions::default() };
    for (index, (name, mut scene)) in scenes().into_iter().enumerate() {
        if index % 2 == 0 {
            assert_agrees(&name, &scene, &PlanOptions::default());
        } else {
            scene.render.estimator = Estimator::Nee;
            assert_agrees(&format!("{name}, wavefront"), &scene, &by_wavefront);
        }
    }
}

/// The same comparison notices a shape that is a hundredth larger.
#[test]
fn a_shape_off_by_a_hundredth_is_noticed() {
    let Some(device) = DEVICE.as_ref() else { return };
    for (name, scene) in scenes().into_iter().filter(|(name, _)| name.ends_with("turned")) {
        let is_infinite = matches!(scene.shapes[1].geometry, Geometry::Plane(_));
        let mut larger = scene.clone();
        let step = gpt::scene::TransformStep::Scale(glam::DVec3::splat(1.01));
        larger.shapes[1].transform.steps.insert(0, step);
        let mut gpu = gpt::gpu::GpuRenderer::on(device, &larger, &PlanOptions::default()).expect("the scene fits");
        let mut cpu = gpt::reference::ReferenceRenderer::new(&scene).expect("the scene is supported");
        let verdict = gpt::verify::compare(&scene, &mut gpu, &mut cpu, None).expect("both render");
        assert!(!verdict.agrees || is_infinite && verdict.matching_share() < 1.0, "{name}: {verdict:#?}");
        assert!(compare(&scene, &PlanOptions::default()).is_some_and(|verdict| verdict.agrees), "{name}");
    }
}
