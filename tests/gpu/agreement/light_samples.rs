//! Several light samples at a path's first surface, on both devices and with every way to trace it.

use gpt::gpu::GpuRenderer;
use gpt::plan::{PlanOptions, StageMode, TraversalChoice};
use gpt::reference::ReferenceRenderer;
use gpt::scene::{Estimator, SamplerKind};
use gpt::verify;

use crate::common::effort::in_full;
use crate::common::veils::veils;

use super::{DEVICE, assert_agrees, assert_agrees_on, small, with_limits};

#[test]
fn several_light_samples_agree() {
    // An area light; spheres that emit; a sky and things that move; a mesh of thousands of triangles.
    for (name, count, depth) in [("cornell", 5, 2), ("veach-mis", 2, 1), ("motion-blur", 3, 3), ("knot-plastic", 3, 2)] {
        let mut scene = small(name, 32, 4);
        (scene.render.light_samples, scene.render.light_samples_depth) = (count.into(), depth);
        let options = PlanOptions { traversal: TraversalChoice::Bvh, ..PlanOptions::default() };
        assert_agrees(&format!("{name}, {count} light samples, hierarchy"), &scene, &options);
        if let Some(device) = with_limits(|limits| limits.subgroup_size = None) {
            assert_agrees_on(&device, &format!("{name}, {count} light samples, rays alone"), &scene, &options);
        }
        assert_agrees(&format!("{name}, {count} light samples"), &scene, &PlanOptions::default());
        let wavefront = PlanOptions { stages: Some(StageMode::Wavefront), ..PlanOptions::default() };
        assert_agrees(&format!("{name}, {count} light samples, wavefront"), &scene, &wavefront);
    }
}

/// Which surfaces take several goes by the depth of the path, of which vertices at null surfaces are no part.
#[test]
fn several_light_samples_agree_where_rays_pass_through_surfaces() {
    let mut scene = veils();
    scene.render.spp = 4;
    for (count, depth) in [(4, 1), (3, 2)] {
        (scene.render.light_samples, scene.render.light_samples_depth) = (count.into(), depth);
        for stages in [StageMode::Fused, StageMode::Wavefront] {
            let options = PlanOptions { stages: Some(stages), ..PlanOptions::default() };
            assert_agrees(&format!("veils, {count} light samples at {depth} surfaces, {stages:?}"), &scene, &options);
        }
    }
}

#[test]
fn every_estimator_and_sampler_agrees_on_several_light_samples() {
    let everywhere = in_full("every number of surfaces with every sampler");
    for (index, sampler) in (0..).zip(SamplerKind::ALL) {
        for (other, estimator) in (0..).zip([Estimator::Mis, Estimator::Nee]) {
            let mut scene = small("cornell", 32, 4);
            (scene.render.sampler, scene.render.estimator, scene.render.light_samples) = (sampler, estimator, 3.into());
            // Every number stands with every estimator, and two of them with every sampler.
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
    for (max_depth, estimator) in [(1, Estimator::Mis), (2, Estimator::Mis), (3, Estimator::Nee), (4, Estimator::Bsdf)] {
        let mut scene = small("cornell", 32, 4);
        (scene.render.max_depth, scene.render.estimator) = (max_depth, estimator);
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
