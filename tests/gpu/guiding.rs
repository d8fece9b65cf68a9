//! Paths that are guided: the same on both devices, the same from run to run, with the same mean, and with less noise where light is hard to find.

use std::path::Path;

use crate::common::device::DEVICE;
use crate::common::effort::in_full;
use crate::common::picture::render;
use gpt::compare::{Moments, hypothesis};
use gpt::cpu::ReferenceRenderer;
use gpt::gpu::GpuRenderer;
use gpt::load;
use gpt::plan::{PlanOptions, StageMode, TraversalChoice};
use gpt::renderer::{Batch, RenderRequest, Renderer, Silent};
use gpt::scene::{Estimator, Guiding, SamplerKind, Scene};
use gpt::verify;

/// A room whose only light comes round the end of a wall.
const ROUND_THE_CORNER: &str = r#"
[film]
size = [32, 24]
[render]
spp = 4
max_depth = 6
guiding = "on"
[camera]
position = [1.5, 1.2, -1.5]
look_at = [-1, 0.8, 0.3]
vfov = 60
[[material]]
name = "white"
type = "diffuse"
reflectance = 0.7
[[material]]
name = "glaze"
type = "plastic"
reflectance = [0.6, 0.2, 0.1]
[[material]]
name = "paint"
type = "principled"
base_color = [0.3, 0.4, 0.6]
metallic = 0.2
roughness = 0.4
clearcoat = 0.5
[[material]]
name = "half mirror"
type = "blend"
materials = ["white", "mirror"]
weight = { type = "constant", value = 0.6 }
[[material]]
name = "mirror"
type = "mirror"
[[material]]
name = "lamp"
type = "emissive"
radiance = 100
[[shape]]
type = "box"
min = [-4, 0, -2]
max = [2, 2.5, 2]
material = "white"
[[shape]]
type = "rectangle"
corner = [-2, 0, -2]
edge_u = [0, 0, 3.5]
edge_v = [0, 2.5, 0]
material = "white"
[[shape]]
type = "sphere"
center = [-0.6, 0.5, 0.4]
radius = 0.5
material = "glaze"
[[shape]]
type = "sphere"
center = [-1.2, 0.3, 1.2]
radius = 0.3
material = "paint"
[[shape]]
type = "sphere"
center = [0.6, 0.4, 0.9]
radius = 0.4
material = "half mirror"
[[shape]]
type = "rectangle"
corner = [-3.4, 2.45, -1.4]
edge_u = [0.5, 0, 0]
edge_v = [0, 0, 0.5]
material = "lamp"
"#;

fn round_the_corner() -> Scene {
    load::load_toml_str(ROUND_THE_CORNER, "round the corner", Path::new(".")).unwrap_or_else(|error| panic!("{error}"))
}

/// The room full of fog of several phase lobes, behind a wall of this width.
fn foggy_corner(wall: f64) -> Scene {
    let fog = r#"
[[medium]]
name = "fog"
absorption = 0.02
scattering = [0.3, 0.4, 0.5]
phase = { type = "blend", phases = [{ type = "rayleigh" }, { type = "henyey_greenstein", g = 0.4 }], weights = [1, 2] }
"#;
    let text = ROUND_THE_CORNER.replacen("vfov = 60\n", "vfov = 60\nmedium = \"fog\"\n", 1) + fog;
    let text = text.replacen("edge_u = [0, 0, 3.5]", &format!("edge_u = [0, 0, {wall:?}]"), 1);
    load::load_toml_str(&text, "foggy corner", Path::new(".")).unwrap_or_else(|error| panic!("{error}"))
}

fn on_gpu(scene: &Scene) -> Option<Box<dyn Renderer>> {
    let device = DEVICE.as_ref()?;
    Some(Box::new(GpuRenderer::on(device, scene, &PlanOptions::default()).expect("the scene fits")))
}

