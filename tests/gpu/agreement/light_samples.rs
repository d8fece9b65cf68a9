//! Several light samples at a path's first surface, on both devices and with every way to trace it.

use gpt::cpu::ReferenceRenderer;
use gpt::gpu::GpuRenderer;
use gpt::plan::{PlanOptions, StageMode, TraversalChoice};
use gpt::scene::{Estimator, SamplerKind};
use gpt::verify;

use crate::common::effort::in_full;
use crate::common::translucent_surfaces::translucent_surfaces;

use super::{DEVICE, assert_agrees, assert_agrees_on, small, with_limits};

#[test]
fn several_light_samples_agree() {
    // An area light; spheres that emit; a sky and things that move; a mesh of thousands of triangles.
    let scenes = [("cornell", 5, 2), ("veach-mis", 2, 1), ("motion-blur", 3, 3), ("knot-plastic", 3, 2)];
    let everywhere = in_full("several light samples of each scene by every way to run, which are by turns");
    for (index, (name, count, depth)) in scenes.into_iter().enumerate() {
        let mut scene = small(name, 32, 4);
        (scene.render.light_samples, scene.render.light_samples_depth) = (count.into(), depth);
        let bvh = PlanOptions { traversal: TraversalChoice::Bvh, ..PlanOptions::default() };
        let wavefront = PlanOptions { stages: Some(StageMode::Wavefront), ..PlanOptions::default() };
        let alone = with_limits(|limits| limits.subgroup_size = None);
        let ways = [
            ("constants", DEVICE.clone(), PlanOptions::default()),
            ("hierarchy", DEVICE.clone(), bvh.clone()),
            ("wavefront", DEVICE.clone(), wavefront),
            ("rays alone", alone, bvh),
        ];
        for (_, (way, device, options)) in ways.iter().enumerate().filter(|(other, _)| everywhere || *other == index) {
            let Some(device) = device else { return };
            assert_agrees_on(device, &format!("{name}, {count} light samples, {way}"), &scene, options);
        }
    }
}

/// Which surfaces take several goes by the depth of the path, of which vertices at null surfaces are no part.
#[test]
fn several_light_samples_agree_where_rays_pass_through_surfaces() {
    let mut scene = translucent_surfaces();
    scene.render.spp = 4;
    let everywhere = in_full("light samples behind translucent surfaces at one and at two surfaces by either way to run");
    for (index, (count, depth)) in [(4, 1), (3, 2)].into_iter().enumerate() {
        (scene.render.light_samples, scene.render.light_samples_depth) = (count.into(), depth);
        let both = [StageMode::Fused, StageMode::Wavefront];
        for (_, stages) in both.into_iter().enumerate().filter(|(other, _)| everywhere || *other == index) {
            let options = PlanOptions { stages: Some(stages), ..PlanOptions::default() };
            assert_agrees(
                &format!("translucent surfaces, {count} light samples at {depth} surfaces, {stages:?}"),
                &scene,
                &options,
            );
        }
    }
}

#[test]
fn every_estimator_and_sampler_agrees_on_several_light_samples() {
    let everywhere = in_full("every number of surfaces and either estimator with every sampler");
    // The others are in the test below.
    let samplers = (0..).zip(SamplerKind::ALL).skip(if everywhere { 0 } else { 4 });
    for (index, sampler) in samplers {
        let both = (0..).zip([Estimator::Mis, Estimator::Nee]);
        for (other, estimator) in both.filter(|(other, _)| everywhere || *other == index % 2) {
            let mut scene = small("cornell", 32, 4);
            (scene.render.sampler, scene.render.estimator, scene.render.light_samples) = (sampler, estimator, 3.into());
            // Every number stands with some sampler.
            for depth in (1..=3).filter(|depth| everywhere || (index + other) % 3 + 1 == *depth) {
                scene.render.light_samples_depth = depth;
                assert_agrees(&format!("{sampler:?}, {estimator:?}, {depth} surfaces"), &scene, &PlanOptions::default());
            }
        }
    }
}

/// The last edge ends at no surface that takes light samples, however many of its surfaces would; and where lights are not sampled at all,
/// nothing is laid out for them.
#[test]
fn several_light_samples_end_with_the_path() {
    let cases = [(1, Estimator::Mis), (2, Estimator::Mis), (3, Estimator::Nee), (4, Estimator::Bsdf)];
    for ((max_depth, estimator), sampler) in cases.into_iter().zip(SamplerKind::ALL) {
        let mut scene = small("cornell", 32, 4);
        (scene.render.max_depth, scene.render.estimator, scene.render.sampler) = (max_depth, estimator, sampler);
        (scene.render.light_samples, scene.render.light_samples_depth) = (4.into(), 3);
        assert_agrees(&format!("{max_depth} edges, {estimator:?}"), &scene, &PlanOptions::default());
    }
}

/// The comparison tells light samples at two surfaces from light samples at one, of paths that have a second surface: two in five.
#[test]
fn the_number_of_surfaces_matters() {
    let Some(device) = DEVICE.as_ref() else { return };
    let mut scene = small("cornell", 32, 8);
    (scene.render.light_samples, scene.render.light_samples_depth) = (3.into(), 2);
    let mut cpu = ReferenceRenderer::new(&scene).expect("the scene is supported");
    scene.render.light_samples_depth = 1;
    let mut gpu = GpuRenderer::on(device, &scene, &PlanOptions::default()).expect("the scene fits");
    let verdict = verify::compare(&scene, &mut gpu, &mut cpu, None).expect("both render");
    assert!(verdict.matching_share() < 0.7, "{verdict:#?}");
}

/// The comparison tells 3 light samples from 4, in every kernel.
#[test]
fn the_number_of_light_samples_matters() {
    let Some(device) = DEVICE.as_ref() else { return };
    let mut scene = small("cornell", 32, 8);
    scene.render.light_samples = 3.into();
    let mut cpu = ReferenceRenderer::new(&scene).expect("the scene is supported");
    scene.render.light_samples = 4.into();
    for stages in [StageMode::Fused, StageMode::Wavefront] {
        let options = PlanOptions { stages: Some(stages), ..PlanOptions::default() };
        let mut gpu = GpuRenderer::on(device, &scene, &options).expect("the scene fits");
        assert_eq!((gpu.plan().stages, gpu.plan().light_samples), (stages, 4));
        let verdict = verify::compare(&scene, &mut gpu, &mut cpu, None).expect("both render");
        assert!(verdict.matching_share() < 0.5, "{verdict:#?}");
    }
}
