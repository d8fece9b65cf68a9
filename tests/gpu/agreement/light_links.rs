//! Lamps that light some objects and not others: the device's paths against the reference's.

use gpt::cpu::ReferenceRenderer;
use gpt::gpu::GpuRenderer;
use gpt::load;
use gpt::plan::{PlanOptions, StageMode, TraversalChoice};
use gpt::scene::{Estimator, LightChoice, LightLinks, Scene};
use gpt::verify;

use super::{assert_agrees, small};
use crate::common::device::DEVICE;
use crate::common::effort::in_full;

/// Receivers of every kind: shapes that share a material, instances of one group, a translucent sheet, a mirror, fog and a body of smoke; lamps of every
/// kind, among them a textured one and one that is part of a blend.
const SCENE: &str = r#"
film = { size = [32, 32] }
render = { spp = 8, max_depth = 6, roulette_depth = 4 }
camera = { position = [0, 1.4, 5], look_at = [0, 0.8, 0], vfov = 45, medium = "fog" }
texture = [{ name = "squares", type = "checker", a = 1, b = 0.2, scale = [3, 3] }]
medium = [
  { name = "fog", scattering = [0.05, 0.06, 0.09], receiver = "air" },
  { name = "smoke", scattering = 2, absorption = 0.4, receiver = "smoke" },
]
material = [
  { name = "grey", type = "diffuse", reflectance = 0.6 },
  { name = "sheet", type = "diffuse", reflectance = [0.6, 0.4, 0.3], opacity = 0.5 },
  { name = "mirror", type = "mirror" },
  { name = "bubble", type = "pass", interior = "smoke" },
  { name = "bank", type = "pass", interior = "fog" },
  { name = "panel", type = "emissive", radiance = { texture = "squares", factor = 5 }, lights_all_but = ["ball", "air"] },
  { name = "lamp", type = "diffuse", reflectance = 0.3, emission = [9, 6, 3], opacity = 0.7, lights_only = ["ball", "smoke", "copies"] },
]
shape = [
  { type = "rectangle", corner = [-4, 0, 4], edge_u = [8, 0, 0], edge_v = [0, 0, -8], material = "grey" },
  { type = "sphere", center = [-1.2, 0.6, 0], radius = 0.6, material = "grey", receiver = "ball" },
  { type = "rectangle", corner = [-0.6, 0.2, 0.9], edge_u = [1, 0, 0.3], edge_v = [0, 1, 0], material = "sheet", receiver = "sheet" },
  { type = "sphere", center = [1.3, 0.5, -0.6], radius = 0.5, material = "mirror", receiver = "mirror" },
  { type = "sphere", center = [0.4, 1.6, 0], radius = 0.4, material = "bubble" },
  { type = "sphere", center = [0, 1, 0], radius = 7, material = "bank" },
  { type = "rectangle", corner = [-1, 2.8, -1], edge_u = [1.5, 0, 0], edge_v = [0, 0, 1.5], material = "panel" },
  { type = "sphere", center = [1.2, 2.2, 0.7], radius = 0.3, material = "lamp" },
]
group = [{ name = "leaf", shape = [
  { type = "mesh", positions = [[0, 0, 0], [0.5, 0, 0.2], [0.2, 0.6, 0]], faces = [[0, 1, 2]], material = "grey" },
  { type = "mesh", positions = [[0, 0, 0], [-0.5, 0, 0.2], [-0.2, 0.6, 0]], faces = [[0, 2, 1]], material = "mirror" },
] }]
instance = [
  { group = "leaf", transform = [{ translate = [1.6, 0.1, 0.8] }], receiver = "copies" },
  { group = "leaf", places = [[1, 0, 0, -2, 0, 1, 0, 0.2, 0, 0, 1, 0.6], [1, 0, 0, 0.7, 0, 1, 0, 0.2, 0, 0, 1, 1]] },
]
light = [
  { type = "point", position = [-2, 1.5, 2], intensity = [1, 2, 3], lights_only = ["rest"] },
  { type = "spot", position = [2, 3, 2], direction = [-0.5, -1, -0.6], angle = 30, intensity = [9, 3, 3], lights_only = ["air", "sheet", "copies"] },
  { type = "directional", direction = [0.3, -1, -0.4], irradiance = [0.3, 0.5, 0.2], lights_all_but = ["rest", "copies"] },
  { type = "sky", zenith = [0.2, 0.3, 0.5], horizon = 0.2, ground = 0.1, lights_all_but = ["mirror", "smoke"] },
]
"#;

