//! Every sampler, of the path and of the pixel, draws the same numbers on both devices.

use gpt::gpu::GpuRenderer;
use gpt::plan::{PlanOptions, StageMode};
use gpt::reference::ReferenceRenderer;
use gpt::scene::{PixelSampler, SamplerKind, Scene};
use gpt::verify::{self, Verdict};

use super::{DEVICE, assert_agrees, small};

#[test]
fn every_sampler_agrees() {
    for sampler in SamplerKind::ALL {
        // 13 samples make strata of unequal shape; more bounces than sequences cover.
        let mut scene = small("cornell", 32, 13);
        scene.render.sampler = sampler;
        scene.render.seed = 5;
        assert_agrees(&format!("{sampler:?}"), &scene, &PlanOptions::default());
    }
    let mut scene = small("spheres", 32, 6);
    scene.render.sampler = SamplerKind::Sobol;
    let wavefront = PlanOptions { stages: Some(StageMode::Wavefront), ..PlanOptions::default() };
    assert_agrees("Sobol, wavefront", &scene, &wavefront);
}

#[test]
fn every_sampler_of_the_pixel_agrees() {
    let pixel_samplers = SamplerKind::ALL.map(PixelSampler::Other).into_iter().chain([PixelSampler::Centre]);
    for pixel_sampler in pixel_samplers {
        for sampler in [SamplerKind::Independent, SamplerKind::Halton, SamplerKind::Sobol] {
            let mut scene = small("spheres", 24, 5);
            scene.render.sampler = sampler;
            scene.render.pixel_sampler = pixel_sampler;
            scene.render.max_depth = 3;
            assert_agrees(&format!("{sampler:?}, pixel {pixel_sampler:?}"), &scene, &PlanOptions::default());
        }
    }
}

/// The device renders `ours`, the reference `theirs`.
fn compare_unequal(ours: &Scene, theirs: &Scene) -> Option<Verdict> {
    let device = DEVICE.as_ref()?;
    let mut gpu = GpuRenderer::on(device, ours, &PlanOptions::default()).expect("the scene fits");
    let mut cpu = ReferenceRenderer::new(theirs).expect("the scene is supported");
    Some(verify::compare(theirs, device.name.clone(), &mut gpu, &mut cpu).expect("both render"))
}

/// The same comparison notices when the devices draw from different samplers, be it for the pixel alone.
#[test]
fn another_sampler_is_noticed() {
    let scene = small("spheres", 24, 4);
    let mut changes = vec![scene.clone(), scene.clone(), scene.clone()];
    changes[0].render.sampler = SamplerKind::Sobol;
    changes[1].render.pixel_sampler = PixelSampler::Other(SamplerKind::Independent);
    changes[2].render.pixel_sampler = PixelSampler::Centre;
    for changed in changes {
        let Some(verdict) = compare_unequal(&changed, &scene) else { return };
        assert!(!verdict.agrees && verdict.matching_share() < 0.9, "{verdict:#?}");
    }
}
