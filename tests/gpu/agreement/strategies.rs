//! Every sampler, filter, aperture and projection does the same on both devices.

use gpt::cpu::ReferenceRenderer;
use gpt::gpu::GpuRenderer;
use gpt::plan::{PlanOptions, StageMode};
use gpt::scene::{Aperture, ApertureShape, Filter, FilterKind, PixelSampler, Projection, SamplerKind, Scene};
use gpt::verify::{self, Verdict};

use super::{DEVICE, assert_agrees, small};

/// Each sampler of the path beside another of the pixel, another filter and another aperture, through either kind of lens by turns: what the tests below
/// compare one by one in the long form.
#[test]
fn every_sampler_filter_and_aperture_agrees() {
    let pixel_samplers: Vec<_> = SamplerKind::ALL.map(PixelSampler::Other).into_iter().chain([PixelSampler::Centre]).collect();
    for (index, pixel_sampler) in pixel_samplers.into_iter().enumerate() {
        let (kind, radius) = FILTERS[index % FILTERS.len()];
        let projection = (index % 2 == 1).then_some(Projection::Orthographic { height: 5.0 });
        let mut scene = through_a_lens(APERTURES[index % APERTURES.len()], projection);
        // 13 samples make strata of unequal shape.
        (scene.render.spp, scene.render.seed) = (13, 5);
        scene.render.sampler = SamplerKind::ALL[(index + 1) % SamplerKind::ALL.len()];
        scene.render.pixel_sampler = pixel_sampler;
        scene.film.filter = Filter { kind, radius };
        let stages = Some(if index == 3 { StageMode::Wavefront } else { StageMode::Fused });
        let what = format!("{:?}, pixel {pixel_sampler:?}, {kind:?}, {:?}", scene.render.sampler, scene.camera.aperture);
        assert_agrees(&what, &scene, &PlanOptions { stages, ..PlanOptions::default() });
    }
}

const FILTERS: [(FilterKind, f64); 5] = [
    (FilterKind::Box, 0.5),
    (FilterKind::Box, 1.3),
    (FilterKind::Tent, 1.0),
    (FilterKind::Gaussian, 1.5),
    (FilterKind::BlackmanHarris, 2.0),
];