fn scene() -> Scene {
    load::load_toml_str(SCENE, "linked", std::path::Path::new("")).unwrap_or_else(|error| panic!("{error}"))
}

fn wavefront() -> PlanOptions {
    PlanOptions { stages: Some(StageMode::Wavefront), ..PlanOptions::default() }
}

#[test]
fn linked_lamps_agree_path_by_path() {
    let everything = in_full("linked lamps by every estimator and choice of lights");
    for (index, estimator) in Estimator::ALL.into_iter().enumerate() {
        for (other, light_choice) in [LightChoice::Power, LightChoice::Tree, LightChoice::Cells].into_iter().enumerate() {
            if !everything && index % 3 != other {
                continue;
            }
            let mut scene = scene();
            (scene.render.estimator, scene.render.light_choice) = (estimator, light_choice);
            assert_agrees(&format!("{estimator:?}, {light_choice:?}"), &scene, &PlanOptions::default());
            assert_agrees(&format!("{estimator:?}, {light_choice:?}, wavefront"), &scene, &wavefront());
        }
    }
    let mut scene = scene();
    scene.render.light_samples = 3.into();
    assert_agrees("three light samples, wavefront", &scene, &wavefront());
    let hierarchy = PlanOptions { traversal: TraversalChoice::Bvh, ..PlanOptions::default() };
    assert_agrees("two balls and two lamps", &small("duet", 48, 8), &hierarchy);
}

/// The control: each of the lamps' links is noticed where the device knows none of them.
#[test]
fn a_link_that_is_lost_is_noticed() {
    let Some(device) = DEVICE.as_ref() else { return };
    let scene = scene();
    for material in 0..scene.materials.len() {
        let mut lost = scene.clone();
        lost.light_links.put_material(material, gpt::scene::LinkMask::ALL);
        assert_noticed(device, &format!("material {material}"), &scene, &lost);
    }
    for light in 0..scene.lights.len() {
        let mut lost = scene.clone();
        lost.light_links.put_light(light, gpt::scene::LinkMask::ALL);
        assert_noticed(device, &format!("light {light}"), &scene, &lost);
    }
    let mut lost = scene.clone();
    lost.shapes.iter_mut().for_each(|shape| shape.receiver = 0);
    assert_noticed(device, "receivers of shapes", &scene, &lost);
    let mut lost = scene.clone();
    lost.instances.iter_mut().for_each(|instances| instances.receiver = 0);
    assert_noticed(device, "receivers of instances", &scene, &lost);
    let mut lost = scene.clone();
    (0..lost.media.len()).for_each(|medium| lost.light_links.put_medium(medium, 0));
    assert_noticed(device, "receivers of media", &scene, &lost);
    let mut lost = scene.clone();
    lost.light_links = LightLinks::default();
    assert_noticed(device, "all", &scene, &lost);
}

fn assert_noticed(device: &gpt::gpu::Device, what: &str, scene: &Scene, lost: &Scene) {
    if lost.light_links == scene.light_links
        && lost.shapes.iter().zip(&scene.shapes).all(|(lost, kept)| lost.receiver == kept.receiver)
        && lost.instances.iter().zip(&scene.instances).all(|(lost, kept)| lost.receiver == kept.receiver)
    {
        return;
    }
    let mut gpu = GpuRenderer::on(device, lost, &PlanOptions::default()).expect("the scene fits");
    let mut cpu = ReferenceRenderer::new(scene).expect("the scene is supported");
    let verdict = verify::compare(scene, &mut gpu, &mut cpu, None).expect("both render");
    assert!(!verdict.agrees, "{what}: {verdict:#?}");
}
