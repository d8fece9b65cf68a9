//! Does this device compute right? The GPU against the CPU reference, path by path, with the same random numbers.
//!
//! Both renderers draw the same numbers for the same path, so their samples agree to rounding, save for the few paths in which
//! rounding flips a decision (a ray that grazes an edge, a random number that falls on a threshold) or is magnified. Five questions are
//! asked: what share of paths matches, where that is known of the scene; whether [rounding explains](cause) those that do not; whether the
//! differences have mean zero, over the whole picture and every tile; and whether anything that is not finite turned up.
//! docs/verification.md has the limits and why they are what they are.

pub mod cause;
pub mod closed_forms;
pub mod evidence;
pub mod path;
pub mod shares;

use std::fmt;

use std::sync::Mutex;

use serde::Serialize;

use crate::compare::image_tests::{ImageComparison, ImageView, TileSettings, compare_paired};
use crate::cpu::ReferenceRenderer;
use crate::film::Band;
use crate::gpu::{Device, GpuRenderer};
use crate::plan::{Fault, PlanOptions};
use crate::renderer::{DeviceChoice, Observer, RenderError, RenderRequest, Renderer, Silent};
use crate::scene::Scene;
use cause::{Cause, Differing, Selection};

/// A path matches where all channels of its radiance agree to this share of the largest.
pub const PATH_TOLERANCE: f64 = 1e-4;
/// A path matches loosely where they agree to this share: what single precision gives a glossy lobe on a curved mesh.
pub const LOOSE_TOLERANCE: f64 = 3e-4;
/// So many of the paths that do not match are followed on the reference to find out why; if there are more, that many drawn at random. Where
/// all of these are explained, at most 0.3 % of the others are not, with 95 % confidence.
pub const MOST_FOLLOWED: usize = 1024;
/// Following ends early at so many paths that nothing explains.
const ENOUGH_UNEXPLAINED: usize = 16;
/// Size of the longer side at which scenes are verified unless told otherwise.
pub const DEFAULT_SIDE: u32 = 128;
/// Samples per pixel unless told otherwise.
pub const DEFAULT_SPP: u32 = 16;

/// The result of comparing one scene.
#[derive(Serialize)]
pub struct Verdict {
    /// The scene's name.
    pub scene: String,
    /// The name of the device that was compared with the reference.
    pub device: String,
    /// Columns of the pictures.
    pub width: u32,
    /// Rows of the pictures.
    pub height: u32,
    /// Samples of each pixel.
    pub spp: u32,
    /// Samples of all pixels.
    pub paths: u64,
    /// Paths whose radiance agrees to [`PATH_TOLERANCE`].
    pub matching_paths: u64,
    /// Paths whose radiance agrees to [`LOOSE_TOLERANCE`].
    pub loosely_matching_paths: u64,
    /// Share of paths that have to match; None where the scene's is not known.
    pub least_matching_share: Option<f64>,
    /// Paths that do not match and were followed again on the reference, for an explanation.
    pub followed_paths: u64,
    /// Followed paths that rounding turns over at a decision ([`Cause::Decision`]).
    pub explained_by_a_decision: u64,
    /// Followed paths that magnify rounding ([`Cause::Steepness`]).
    pub explained_by_steepness: u64,
    /// Differences that rounding does not explain, the largest first.
    pub unexplained_paths: Vec<UnexplainedPath>,
    /// Largest difference of one path in one channel, and the root of the mean square over all paths and channels.
    pub largest_difference: f64,
    /// See `largest_difference`.
    pub rms_difference: f64,
    /// Pixel and sample of the largest difference.
    pub worst_path: [u32; 3],
    /// Whole-picture means per channel.
    pub gpu_mean: [f64; 3],
    /// See `gpu_mean`.
    pub cpu_mean: [f64; 3],
    /// Samples of the device that its film refused.
    pub non_finite_samples: u64,
    /// Tiles and channels that the tests reject, in words.
    pub rejections: Vec<String>,
    /// Which limits were missed, in words; empty where the devices agree.
    pub missed: Vec<String>,
    /// True if no limit was missed.
    pub agrees: bool,
    /// The fault that was planted on purpose.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub planted: Option<Fault>,
    /// The device's picture, row by row from the top.
    #[serde(skip)]
    pub gpu: Vec<[f32; 3]>,
    /// The reference's picture.
    #[serde(skip)]
    pub cpu: Vec<[f32; 3]>,
}

