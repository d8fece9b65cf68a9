//! The film after very many samples: means keep their digits, second moments stay what they are.

use gpt::cpu::ReferenceRenderer;
use gpt::gpu::Device;
use gpt::plan::{PlanOptions, StageMode};
use gpt::scene::Scene;

use super::support::{DEVICE, Effort, Finding, render_band_on, scene, whole_picture, with_limits};

/// Largest relative error of a mean.
const MEAN_ERROR: f64 = 1e-6;
/// Largest relative error of a second moment: squares are summed in f32, and a variance is worth no more.
const SQUARE_ERROR: f64 = 1e-4;

pub fn findings(effort: Effort) -> Vec<Finding> {
    if DEVICE.is_none() {
        return Vec::new();
    }
    let spp = effort.pick(1 << 15, 1_000_000);
    let mut findings = Vec::new();
    let in_buffers = with_limits(|limits| limits.read_write_rgba32float = false);
    for (storage, device) in [("textures", DEVICE.as_ref()), ("buffers", in_buffers.as_ref())] {
        for (stage, stages) in [("fused", StageMode::Fused), ("wavefront", StageMode::Wavefront)] {
            if effort == Effort::Bounded && (storage == "buffers") == (stages == StageMode::Fused) {
                continue;
            }
            let Some(device) = device else { continue };
            let options = PlanOptions { stages: Some(stages), ..PlanOptions::default() };
            for (name, scene) in [("of 0.1", constant(spp)), ("between 1e-3 and 1e3", varying(spp))] {
                findings.push(accumulated(format!("{spp} samples {name}; film in {storage}, {stage}"), device, &scene, &options));
            }
        }
    }
    findings
}

/// 0.1 is no f32, so a plain sum would drift by 10⁻³ at a million samples.
fn constant(spp: u32) -> Scene {
    scene(&format!(
        "[film]\nsize = [4, 2]\n[render]\nspp = {spp}\nmax_depth = 1\n[camera]\nposition = [0, 0, 0]\nlook_at = [0, 0, 1]\nvfov = 60\n\
         [[light]]\ntype = \"environment\"\nradiance = 0.1\n"
    ))
}

/// Every sample another value, over six powers of ten, without any edge that rounding could put a sample across.
fn varying(spp: u32) -> Scene {
    scene(&format!(
        "[film]\nsize = [4, 2]\n[render]\nspp = {spp}\nmax_depth = 1\nsampler = \"independent\"\n\
         [camera]\nposition = [0, 0, 0]\nlook_at = [0, 1.5, 1]\nvfov = 60\n\
         [[light]]\ntype = \"sky\"\nzenith = 1000\nhorizon = 0.001\nground = 0.001\n"
    ))
}

#[allow(dead_code, reason = "the bench shows it nothing wrong")]
/// The sum that a film without compensation would make of the constant.
pub fn plain_sum(spp: u32) -> Finding {
    let sum = (0..spp).fold(0.0_f32, |sum, _| sum + 0.1);
    let error = (f64::from(sum) / f64::from(spp) / f64::from(0.1_f32) - 1.0).abs();
    Finding::new("a plain sum").require(error <= MEAN_ERROR, || format!("the mean is off by {error:e}"))
}

fn accumulated(case: String, device: &Device, scene: &Scene, options: &PlanOptions) -> Finding {
    let (ours, report) = render_band_on(device, scene, options);
    let (truth, _) = whole_picture(&mut ReferenceRenderer::new(scene).expect("the scene is supported"), scene);
    let relative = |a: f32, b: f32| (f64::from(a) / f64::from(b) - 1.0).abs();
    let means = ours.mean.iter().zip(&truth.mean).map(|(a, b)| relative(a[0], b[0])).fold(0.0, f64::max);
    let squares = ours.second_moment.iter().zip(&truth.second_moment).map(|(a, b)| relative(*a, *b)).fold(0.0, f64::max);
    let least = ours.second_moment.iter().copied().fold(f32::INFINITY, f32::min);
    Finding::new(case)
        .with("largest error of a mean", format!("{means:.1e}"))
        .with("of a second moment", format!("{squares:.1e}"))
        .with("not finite", report.non_finite_samples)
        .require(means <= MEAN_ERROR, || format!("a mean is off by {means:e}"))
        .require(least >= 0.0 && squares <= SQUARE_ERROR, || {
            format!("second moments are off by {squares:e}, the least is {least}")
        })
}
