//! Renders that time or their error ends, and samples that follow the noise.

#[path = "../common/device.rs"]
mod device;

use std::path::Path;
use std::time::{Duration, Instant};

use device::DEVICE;
use gpt::film::Band;
use gpt::gpu::GpuRenderer;
use gpt::plan::{FilmStorage, PlanOptions, StageMode};
use gpt::progressive::{self, Goal, Outcome, Stop};
use gpt::reference::ReferenceRenderer;
use gpt::render::{Allocation, Batch, RenderRequest, Renderer, Silent};
use gpt::scene::{self, SamplerKind, Scene};

fn gpu(scene: &Scene, options: &PlanOptions) -> Option<Box<dyn Renderer>> {
    Some(Box::new(GpuRenderer::on(DEVICE.as_ref()?, scene, options).expect("the scene fits")))
}

fn cpu(scene: &Scene) -> Box<dyn Renderer> {
    Box::new(ReferenceRenderer::new(scene).expect("the reference renders it"))
}

/// The devices that there are, made for allocated samples.
fn renderers(scene: &Scene) -> Vec<Box<dyn Renderer>> {
    let options = PlanOptions { allocation: true, ..PlanOptions::default() };
    [Some(cpu(scene)), gpu(scene, &options)].into_iter().flatten().collect()
}

fn cornell(size: [u32; 2]) -> Scene {
    let mut scene = scene::load(Some("cornell")).expect("it is built in");
    scene.film.size = size;
    scene
}

fn goal(spp: u32) -> Goal {
    Goal { samples: 0..spp, deadline: None, target_error: None, adaptive: false }
}

/// Pixels from the top.
fn pixels(bands: &[Band]) -> Vec<[f32; 3]> {
    bands.iter().flat_map(|band| band.mean.iter().copied()).collect()
}

fn render_goal(renderer: &mut dyn Renderer, scene: &Scene, seed: u32, goal: &Goal) -> (Outcome, Vec<Band>) {
    let mut bands = Vec::new();
    let mut on_band = |band| {
        bands.push(band);
        Ok(())
    };
    let outcome = progressive::render(renderer, scene.film.size, seed, goal, &Silent, &mut on_band).expect("it renders");
    (outcome, bands)
}

fn render_batch(
    renderer: &mut dyn Renderer,
    scene: &Scene,
    samples: u32,
    seed: u32,
    allocation: Option<&Allocation>,
) -> Vec<Band> {
    let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..samples };
    let mut bands = Vec::new();
    let mut on_band = |band| {
        bands.push(band);
        Ok(())
    };
    let batch = Batch { request: &request, seed: Some(seed), allocation };
    renderer.render_batch(&batch, &Silent, &mut on_band).expect("it renders");
    bands
}

/// Every pixel of an allocated batch is, bit for bit, the same pixel of a render that gives all pixels as many samples.
#[test]
fn an_allocated_pixel_is_the_pixel_of_a_render_with_its_samples() {
    let mut scene = cornell([24, 18]);
    for sampler in [SamplerKind::Halton, SamplerKind::Sobol] {
        scene.render.sampler = sampler;
        let levels: Vec<u8> = (0..24 * 18).map(|pixel| (gpt::sampling::hash::mix(pixel) % 5) as u8).collect();
        let allocation = Allocation { levels: levels.clone() };
        let way = |stages, film| PlanOptions { stages: Some(stages), film, allocation: true, ..PlanOptions::default() };
        let ways =
            [way(StageMode::Fused, None), way(StageMode::Wavefront, None), way(StageMode::Wavefront, Some(FilmStorage::Buffer))];
        let mut renderers = vec![cpu(&scene)];
        renderers.extend(ways.iter().filter_map(|options| gpu(&scene, options)));
        for mut renderer in renderers {
            let allocated = render_batch(renderer.as_mut(), &scene, 3, 9, Some(&allocation));
            assert!(allocated.iter().all(|band| band.samples == 3));
            for level in 0..5 {
                let uniform = pixels(&render_batch(renderer.as_mut(), &scene, 3 << level, 9, None));
                let pairs = pixels(&allocated).into_iter().zip(uniform).zip(&levels);
                let different = pairs.clone().filter(|((a, b), of_pixel)| **of_pixel == level && a != b).count();
                assert_eq!(different, 0, "level {level} on {}", renderer.device());
                // The control: pixels of other levels are other means.
                assert!(pairs.filter(|((a, b), of_pixel)| **of_pixel != level && a != b).count() > 200);
            }
        }
    }
}

