//! The GPU's picture against the reference's, path by path, for every built-in scene and every way to run it.

mod blends;
mod cameras;
mod features;
mod flat_lights;
mod instances;
mod layers;
mod light_groups;
mod light_links;
mod light_samples;
mod lights;
mod materials;
mod media;
mod motion;
mod screens;
mod shapes;
mod strategies;
mod test_grid;
mod textures;

use crate::common::device::{DEVICE, with_limits};
use crate::common::effort::in_full;
use crate::common::scenes::ENOUGH;
use gpt::cpu::ReferenceRenderer;
use gpt::gpu::{Device, GpuRenderer};
use gpt::load;
use gpt::plan::{PlanOptions, StageMode, TraversalChoice};
use gpt::scene::{self, Estimator, MisHeuristic, SamplerKind, Scene};
use gpt::verify::{self, Verdict};

/// A built-in scene, small.
fn small(name: &str, side: u32, spp: u32) -> Scene {
    let mut scene = load::load(Some(name)).expect("built-in scenes load");
    verify::shrink(&mut scene, side);
    scene.render.spp = spp;
    scene
}

fn compare(scene: &Scene, options: &PlanOptions) -> Option<Verdict> {
    Some(compare_on(DEVICE.as_ref()?, scene, options))
}

fn compare_on(device: &Device, scene: &Scene, options: &PlanOptions) -> Verdict {
    let mut gpu = GpuRenderer::on(device, scene, options).expect("the scene fits");
    let mut cpu = ReferenceRenderer::new(scene).expect("the scene is supported");
    verify::compare(scene, &mut gpu, &mut cpu, None).expect("both render")
}

pub fn assert_agrees(what: &str, scene: &Scene, options: &PlanOptions) {
    let Some(device) = DEVICE.as_ref() else { return };
    assert_agrees_on(device, what, scene, options);
}

fn assert_agrees_on(device: &Device, what: &str, scene: &Scene, options: &PlanOptions) {
    let verdict = compare_on(device, scene, options);
    println!(
        "{what}: {:.4} % of {} paths match, rms {:.1e}, largest {:.1e}",
        100.0 * verdict.matching_share(),
        verdict.paths,
        verdict.rms_difference,
        verdict.largest_difference
    );
    assert!(verdict.agrees, "{what}: {verdict:#?}");
}

/// In the short form, as many as use every switch of the shaders that any of them uses.
#[test]
fn every_built_in_scene_agrees_path_by_path() {
    let everything = in_full("built-in scenes beyond those that use all that kernels have code for");
    for name in load::builtin_names().filter(|name| everything || ENOUGH.contains(name)) {
        let (side, spp) = if everything { (64, 16) } else { (48, 8) };
        assert_agrees(name, &small(name, side, spp), &PlanOptions::default());
    }
}

#[test]
fn every_way_to_run_agrees() {
    let ways = [
        ("unrolled wavefront", PlanOptions { stages: Some(StageMode::Wavefront), ..PlanOptions::default() }),
        (
            "hierarchy, fused",
            PlanOptions { traversal: TraversalChoice::Bvh, stages: Some(StageMode::Fused), ..PlanOptions::default() },
        ),
        (
            "hierarchy, wavefront",
            PlanOptions { traversal: TraversalChoice::Bvh, stages: Some(StageMode::Wavefront), ..PlanOptions::default() },
        ),
        ("checked shaders", PlanOptions { checked_shaders: true, ..PlanOptions::default() }),
    ];
    for (way, options) in ways {
        assert_agrees(way, &small("spheres", 48, 4), &options);
    }
    if let Some(device) = with_limits(|limits| limits.read_write_rgba32float = false) {
        assert_agrees_on(&device, "film in buffers", &small("spheres", 48, 4), &PlanOptions::default());
    }
}

/// Boxes that move, and triangles with normals.
#[test]
fn the_hierarchy_agrees_on_what_moves_and_on_meshes() {
    for name in ["motion-blur", "teapot-plastic"] {
        assert_agrees(name, &small(name, 32, 4), &PlanOptions { traversal: TraversalChoice::Bvh, ..PlanOptions::default() });
    }
}

#[test]
fn every_estimator_sampler_and_heuristic_agrees() {
    let everywhere = in_full("every estimator with either sampler");
    for (index, estimator) in Estimator::ALL.into_iter().enumerate() {
        let pairs = [(SamplerKind::Halton, MisHeuristic::Power), (SamplerKind::Independent, MisHeuristic::Balance)];
        // The heuristic is of use to MIS alone.
        let is_taken = |other: usize| everywhere || index == 0 || index % 2 == other;
        for (_, (sampler, heuristic)) in pairs.into_iter().enumerate().filter(|(other, _)| is_taken(*other)) {
            let mut scene = small("spheres", 48, 4);
            scene.render.estimator = estimator;
            scene.render.sampler = sampler;
            scene.render.heuristic = heuristic;
            scene.render.seed = 7;
            assert_agrees(&format!("{estimator:?} {sampler:?} {heuristic:?}"), &scene, &PlanOptions::default());
        }
    }
}

#[test]
fn unlimited_depth_agrees() {
    let mut scene = small("furnace-box", 24, 4);
    scene.render.max_depth = 0;
    scene.render.roulette_depth = 2.into();
    assert_agrees("unlimited, fused", &scene, &PlanOptions::default());
    let wavefront = PlanOptions { stages: Some(StageMode::Wavefront), ..PlanOptions::default() };
    assert_agrees("unlimited, wavefront", &scene, &wavefront);
}

/// The test must notice a device that adds 1 % of energy to one material.
#[test]
fn a_planted_error_is_noticed() {
    let Some(device) = DEVICE.as_ref() else { return };
    let scene = small("cornell", 48, 16);
    let mut faulty = scene.clone();
    for material in &mut faulty.materials {
        if let Some(scene::Emission { radiance: scene::ColorInput::Constant(radiance), .. }) = &mut material.emission {
            *radiance *= 1.01;
        }
    }
    let mut gpu = GpuRenderer::on(device, &faulty, &PlanOptions::default()).expect("the scene fits");
    let mut cpu = ReferenceRenderer::new(&scene).expect("the scene is supported");
    let verdict = verify::compare(&scene, &mut gpu, &mut cpu, None).expect("both render");
    assert!(!verdict.agrees && !verdict.rejections.is_empty(), "{verdict:#?}");

    // The evidence shows it: the device's picture is 1 % brighter than the reference's.
    let folder = tempfile::tempdir().expect("a temporary folder");
    let written = verify::evidence::write(folder.path(), &scene, &verdict).expect("the evidence is written");
    assert_eq!(written.len(), 4);
    let mean = |path: &std::path::Path| {
        let pixels = gpt::output::read_image(path).expect("it can be read").pixels;
        pixels.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>()
    };
    let ratio = mean(&written[0]) / mean(&written[1]);
    assert!((ratio - 1.01).abs() < 1e-3, "{ratio}");
}