/// A path whose radiance differs by more than rounding explains.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct UnexplainedPath {
    pub pixel: [u32; 2],
    pub sample: u32,
    pub gpu: [f32; 3],
    pub cpu: [f32; 3],
}

/// Everything but the pictures.
impl fmt::Debug for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&serde_json::to_string_pretty(self).map_err(|_| fmt::Error)?)
    }
}

impl Verdict {
    /// The share of paths that match.
    pub fn matching_share(&self) -> f64 {
        self.matching_paths as f64 / self.paths.max(1) as f64
    }

    /// The share of paths that match loosely.
    pub fn loosely_matching_share(&self) -> f64 {
        self.loosely_matching_paths as f64 / self.paths.max(1) as f64
    }

    /// Column, row and sample of the path to look into: the largest difference that nothing explains, else the largest of all.
    pub fn path_to_follow(&self) -> [u32; 3] {
        self.unexplained_paths.first().map_or(self.worst_path, |path| [path.pixel[0], path.pixel[1], path.sample])
    }
}

/// Shrinks a scene's film so that its longer side is at most `side`, or has a pixel of each view. It still divides into the camera's views.
pub fn shrink(scene: &mut Scene, side: u32) {
    let longest = scene.film.size.into_iter().max().unwrap_or(0);
    if longest > side {
        let (tiles, view) = (scene.camera.tiles(), scene.camera.view_size(scene.film.size));
        let scaled = |x: u32| {
            let wide = u64::from(x) * u64::from(side);
            (if tiles == [1, 1] { wide.div_ceil(u64::from(longest)) } else { wide / u64::from(longest) } as u32).max(1)
        };
        scene.film.size = [tiles[0] * scaled(view[0]), tiles[1] * scaled(view[1])];
    }
}

/// Renders `scene` on both devices, sample by sample, and compares.
///
/// # Errors
/// Errors of either renderer.
pub fn verify(scene: &Scene, choice: &DeviceChoice, options: &PlanOptions) -> Result<Verdict, RenderError> {
    verify_on(&Device::open_for(choice, options)?, scene, options, None)
}

/// Does the work of [`verify`]; None where the observer ends it.
///
/// # Errors
/// Errors of either renderer.
pub fn verify_watched(
    scene: &Scene,
    choice: &DeviceChoice,
    options: &PlanOptions,
    observer: &dyn Observer,
) -> Result<Option<Verdict>, RenderError> {
    let mut gpu = GpuRenderer::on(&Device::open_for(choice, options)?, scene, options)?;
    let mut cpu = ReferenceRenderer::of_length(scene, None, gpu.effort())?;
    compare_watched(scene, &mut gpu, &mut cpu, None, observer)
}

/// Does the work of [`verify`] on a device that is already open. `share` is what is [known](shares) of the
/// scene's share of matching paths.
///
/// # Errors
/// Errors of either renderer.
pub fn verify_on(
    device: &Device,
    scene: &Scene,
    options: &PlanOptions,
    share: Option<shares::MeasuredShare>,
) -> Result<Verdict, RenderError> {
    let mut gpu = GpuRenderer::on(device, scene, options)?;
    let mut cpu = ReferenceRenderer::of_length(scene, None, gpu.effort())?;
    let planted = planted(&gpu, options);
    let verdict = compare(scene, &mut gpu, &mut cpu, share)?;
    Ok(Verdict { planted, ..verdict })
}

/// The fault that the kernels hold: none was asked for, or the scene has nothing for it to act on.
fn planted(gpu: &GpuRenderer, options: &PlanOptions) -> Option<Fault> {
    options.fault.filter(|fault| gpu.plan().switches.enabled.contains(fault.switch()))
}

