//! Does this device compute right? The GPU against the CPU reference, path by path, with the same random numbers.
//!
//! Both renderers draw the same numbers for the same path, so their samples agree to rounding, save for the few paths in which
//! rounding flips a decision: a ray that grazes an edge, a random number that falls on a threshold. Three questions are asked:
//! what share of paths matches, whether the differences of the rest have mean zero (whole picture and every tile), and
//! whether anything that is not finite turned up.

pub mod closed_forms;
pub mod evidence;
pub mod path;

use std::fmt;

use std::sync::Mutex;

use serde::Serialize;

use crate::compare::image_tests::{ImageComparison, Picture, TileSettings, compare_paired};
use crate::film::Band;
use crate::gpu::{Device, GpuRenderer};
use crate::plan::{Fault, PlanOptions};
use crate::reference::ReferenceRenderer;
use crate::renderer::{DeviceChoice, RenderError, RenderRequest, Renderer, Silent};
use crate::scene::Scene;

/// A path matches where all channels of its radiance agree to this share of the largest. Single precision gives a normal on a
/// curved mesh to some 1e-5, and a lobe of exponent 40 makes tens of times that of it.
pub const PATH_TOLERANCE: f64 = 3e-4;
/// Share of paths that must match.
pub const LEAST_MATCHING: f64 = 0.99;
/// Size of the longer side at which scenes are verified unless told otherwise.
pub const DEFAULT_SIDE: u32 = 128;
/// Samples per pixel unless told otherwise.
pub const DEFAULT_SPP: u32 = 16;

/// What the comparison of one scene found.
#[derive(Serialize)]
pub struct Verdict {
    pub scene: String,
    pub device: String,
    pub width: u32,
    pub height: u32,
    pub spp: u32,
    pub paths: u64,
    pub matching_paths: u64,
    /// Largest difference of one path in one channel, and the root of the mean square over all paths and channels.
    pub largest_difference: f64,
    pub rms_difference: f64,
    /// Pixel and sample of the largest difference.
    pub worst_path: [u32; 3],
    /// Whole-picture means per channel.
    pub gpu_mean: [f64; 3],
    pub cpu_mean: [f64; 3],
    pub non_finite_samples: u64,
    /// Tiles and channels that the tests reject, in words.
    pub rejections: Vec<String>,
    pub agrees: bool,
    /// The fault that was planted on purpose.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub planted: Option<Fault>,
    #[serde(skip)]
    pub gpu: Vec<[f32; 3]>,
    #[serde(skip)]
    pub cpu: Vec<[f32; 3]>,
}

/// Everything but the pictures.
impl fmt::Debug for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&serde_json::to_string_pretty(self).map_err(|_| fmt::Error)?)
    }
}

impl Verdict {
    pub fn matching_share(&self) -> f64 {
        self.matching_paths as f64 / self.paths.max(1) as f64
    }
}

/// Shrinks a scene's film so that its longer side is at most `side`.
pub fn shrink(scene: &mut Scene, side: u32) {
    let [width, height] = scene.film.size;
    let longest = width.max(height);
    if longest > side {
        let scaled = |x: u32| ((u64::from(x) * u64::from(side)).div_ceil(u64::from(longest)) as u32).max(1);
        scene.film.size = [scaled(width), scaled(height)];
    }
}

/// Renders `scene` on both devices, sample by sample, and compares.
///
/// # Errors
/// What either renderer reports.
pub fn verify(scene: &Scene, choice: &DeviceChoice, options: &PlanOptions) -> Result<Verdict, RenderError> {
    verify_on(&Device::open_for(choice, options)?, scene, options)
}

/// As [`verify`], on a device that is already open.
///
/// # Errors
/// What either renderer reports.
pub fn verify_on(device: &Device, scene: &Scene, options: &PlanOptions) -> Result<Verdict, RenderError> {
    let mut gpu = GpuRenderer::on(device, scene, options)?;
    let mut cpu = ReferenceRenderer::new(scene)?;
    let planted = planted(&gpu, options);
    let verdict = compare(scene, device.name.clone(), &mut gpu, &mut cpu)?;
    Ok(Verdict { planted, ..verdict })
}

