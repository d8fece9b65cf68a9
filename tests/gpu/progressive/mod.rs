//! Renders that time or their error ends, and samples that follow the noise.

use std::ops::Range;
use std::path::Path;
use std::time::{Duration, Instant};

use crate::common::device::{DEVICE, with_limits};
use crate::common::effort::in_full;
use gpt::cpu::ReferenceRenderer;
use gpt::film::Band;
use gpt::gpu::{Device, GpuRenderer};
use gpt::load;
use gpt::plan::{PlanOptions, StageMode};
use gpt::render::progressive::{self, Goal, Outcome, Stop};
use gpt::renderer::{Batch, RenderRequest, Renderer, Silent};
use gpt::scene::{self, SamplerKind, Scene};

fn gpu(device: Option<&Device>, scene: &Scene, options: &PlanOptions) -> Option<Box<dyn Renderer>> {
    Some(Box::new(GpuRenderer::on(device?, scene, options).expect("the scene fits")))
}

fn cpu(scene: &Scene) -> Box<dyn Renderer> {
    Box::new(ReferenceRenderer::new(scene).expect("the reference renders it"))
}

/// The devices that there are, made to leave pixels out.
fn renderers(scene: &Scene) -> Vec<Box<dyn Renderer>> {
    let options = PlanOptions { pixel_list: true, ..PlanOptions::default() };
    [Some(cpu(scene)), gpu(DEVICE.as_ref(), scene, &options)].into_iter().flatten().collect()
}

fn cornell(size: [u32; 2]) -> Scene {
    let mut scene = load::load(Some("cornell")).expect("it is built in");
    scene.film.size = size;
    scene
}

fn goal(spp: u32) -> Goal {
    Goal { samples: 0..spp, region: None, deadline: None, target_error: None, adaptive: false, interval: None }
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
    samples: Range<u32>,
    seed: u32,
    selection: Option<&[bool]>,
) -> Vec<Band> {
    let request = RenderRequest { rows: 0..scene.film.size[1], samples };
    let mut bands = Vec::new();
    let mut on_band = |band| {
        bands.push(band);
        Ok(())
    };
    let batch = Batch { seed: Some(seed), selection, ..Batch::of(&request) };
    renderer.render_batch(&batch, &Silent, &mut on_band).expect("it renders");
    bands
}

/// Every selected pixel is, bit for bit, the same pixel of a render of all, and the others have nothing, though an earlier batch left its
/// samples in the device's film.
#[test]
fn a_selected_pixel_is_the_pixel_of_a_render_of_all() {
    let mut scene = cornell([24, 18]);
    let everywhere = in_full("selected pixels of Sobol' points by the wavefront");
    for sampler in [SamplerKind::Halton, SamplerKind::Sobol] {
        scene.render.sampler = sampler;
        let selection: Vec<bool> = (0..24 * 18).map(|pixel| gpt::sampling::hash::mix(pixel).is_multiple_of(3)).collect();
        let way = |stages| PlanOptions { stages: Some(stages), pixel_list: true, ..PlanOptions::default() };
        let film_in_buffers = with_limits(|limits| limits.read_write_rgba32float = false);
        let mut renderers = vec![cpu(&scene)];
        renderers.extend(gpu(DEVICE.as_ref(), &scene, &way(StageMode::Fused)));
        if sampler == SamplerKind::Halton || everywhere {
            renderers.extend(gpu(DEVICE.as_ref(), &scene, &way(StageMode::Wavefront)));
            renderers.extend(gpu(film_in_buffers.as_ref(), &scene, &way(StageMode::Wavefront)));
        }
        for mut renderer in renderers {
            let all = pixels(&render_batch(renderer.as_mut(), &scene, 5..12, 9, None));
            let bands = render_batch(renderer.as_mut(), &scene, 5..12, 9, Some(&selection));
            assert!(bands.iter().all(|band| band.samples == 7));
            let selected = pixels(&bands);
            for ((pixel, of_all), takes_part) in selected.iter().zip(&all).zip(&selection) {
                assert_eq!(*pixel, if *takes_part { *of_all } else { [0.0; 3] }, "on {}", renderer.device());
            }
            // The control: other samples are another picture.
            let others = pixels(&render_batch(renderer.as_mut(), &scene, 0..7, 9, Some(&selection)));
            assert!(selected.iter().zip(others).filter(|(a, b)| *a != b).count() > 100);
        }
    }
}

/// The samples of one pixel are the first of one sequence, however they were found to be wanted.
#[test]
fn a_pixel_that_follows_the_noise_has_the_first_samples_of_its_sequence() {
    let scene = cornell([32, 24]);
    for mut renderer in renderers(&scene) {
        let adaptive = Goal { adaptive: true, ..goal(16) };
        let (outcome, bands) = render_goal(renderer.as_mut(), &scene, 5, &adaptive);
        assert_eq!(outcome.stop, Stop::Samples);
        assert!(bands.iter().all(|band| band.samples == 16));
        let spent = outcome.report.samples as f64 / (32.0 * 24.0);
        assert!((14.0..=16.0).contains(&spent), "{spent}");
        let picture = pixels(&bands);
        let prefixes = [8, 16, 32, 64].map(|samples| pixels(&render_batch(renderer.as_mut(), &scene, 0..samples, 5, None)));
        let close = |a: &[f32; 3], b: &[f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-5 * (b + 0.01));
        let mut of_prefix = [0; 4];
        for (pixel, radiance) in picture.iter().enumerate() {
            let found = prefixes.iter().position(|prefix| close(radiance, &prefix[pixel]));
            of_prefix[found.expect("it is one of the four means")] += 1;
        }
        assert!(of_prefix[0] > 50 && of_prefix[1..].iter().sum::<i32>() > 50, "{of_prefix:?}");
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

/// A picture that time ended equals the picture of as many samples: whole steps, of the same samples, weighed
/// rightly.
#[test]
#[ignore = "slow"]
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
        let plain = pixels(&render_batch(renderer.as_mut(), &scene, 0..samples, scene.render.seed, None));
        let one_more = pixels(&render_batch(renderer.as_mut(), &scene, 0..samples + 1, scene.render.seed, None));
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

/// Bit for bit, for no step of the way there rounds.
#[test]
fn a_time_that_is_not_up_changes_nothing() {
    let scene = cornell([40, 30]);
    for mut renderer in renderers(&scene) {
        let seed = scene.render.seed;
        let far = Instant::now().checked_add(Duration::from_secs(100_000));
        let (outcome, limited) = render_goal(renderer.as_mut(), &scene, seed, &Goal { deadline: far, ..goal(37) });
        assert_eq!((outcome.stop, outcome.report.samples), (Stop::Samples, 37 * 40 * 30));
        let plain = pixels(&render_batch(renderer.as_mut(), &scene, 0..37, seed, None));
        assert!(pixels(&limited) == plain, "on {}", renderer.device());
        let fewer = pixels(&render_batch(renderer.as_mut(), &scene, 0..36, seed, None));
        assert!(fewer != plain, "the control: one sample less is another picture");
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
    load::load_toml_str(text, "rare light", Path::new(".")).expect("the scene is valid")
}

/// A scene of equal means with next to no noise.
fn sampling_light(scene: &Scene) -> Scene {
    let mut sampled = scene.clone();
    sampled.render.estimator = scene::Estimator::Mis;
    sampled
}

mod promise;
mod unbiased;