#[test]
#[ignore = "long: every sampler alone"]
fn long_every_sampler_agrees() {
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
#[ignore = "long: every sampler of the pixel with each of three samplers"]
fn long_every_sampler_of_the_pixel_agrees() {
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

#[test]
#[ignore = "long: every filter alone"]
fn long_every_filter_agrees() {
    for (kind, radius) in FILTERS {
        let mut scene = small("spheres", 32, 8);
        scene.film.filter = Filter { kind, radius };
        scene.render.max_depth = 3;
        assert_agrees(&format!("{kind:?} {radius}"), &scene, &PlanOptions::default());
    }
}

const APERTURES: [ApertureShape; 4] = [
    ApertureShape::Disk,
    ApertureShape::Square,
    ApertureShape::Polygon { blades: 3, rotation_degrees: 0.0 },
    ApertureShape::Polygon { blades: 7, rotation_degrees: -100.0 },
];

/// `spheres` through a lens that is in focus somewhere among them.
fn through_a_lens(shape: ApertureShape, projection: Option<Projection>) -> Scene {
    let mut scene = small("spheres", 32, 8);
    scene.render.max_depth = 3;
    scene.camera.aperture = Some(Aperture { shape, radius: 0.2 });
    scene.camera.focus_distance = (scene.camera.look_at - scene.camera.position).length();
    scene.camera.projection = projection.unwrap_or(scene.camera.projection);
    scene
}

#[test]
#[ignore = "long: every aperture with either projection"]
fn long_every_aperture_and_projection_agrees() {
    let parallel = Projection::Orthographic { height: 5.0 };
    for projection in [None, Some(parallel)] {
        for shape in APERTURES {
            let scene = through_a_lens(shape, projection);
            assert_agrees(&format!("{shape:?} {projection:?}"), &scene, &PlanOptions::default());
        }
        let mut pinhole = through_a_lens(ApertureShape::Disk, projection);
        pinhole.camera.aperture = None;
        assert_agrees(&format!("pinhole {projection:?}"), &pinhole, &PlanOptions::default());
    }
    let wavefront = PlanOptions { stages: Some(StageMode::Wavefront), ..PlanOptions::default() };
    assert_agrees("lens, wavefront", &through_a_lens(APERTURES[3], None), &wavefront);
}

/// The device renders `ours`, the reference `theirs`.
pub fn compare_unequal(ours: &Scene, theirs: &Scene) -> Option<Verdict> {
    let device = DEVICE.as_ref()?;
    let mut gpu = GpuRenderer::on(device, ours, &PlanOptions::default()).expect("the scene fits");
    let mut cpu = ReferenceRenderer::new(theirs).expect("the scene is supported");
    Some(verify::compare(theirs, &mut gpu, &mut cpu, None).expect("both render"))
}

/// The comparison notices when the devices draw from different samplers, be it for the pixel alone.
#[test]
fn another_sampler_is_noticed() {
    let scene = small("spheres", 24, 4);
    let mut changes = vec![scene.clone(), scene.clone(), scene.clone()];
    changes[0].render.sampler = SamplerKind::Halton;
    changes[1].render.pixel_sampler = PixelSampler::Other(SamplerKind::Independent);
    changes[2].render.pixel_sampler = PixelSampler::Centre;
    for changed in changes {
        let Some(verdict) = compare_unequal(&scene, &changed) else { return };
        assert!(!verdict.agrees && verdict.matching_share() < 0.9, "{verdict:#?}");
    }
}

/// Likewise a filter, a lens or a focus that differs a little.
#[test]
#[ignore = "slow"]
fn another_camera_is_noticed() {
    let scene = through_a_lens(ApertureShape::Polygon { blades: 7, rotation_degrees: 10.0 }, None);
    let mut changes = vec![scene.clone(); 4];
    changes[0].film.filter.radius = 0.51;
    changes[1].camera.aperture = Some(Aperture { shape: APERTURES[3], radius: 0.2 });
    changes[2].camera.focus_distance *= 1.02;
    changes[3].film.filter = Filter { kind: FilterKind::Tent, radius: 0.5 };
    for (index, changed) in changes.iter().enumerate() {
        let Some(verdict) = compare_unequal(&scene, changed) else { return };
        assert!(!verdict.agrees && verdict.matching_share() < 0.97, "change {index}: {verdict:#?}");
    }
}

/// Every setting by which strategies are compared, alone and together. A device that does without is noticed.
#[test]
#[ignore = "slow"]
fn what_is_studied_agrees() {
    use gpt::scene::{Estimator, HemisphereSampling, MisHeuristic, PhongCosine, PhongHorizon, PhongSampling, RenderSettings};
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/figures/glossy-reflection.toml");
    let mut plain = gpt::load::load(Some(file)).expect("it is valid");
    verify::shrink(&mut plain, 32);
    plain.render.spp = 8;
    plain.render.max_depth = 4;
    type Change = fn(&mut RenderSettings);
    let changes: [(&str, Change); 10] = [
        ("choose", |render| render.estimator = Estimator::Choose),
        ("choose, roulette, two light samples", |render| {
            (render.estimator, render.roulette_depth, render.light_samples) = (Estimator::Choose, 1.into(), 2.into());
        }),
        ("maximum", |render| render.heuristic = MisHeuristic::Maximum),
        ("cutoff", |render| render.heuristic = MisHeuristic::Cutoff),
        ("exponent 0.7", |render| render.heuristic_exponent = 0.7),
        ("exponent 64", |render| render.heuristic_exponent = 64.0),
        ("without cosine", |render| render.phong_cosine = PhongCosine::Dropped),
        ("by hemisphere", |render| render.phong_sampling = PhongSampling::Hemisphere),
        ("flipped", |render| render.phong_horizon = PhongHorizon::Flipped),
        ("all together", |render| {
            (render.estimator, render.heuristic) = (Estimator::Choose, MisHeuristic::Cutoff);
            (render.phong_cosine, render.phong_sampling) = (PhongCosine::Dropped, PhongSampling::Hemisphere);
            (render.phong_horizon, render.hemisphere) = (PhongHorizon::Flipped, HemisphereSampling::Uniform);
            render.sampler = SamplerKind::Congruential;
        }),
    ];
    for (index, (what, change)) in changes.into_iter().enumerate() {
        let mut scene = plain.clone();
        change(&mut scene.render);
        let stages = (index % 3 == 1).then_some(StageMode::Wavefront);
        assert_agrees(what, &scene, &PlanOptions { stages, ..PlanOptions::default() });
        let Some(verdict) = compare_unequal(&scene, &plain) else { return };
        assert!(!verdict.agrees, "{what}: {verdict:#?}");
    }
}

/// Diffuse lobes, alone and inside phong, over the uniform hemisphere. A device that samples the other one is noticed.
#[test]
fn uniform_hemispheres_agree() {
    use gpt::scene::{ColorInput, HemisphereSampling, MaterialKind};
    let mut scene = small("cornell", 32, 8);
    scene.render.max_depth = 4;
    let phong = |reflectance: &ColorInput| MaterialKind::Phong {
        diffuse: *reflectance,
        specular: ColorInput::grey(0.2),
        exponent: ColorInput::grey(9.0),
    };
    if let Some(material) = scene.materials.iter_mut().find(|material| matches!(material.kind, MaterialKind::Diffuse { .. }))
        && let MaterialKind::Diffuse { reflectance } = &material.kind
    {
        material.kind = phong(reflectance);
    }
    let cosine = scene.clone();
    scene.render.hemisphere = HemisphereSampling::Uniform;
    assert_agrees("uniform hemisphere", &scene, &PlanOptions::default());
    let Some(verdict) = compare_unequal(&scene, &cosine) else { return };
    assert!(verdict.matching_share() < 0.5, "{verdict:#?}");
}