/// The fault that the kernels hold: none was asked for, or the scene has nothing for it to act on.
fn planted(gpu: &GpuRenderer, options: &PlanOptions) -> Option<Fault> {
    options.fault.filter(|fault| gpu.plan().switches.enabled.contains(fault.switch()))
}

/// As [`verify`], for any two renderers of the scene.
pub fn compare(scene: &Scene, device: String, gpu: &mut dyn Renderer, cpu: &mut dyn Renderer) -> Result<Verdict, RenderError> {
    let [width, height] = scene.film.size;
    let spp = scene.render.spp;
    let pixels = width as usize * height as usize;
    let mut sums = [vec![[0.0_f64; 3]; pixels], vec![[0.0_f64; 3]; pixels]];
    let mut tally = Tally::default();
    let mut non_finite_samples = 0;
    for sample in 0..spp {
        let (ours, refused) = one_sample(gpu, height, sample)?;
        let (theirs, _) = one_sample(cpu, height, sample)?;
        non_finite_samples += refused;
        for (index, (a, b)) in ours.iter().zip(&theirs).enumerate() {
            tally.add(*a, *b, [index as u32 % width, index as u32 / width, sample]);
            for channel in 0..3 {
                sums[0][index][channel] += f64::from(a[channel]);
                sums[1][index][channel] += f64::from(b[channel]);
            }
        }
    }
    let [gpu_picture, cpu_picture] =
        sums.map(|sum| sum.into_iter().map(|s| s.map(|x| (x / f64::from(spp)) as f32)).collect::<Vec<[f32; 3]>>());
    let comparison = test(&gpu_picture, &cpu_picture, width)?;
    let rejections: Vec<String> = comparison.rejected().map(ToString::to_string).collect();
    let paths = pixels as u64 * u64::from(spp);
    let enough_match = tally.matching as f64 >= LEAST_MATCHING * paths as f64;
    Ok(Verdict {
        scene: scene.name.clone(),
        device,
        width,
        height,
        spp,
        paths,
        matching_paths: tally.matching,
        largest_difference: tally.largest,
        rms_difference: (tally.squares / (3.0 * paths as f64)).sqrt(),
        worst_path: tally.worst,
        gpu_mean: comparison.whole.map(|finding| finding.first),
        cpu_mean: comparison.whole.map(|finding| finding.second),
        non_finite_samples,
        agrees: rejections.is_empty() && enough_match && non_finite_samples == 0,
        rejections,
        planted: None,
        gpu: gpu_picture,
        cpu: cpu_picture,
    })
}

/// The paired test of TRUTHS: every tile and the whole picture.
pub fn test(first: &[[f32; 3]], second: &[[f32; 3]], width: u32) -> Result<ImageComparison, RenderError> {
    let settings = TileSettings { tile: 16, ..TileSettings::default() };
    compare_paired(Picture { width, pixels: first }, Picture { width, pixels: second }, &settings)
        .map_err(|error| RenderError::Internal(error.to_string()))
}

#[derive(Default)]
struct Tally {
    matching: u64,
    largest: f64,
    squares: f64,
    worst: [u32; 3],
}

impl Tally {
    fn add(&mut self, a: [f32; 3], b: [f32; 3], path: [u32; 3]) {
        let scale = a.iter().chain(&b).fold(0.0_f64, |largest, x| largest.max(f64::from(x.abs())));
        let mut difference: f64 = 0.0;
        for channel in 0..3 {
            let d = (f64::from(a[channel]) - f64::from(b[channel])).abs();
            self.squares += d * d;
            difference = difference.max(d);
        }
        if difference <= PATH_TOLERANCE * scale {
            self.matching += 1;
        }
        if difference > self.largest {
            self.largest = difference;
            self.worst = path;
        }
    }
}

/// One sample of every pixel, and how many the film refused.
fn one_sample(renderer: &mut dyn Renderer, height: u32, sample: u32) -> Result<(Vec<[f32; 3]>, u64), RenderError> {
    let pixels = Mutex::new(Vec::new());
    let request = RenderRequest { rows: 0..height, samples: sample..sample + 1 };
    let report = renderer.render(&request, &Silent, &mut |band: Band| {
        pixels.lock().unwrap_or_else(std::sync::PoisonError::into_inner).extend(band.mean);
        Ok(())
    })?;
    Ok((pixels.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner), report.non_finite_samples))
}