/// Does the work of [`verify`] for any renderer and a reference.
///
/// # Errors
/// Errors of either renderer.
pub fn compare(
    scene: &Scene,
    gpu: &mut dyn Renderer,
    cpu: &mut ReferenceRenderer,
    share: Option<shares::MeasuredShare>,
) -> Result<Verdict, RenderError> {
    let verdict = compare_watched(scene, gpu, cpu, share, &Silent)?;
    verdict.ok_or_else(|| RenderError::Internal("the comparison ended without being asked to".to_owned()))
}

/// Does the work of [`compare`]; None where the observer ends it.
///
/// # Errors
/// Errors of either renderer.
pub fn compare_watched(
    scene: &Scene,
    gpu: &mut dyn Renderer,
    cpu: &mut ReferenceRenderer,
    share: Option<shares::MeasuredShare>,
    observer: &dyn Observer,
) -> Result<Option<Verdict>, RenderError> {
    let [width, height] = scene.film.size;
    let spp = scene.render.spp;
    let pixels = width as usize * height as usize;
    let mut sums = [vec![[0.0_f64; 3]; pixels], vec![[0.0_f64; 3]; pixels]];
    let mut tally = Tally::default();
    let mut non_finite_samples = 0;
    for sample in 0..spp {
        let (ours, refused) = one_sample(gpu, height, sample, observer)?;
        let (theirs, _) = one_sample(cpu, height, sample, observer)?;
        if observer.stop_requested() {
            return Ok(None);
        }
        non_finite_samples += refused;
        for (index, (a, b)) in ours.iter().zip(&theirs).enumerate() {
            tally.add(&Differing { path: [index as u32 % width, index as u32 / width, sample], first: *a, second: *b });
            for channel in 0..3 {
                sums[0][index][channel] += f64::from(a[channel]);
                sums[1][index][channel] += f64::from(b[channel]);
            }
        }
    }
    let [gpu_picture, cpu_picture] =
        sums.map(|sum| sum.into_iter().map(|s| s.map(|x| (x / f64::from(spp)) as f32)).collect::<Vec<[f32; 3]>>());
    let comparison = test(&gpu_picture, &cpu_picture, width)?;
    let paths = pixels as u64 * u64::from(spp);
    let mean = cpu_picture.iter().flatten().map(|value| f64::from(value.abs())).sum::<f64>() / (3 * pixels) as f64;
    let Some(followed) = follow(tally.differing.into_chosen(), cpu, cause::of_cancellation(mean), observer) else {
        return Ok(None);
    };
    let mut verdict = Verdict {
        scene: scene.name.clone(),
        device: gpu.device().to_owned(),
        width,
        height,
        spp,
        paths,
        matching_paths: tally.matching,
        loosely_matching_paths: tally.loosely_matching,
        least_matching_share: share.map(|share| share.least_of(paths)),
        followed_paths: followed.paths,
        explained_by_a_decision: followed.by_a_decision,
        explained_by_steepness: followed.by_steepness,
        unexplained_paths: followed.unexplained,
        largest_difference: tally.largest,
        rms_difference: (tally.squares / (3.0 * paths as f64)).sqrt(),
        worst_path: tally.worst,
        gpu_mean: comparison.whole.map(|finding| finding.first),
        cpu_mean: comparison.whole.map(|finding| finding.second),
        non_finite_samples,
        rejections: comparison.rejected().map(ToString::to_string).collect(),
        missed: Vec::new(),
        agrees: false,
        planted: None,
        gpu: gpu_picture,
        cpu: cpu_picture,
    };
    verdict.missed = missed(&verdict);
    verdict.agrees = verdict.missed.is_empty();
    Ok(Some(verdict))
}