/// Pictures of the scene with random numbers of several keys, and one guide for all of them.
fn replications(scene: &Scene, seeds: u32) -> Option<Vec<Vec<[f32; 3]>>> {
    let mut renderer = on_gpu(scene)?;
    let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..scene.render.spp };
    let picture = |seed| {
        let mut pixels = Vec::new();
        let batch = Batch { seed: Some(1000 + 17 * seed), ..Batch::of(&request) };
        let on_band = &mut |band: gpt::Band| {
            pixels.extend(band.mean);
            Ok(())
        };
        renderer.render_batch(&batch, &Silent, on_band).expect("it renders");
        pixels
    };
    Some((0..seeds).map(picture).collect())
}

fn luminances(pixels: &[[f32; 3]]) -> Vec<f64> {
    pixels.iter().map(|pixel| pixel.iter().map(|channel| f64::from(*channel)).sum()).collect()
}

#[test]
#[ignore = "slow"]
fn guided_paths_agree_path_by_path() {
    let Some(device) = DEVICE.as_ref() else { return };
    let scene = round_the_corner();
    let mut several = scene.clone();
    (several.render.light_samples, several.render.light_samples_depth, several.render.sampler) =
        (3.into(), 2, SamplerKind::Halton);
    let mut alone = scene.clone();
    (alone.render.estimator, alone.render.seed) = (Estimator::Nee, 5);
    let mut picked = scene.clone();
    picked.render.blend = gpt::scene::BlendMode::Pick;
    let bvh = PlanOptions { traversal: TraversalChoice::Bvh, ..PlanOptions::default() };
    let wavefront = PlanOptions { stages: Some(StageMode::Wavefront), ..PlanOptions::default() };
    let wavefront_in_fog = wavefront.clone();
    let fog = foggy_corner(3.5);
    let everywhere = in_full("guided paths of a mixture of a blend by constants");
    let cases = [
        ("constants", &scene, PlanOptions::default()),
        ("wavefront, several light samples", &several, wavefront),
        ("hierarchy, several light samples", &several, bvh.clone()),
        ("light sampling alone finds emission", &alone, bvh),
        ("in fog", &fog, PlanOptions::default()),
        ("in fog, wavefront", &fog, wavefront_in_fog),
        ("one material of a blend", &picked, PlanOptions::default()),
    ];
    for (what, scene, options) in cases.into_iter().filter(|(what, ..)| everywhere || *what != "constants") {
        let mut gpu = GpuRenderer::on(device, scene, &options).expect("the scene fits");
        assert!(gpu.plan().switches.enabled.contains("GUIDE"));
        let mut cpu = ReferenceRenderer::new(scene).expect("the scene is supported");
        let verdict = verify::compare(scene, &mut gpu, &mut cpu, None).expect("both render");
        println!("{what}: {:.4} % of {} paths match", 100.0 * verdict.matching_share(), verdict.paths);
        assert!(verdict.agrees, "{what}: {verdict:#?}");
    }
}

/// The comparison tells guided paths from others, and a guide from that of another seed.
#[test]
fn the_guide_matters() {
    let scene = round_the_corner();
    let Some(device) = DEVICE.as_ref() else { return };
    let mut unguided = scene.clone();
    unguided.render.guiding = Guiding::Off;
    let mut gpu = GpuRenderer::on(device, &unguided, &PlanOptions::default()).expect("the scene fits");
    assert!(!gpu.plan().switches.enabled.contains("GUIDE") && gpu.plan().memory.bytes("guide") == 0);
    let mut cpu = ReferenceRenderer::new(&scene).expect("the scene is supported");
    let verdict = verify::compare(&scene, &mut gpu, &mut cpu, None).expect("both render");
    // Most paths find no light, with a guide or without.
    assert!(verdict.matching_share() < 0.9, "{verdict:#?}");
}