/// However short the time: every pixel of every band has its sample, and no more samples are begun.
#[test]
fn a_time_that_is_up_leaves_a_whole_picture() {
    // Two bands on the device, five of the reference.
    let scene = cornell([4096, 300]);
    for mut renderer in renderers(&scene) {
        let past = Goal { deadline: Some(Instant::now()), ..goal(1000) };
        let (outcome, bands) = render_goal(renderer.as_mut(), &scene, 0, &past);
        assert_eq!(outcome.stop, Stop::TimeLimit);
        assert!(!outcome.report.interrupted);
        assert_eq!(bands.iter().map(|band| band.rows).sum::<u32>(), 300);
        assert!(bands.iter().all(|band| band.samples == 1));
        assert_eq!(outcome.report.samples, 4096 * 300);
    }
}

/// What time ended is the picture of as many samples: whole steps, of the same samples, weighed rightly.
#[test]
fn a_picture_that_time_ended_is_the_one_of_its_samples() {
    let scene = cornell([64, 48]);
    for mut renderer in renderers(&scene) {
        // A busy machine may need longer for the second sample.
        let (samples, bands) = [300, 1200, 4800, 19_200]
            .into_iter()
            .map(|milliseconds| {
                let deadline = Some(Instant::now() + Duration::from_millis(milliseconds));
                let limited = Goal { deadline, ..goal(1_000_000) };
                let (outcome, bands) = render_goal(renderer.as_mut(), &scene, scene.render.seed, &limited);
                assert_eq!(outcome.stop, Stop::TimeLimit);
                (bands[0].samples, bands)
            })
            .find(|(samples, _)| *samples > 1)
            .expect("several samples of a small picture in twenty seconds");
        assert!(bands.iter().all(|band| band.samples == samples), "{samples}");
        let plain = pixels(&render_batch(renderer.as_mut(), &scene, samples, scene.render.seed, None));
        let one_more = pixels(&render_batch(renderer.as_mut(), &scene, samples + 1, scene.render.seed, None));
        let picture = pixels(&bands);
        let distance = |other: &[[f32; 3]]| {
            let pairs = picture.iter().flatten().zip(other.iter().flatten());
            pairs.map(|(a, b)| f64::from((a - b).abs() / (b + 0.01))).fold(0.0, f64::max)
        };
        assert!(distance(&plain) < 1e-5, "{}", distance(&plain));
        // The control: one sample makes a difference.
        assert!(distance(&one_more) > 1e-5);
    }
}

/// A room in which light is found by chance alone: rare bright samples.
fn rare_light() -> Scene {
    let text = "[film]\nsize = [16, 16]\n[render]\nmax_depth = 2\nestimator = \"bsdf\"\nsampler = \"independent\"\n\
                [camera]\nposition = [0, 0, 3]\nlook_at = [0, 0, 0]\nvfov = 40\n\
                [[material]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.8\n\
                [[material]]\nname = \"light\"\ntype = \"emissive\"\nradiance = 20\n\
                [[shape]]\ntype = \"rectangle\"\ncorner = [-5, -5, 0]\nedge_u = [10, 0, 0]\nedge_v = [0, 10, 0]\nmaterial = \"grey\"\n\
                [[shape]]\ntype = \"rectangle\"\ncorner = [-0.4, -0.4, 4]\nedge_u = [0, 0.8, 0]\nedge_v = [0.8, 0, 0]\nmaterial = \"light\"\n";
    scene::load_toml_str(text, "rare light", Path::new(".")).expect("the scene is valid")
}

/// The same means with next to no noise.
fn sampling_light(scene: &Scene) -> Scene {
    let mut sampled = scene.clone();
    sampled.render.estimator = scene::Estimator::Mis;
    sampled
}

mod promise;
mod unbiased;
