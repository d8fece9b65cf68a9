//! Pictures whose every pixel has a value known in closed form, on every device and by every estimator that can see the light.
//!
//! All pixels of a scene here have the same expectation. Each pixel shifts the Halton sequence by a hash of its own, so pixels are
//! independent replications, and Student's t-test judges their mean; the level is shared out over the whole family and all looks at
//! it (Šidák). Every case has its own seed, and must also fail, by the same test, with 1 % of energy added.

mod cases;
mod exact;
mod lights;
mod materials;
mod scenes;

use std::io;

use crate::common::device::DEVICE;
use crate::common::effort::in_full;
use gpt::compare::{Moments, one_sample_t_test_beyond, sidak};
use gpt::cpu::ReferenceRenderer;
use gpt::film::Band;
use gpt::gpu::GpuRenderer;
use gpt::plan::{PlanOptions, StageMode, TraversalChoice};
use gpt::renderer::{RenderRequest, Renderer, Silent};
use gpt::scene::Scene;

use cases::Case;

/// Pixels along each side of the pictures.
pub const SIDE: u32 = 20;
/// Probability that the whole family fails a program that is right.
const ALPHA: f64 = 0.01;
/// Renders a scene by its own settings: pixels row by row from the top.
pub type Render = fn(&Scene) -> Vec<[f32; 3]>;

/// The renderers that are tested: a name, a function, and the relative error that the arithmetic may have.
const DEVICES: [(&str, Render, f64); 3] =
    [("cpu", render_on_cpu, 2e-6), ("gpu, fused", render_fused, 2e-5), ("gpu, wavefront", render_by_wavefront, 2e-5)];

/// All devices. Where there is no GPU, its tests fail, unless `GPT_TEST_GPU=skip` leaves them out.
pub fn devices() -> &'static [(&'static str, Render, f64)] {
    if DEVICE.is_some() { &DEVICES } else { &DEVICES[..1] }
}

fn render_on_cpu(scene: &Scene) -> Vec<[f32; 3]> {
    collect(&mut ReferenceRenderer::new(scene).expect("the scene is supported"), scene)
}

/// Renders by the plan of such small scenes: unrolled geometry, one kernel.
fn render_fused(scene: &Scene) -> Vec<[f32; 3]> {
    render_on_gpu(scene, &PlanOptions::default())
}

/// Renders by the plan of large scenes: a hierarchy, a kernel per stage.
fn render_by_wavefront(scene: &Scene) -> Vec<[f32; 3]> {
    let (traversal, stages) = (TraversalChoice::Bvh, Some(StageMode::Wavefront));
    render_on_gpu(scene, &PlanOptions { traversal, stages, ..PlanOptions::default() })
}

fn render_on_gpu(scene: &Scene, options: &PlanOptions) -> Vec<[f32; 3]> {
    let device = DEVICE.as_ref().expect("asked for only where there is one");
    collect(&mut GpuRenderer::on(device, scene, options).expect("the scene fits"), scene)
}

fn collect(renderer: &mut dyn Renderer, scene: &Scene) -> Vec<[f32; 3]> {
    let mut pixels = Vec::new();
    let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..scene.render.spp };
    let mut on_band = |band: Band| -> io::Result<()> {
        assert_eq!(band.samples, scene.render.spp);
        pixels.extend(band.mean);
        Ok(())
    };
    let report = renderer.render(&request, &Silent, &mut on_band).expect("rendering succeeds");
    assert_eq!(report.non_finite_samples, 0);
    assert_eq!(pixels.len() as u32, scene.film.size[0] * scene.film.size[1]);
    pixels
}

/// Moments of each channel over all pixels, with a part of the case's samples.
fn observe(render: Render, case: &Case, seed: u32, part: u32) -> [Moments; 3] {
    let mut moments = [Moments::default(); 3];
    let mut scene = case.scene.clone();
    scene.render.seed = seed;
    scene.render.spp = scene.render.spp.div_ceil(part);
    for pixel in render(&scene) {
        for (channel, value) in moments.iter_mut().zip(pixel) {
            channel.push(f64::from(value));
        }
    }
    moments
}

#[test]
fn closed_forms_hold() {
    assert_all_hold(&cases::all(), devices());
}

#[test]
#[ignore = "slow"]
fn closed_forms_of_materials_and_blends_hold() {
    assert_all_hold(&materials::all(), devices());
}

#[test]
fn closed_forms_of_normal_maps_hold() {
    assert_all_hold(&materials::with_normal_maps(), devices());
}

/// The wavefront is held to the reference for the same lights elsewhere (`tests/gpu/agreement`).
#[test]
fn closed_forms_of_lights_hold() {
    assert_all_hold(&lights::all(), &devices()[..devices().len().min(2)]);
}

/// One over the parts of a case's samples that are judged in turn: more where fewer do not tell the truth from 1 % more.
const PARTS: [u32; 3] = [8, 3, 1];

/// In the short form each scene's estimators take turns, and a third of the scenes is rendered by the device, some by the wavefront: every estimator
/// costs each way to run a set of kernels for each scene. What the device makes of the others is held to the reference elsewhere.
fn assert_all_hold(all: &[Case], devices: &[(&str, Render, f64)]) {
    let everywhere = in_full("closed forms by every estimator in every scene, and all on the device");
    let estimators = |scene: usize| all.iter().filter(|case| case.of_scene[0] == scene).count();
    let is_taken = |case: &Case, device: usize| {
        let [scene, estimator] = case.of_scene;
        let one_in = [1, 3, 12][device];
        everywhere || estimator == (scene / one_in + device / 2) % estimators(scene) && scene % one_in == device / 2
    };
    let level = sidak(ALPHA, all.len() * 3 * devices.len() * PARTS.len());
    let mut failures = Vec::new();
    for (index, &(device, render, margin)) in devices.iter().enumerate() {
        for (seed, case) in (0..).zip(all).filter(|(_, case)| is_taken(case, index)) {
            let looks = PARTS.iter().map(|&part| Look::at(case, &observe(render, case, seed, part), margin, level));
            let mut last = Look::default();
            for look in looks {
                last = look;
                if last.is_conclusive {
                    break;
                }
            }
            failures.extend(last.faults.iter().map(|fault| format!("{device}, {}, {fault}", case.name)));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// The result of a part of a case's samples.
#[derive(Default)]
struct Look {
    /// Every channel rejects one of the truth and 1 % less. Too few samples reject none, or both where they miss what is rare.
    is_conclusive: bool,
    faults: Vec<String>,
}

impl Look {
    fn at(case: &Case, moments: &[Moments; 3], margin: f64, level: f64) -> Self {
        let mut look = Self { is_conclusive: true, faults: Vec::new() };
        for (channel, (observed, &expected)) in moments.iter().zip(&case.expected).enumerate() {
            let rejects = |truth: f64| one_sample_t_test_beyond(observed, truth, margin * expected).p_value < level;
            let (is_rejected, tells_apart) = (rejects(expected), rejects(expected / 1.01));
            look.is_conclusive &= is_rejected != tells_apart;
            if is_rejected || !tells_apart {
                let missed = if is_rejected { "" } else { "; would pass with 1 % of energy added" };
                let (mean, error) = (observed.mean(), observed.standard_error());
                look.faults.push(format!("channel {channel}: {mean} ± {error}, expected {expected}{missed}"));
            }
        }
        look
    }
}