/// A guide is learned from the scene and its settings alone: a second render has the same bits, and parts of
/// it add up to it.
#[test]
fn guided_pictures_are_the_same_from_run_to_run_and_in_parts() {
    let scene = round_the_corner();
    let Some(mut first) = on_gpu(&scene) else { return };
    let whole = render(first.as_mut(), &scene);
    let mut again = on_gpu(&scene).expect("it was there before");
    assert_eq!(whole, render(again.as_mut(), &scene));
    let [height, spp] = [scene.film.size[1], scene.render.spp];
    let mut sum = vec![[0.0; 3]; whole.len()];
    for samples in [0..spp / 2, spp / 2..spp] {
        let mut renderer = on_gpu(&scene).expect("it was there before");
        let request = RenderRequest { rows: 0..height, samples };
        let mut pixels = Vec::new();
        renderer
            .render(&request, &Silent, &mut |band| {
                pixels.extend(band.mean);
                Ok(())
            })
            .expect("it renders");
        for (sum, pixel) in sum.iter_mut().zip(pixels) {
            (0..3).for_each(|channel| sum[channel] += 0.5 * pixel[channel]);
        }
    }
    for (whole, sum) in whole.iter().flatten().zip(sum.iter().flatten()) {
        assert!((whole - sum).abs() <= 1e-6 * whole.abs(), "{whole} {sum}");
    }
}

#[test]
#[ignore = "slow"]
fn guided_paths_have_the_same_mean() {
    have_the_same_mean(round_the_corner(), 256);
}

#[test]
#[ignore = "slow"]
fn guided_paths_in_fog_have_the_same_mean() {
    // Behind a wide wall unguided paths meet light so seldom that their mean is not known.
    have_the_same_mean(foggy_corner(2.0), 512);
}

/// The mean over a picture with and without a guide, by Welch's t-test over seeds, and the same test against 3 % more light.
fn have_the_same_mean(mut scene: Scene, spp: u32) {
    scene.render.spp = spp;
    let mut means = |guiding| -> Option<Vec<f64>> {
        scene.render.guiding = guiding;
        let mean = |pixels: Vec<[f32; 3]>| luminances(&pixels).iter().sum::<f64>() / pixels.len() as f64;
        let means: Vec<f64> = replications(&scene, 8)?.into_iter().map(mean).collect();
        println!("{guiding:?}: {means:?}");
        Some(means)
    };
    let (Some(unguided), Some(guided)) = (means(Guiding::Off), means(Guiding::On)) else { return };
    // A guide whose density is off by some per cent shows as much.
    let [unguided, guided, brighter]: [Moments; 3] = [(&unguided, 1.0), (&guided, 1.0), (&guided, 1.03)]
        .map(|(means, factor)| means.iter().map(|mean| factor * mean).collect());
    let held = hypothesis::welch_t_test(&unguided, &guided);
    assert!(held.p_value > 1e-3, "{unguided:?} and {guided:?}: {held:?}");
    let control = hypothesis::welch_t_test(&unguided, &brighter);
    assert!(control.p_value < 1e-3, "3 % go unnoticed: {unguided:?}, {brighter:?}, {control:?}");
}

/// A guide lowers the squared error of a sample if light comes round a corner.
#[test]
fn a_guide_pays_where_light_is_hard_to_find() {
    pays(round_the_corner(), 0.8);
}

#[test]
#[ignore = "slow"]
fn a_guide_pays_in_fog() {
    pays(foggy_corner(3.5), 0.8);
}

/// The squared error with a guide is at most so many times that without.
fn pays(mut scene: Scene, most: f64) {
    scene.render.spp = 64;
    let variance = |scene: &Scene| -> Option<f64> {
        let replications: Vec<Vec<f64>> = replications(scene, 4)?.iter().map(|pixels| luminances(pixels)).collect();
        let pixels = replications[0].len();
        let of_pixel = |pixel: usize| replications.iter().map(|picture| picture[pixel]).collect::<Moments>();
        let relative = |moments: Moments| moments.variance() / (moments.mean() * moments.mean() + 1e-6);
        Some((0..pixels).map(|pixel| relative(of_pixel(pixel))).sum::<f64>() / pixels as f64)
    };
    let Some(guided) = variance(&scene) else { return };
    scene.render.guiding = Guiding::Off;
    let unguided = variance(&scene).expect("the device was there before");
    println!("squared error with a guide over that without: {}", guided / unguided);
    assert!(guided < most * unguided, "{guided} {unguided}");
}