/// Each limit that a verdict misses, with what was wanted and what was found.
fn missed(verdict: &Verdict) -> Vec<String> {
    let mut missed = Vec::new();
    if let Some(least) = verdict.least_matching_share.filter(|least| verdict.matching_share() < *least) {
        let found = 100.0 * verdict.matching_share();
        missed.push(format!("{found:.4} % of the paths match, and of this scene at least {:.4} % do", 100.0 * least));
    }
    if let Some(worst) = verdict.unexplained_paths.first() {
        let (count, followed) = (verdict.unexplained_paths.len(), verdict.followed_paths);
        missed.push(format!(
            "{count} of {followed} paths that were followed differ by more than rounding explains, and none may; sample {} of pixel {},{} is \
             {:?} on the GPU and {:?} on the CPU",
            worst.sample, worst.pixel[0], worst.pixel[1], worst.gpu, worst.cpu
        ));
    }
    if !verdict.rejections.is_empty() {
        let count = verdict.rejections.len();
        missed.push(format!("the means of {count} regions and channels differ by more than chance explains, and none may"));
    }
    if verdict.non_finite_samples > 0 {
        missed.push(format!("{} samples are not finite, and none may be", verdict.non_finite_samples));
    }
    missed
}

/// The results of following paths.
#[derive(Default)]
struct Followed {
    paths: u64,
    by_a_decision: u64,
    by_steepness: u64,
    unexplained: Vec<UnexplainedPath>,
}

/// Finds out why these paths differ, the largest difference first; None where the observer ends it.
fn follow(
    mut differing: Vec<Differing>,
    reference: &ReferenceRenderer,
    of_cancellation: f64,
    observer: &dyn Observer,
) -> Option<Followed> {
    differing.sort_by(|a, b| b.difference().total_cmp(&a.difference()));
    let mut followed = Followed::default();
    for path in differing {
        if observer.stop_requested() {
            return None;
        }
        followed.paths += 1;
        let cause = if path.difference() <= of_cancellation { Cause::Steepness } else { cause::of(&path, reference) };
        match cause {
            Cause::Decision => followed.by_a_decision += 1,
            Cause::Steepness => followed.by_steepness += 1,
            Cause::Unexplained => {
                let [x, y, sample] = path.path;
                let unexplained = UnexplainedPath { pixel: [x, y], sample, gpu: path.first, cpu: path.second };
                followed.unexplained.push(unexplained);
                if followed.unexplained.len() == ENOUGH_UNEXPLAINED {
                    break;
                }
            }
        }
    }
    Some(followed)
}

/// The paired tests of every tile and of the whole picture.
pub fn test(first: &[[f32; 3]], second: &[[f32; 3]], width: u32) -> Result<ImageComparison, RenderError> {
    let settings = TileSettings { tile: 16, ..TileSettings::default() };
    compare_paired(ImageView { width, pixels: first }, ImageView { width, pixels: second }, &settings)
        .map_err(|error| RenderError::Internal(error.to_string()))
}

struct Tally {
    matching: u64,
    loosely_matching: u64,
    largest: f64,
    squares: f64,
    worst: [u32; 3],
    differing: Selection,
}

impl Default for Tally {
    fn default() -> Self {
        Self {
            matching: 0,
            loosely_matching: 0,
            largest: 0.0,
            squares: 0.0,
            worst: [0; 3],
            differing: Selection::of_at_most(MOST_FOLLOWED),
        }
    }
}

impl Tally {
    fn add(&mut self, pair: &Differing) {
        let Differing { first, second, path } = pair;
        for (a, b) in first.iter().zip(second) {
            let d = f64::from(*a) - f64::from(*b);
            self.squares += d * d;
        }
        let difference = pair.difference();
        if pair.agrees_to(LOOSE_TOLERANCE) {
            self.loosely_matching += 1;
        }
        if pair.agrees_to(PATH_TOLERANCE) {
            self.matching += 1;
        } else {
            self.differing.add(*pair);
        }
        if difference > self.largest {
            self.largest = difference;
            self.worst = *path;
        }
    }
}

/// One sample of every pixel, and how many the film refused.
fn one_sample(
    renderer: &mut dyn Renderer,
    height: u32,
    sample: u32,
    observer: &dyn Observer,
) -> Result<(Vec<[f32; 3]>, u64), RenderError> {
    let pixels = Mutex::new(Vec::new());
    let request = RenderRequest { rows: 0..height, samples: sample..sample + 1 };
    let report = renderer.render(&request, observer, &mut |band: Band| {
        pixels.lock().unwrap_or_else(std::sync::PoisonError::into_inner).extend(band.mean);
        Ok(())
    })?;
    Ok((pixels.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner), report.non_finite_samples))
}
