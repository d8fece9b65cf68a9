//! The statistics of a render for other programs: the keys of `--stats` and of a picture's statistics in
//! Python.

use serde::Serialize;

use super::image::Image;
use super::options::RenderOptions;
use super::progressive::Outcome;
use crate::confidence::IntervalEstimate;
use crate::renderer::Decision;
use crate::scene::{RenderSettings, Scene};

/// The keys. They stay as they are; new ones may be added.
#[derive(Debug, Serialize)]
pub struct Stats {
    pub scene: String,
    pub scene_hash: String,
    /// The frame of the scene's keyframes, where one was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame: Option<f64>,
    pub device: String,
    /// Why the CPU renders, where a GPU was looked for.
    pub notice: Option<String>,
    /// `bvh4` or `ray_query`; null where the device tests every primitive, and for the CPU reference.
    pub hierarchy: Option<&'static str>,
    /// The plan's decisions for the device, with reasons; empty for the CPU reference.
    pub decisions: Vec<Decision>,
    /// The parts of the shaders that are compiled; the rest of them is left out.
    pub compiled_in: Vec<&'static str>,
    pub width: u32,
    pub height: u32,
    /// The reconstruction filter's name and radius.
    pub filter: String,
    /// Every setting by its key in `[render]`; `spp` is what was asked for.
    #[serde(flatten)]
    pub settings: RenderSettings,
    /// Samples per pixel that the least finished row has; on average, where they follow the noise.
    pub spp_done: u32,
    /// `samples`, `time_limit`, `target_error`, `target_interval` or `interrupted`.
    pub stopped_by: &'static str,
    pub adaptive: bool,
    /// The relative mean squared error that was to be reached, its estimate by what was sampled, and that with a margin for chance.
    pub target_error: Option<f64>,
    pub expected_error: Option<f64>,
    pub error_bound: Option<f64>,
    /// The estimate is rough and mostly too low, for few bright paths or few pixels make most of it.
    pub tails_decide: Option<bool>,
    /// Emitters shine through glass or by mirrors: light that no path has found is not in the estimate.
    pub light_by_chance: Option<bool>,
    /// The intervals, where some were stated, and how narrow they were to become.
    pub target_interval: Option<f64>,
    pub interval: Option<IntervalEstimate>,
    pub first_sample: u32,
    pub seconds: Seconds,
    /// Samples finished, over all pixels; those of the render that this one went on from are among them.
    pub samples: u64,
    pub resumed_samples: u64,
    pub samples_per_second: f64,
    pub rays: u64,
    pub rays_per_second: f64,
    pub non_finite_samples: u64,
    /// Samples that were brighter than `clamp` allows, and the share of the light at the film that this took; null where nothing is clamped.
    pub clamped_samples: Option<u64>,
    pub clamped_light: Option<f64>,
    pub peak_device_bytes: u64,
    /// Largest resident set of the process so far; null where the system does not say.
    pub peak_host_bytes: Option<u64>,
    /// The peak that was expected before, right within a factor of two. Null where nothing was expected.
    pub expected_host_bytes: Option<u64>,
    /// Mean radiance of the picture.
    pub mean: [f64; 3],
    pub interrupted: bool,
    pub outputs: Vec<String>,
    pub version: &'static str,
}

#[derive(Debug, Default, Serialize)]
pub struct Seconds {
    /// Reading the scene and the files it names.
    pub load: f64,
    /// Paths before the first sample, which say how lights and directions are chosen.
    pub learn: f64,
    /// Acceleration structures and packing.
    pub build: f64,
    /// Shaders and pipelines.
    pub compile: f64,
    pub render: f64,
    /// Waiting for the picture files.
    pub write: f64,
    /// From the program's start to the last picture's place in its folder.
    pub total: f64,
}

impl Stats {
    /// The part that the scene, as it was rendered, and the render know. The fields of the picture and the
    /// program start empty.
    pub fn new(scene: &Scene, options: &RenderOptions, outcome: &Outcome) -> Self {
        let report = &outcome.report;
        let [width, height] = options.crop.map_or(scene.film.size, |[_, _, width, height]| [width, height]);
        let per_second = |count: u64| if report.render_seconds > 0.0 { count as f64 / report.render_seconds } else { 0.0 };
        Self {
            scene: scene.name.clone(),
            scene_hash: String::new(),
            frame: None,
            device: report.device.clone(),
            notice: None,
            hierarchy: report.hierarchy,
            decisions: report.decisions.clone(),
            compiled_in: report.compiled_in.clone(),
            width,
            height,
            filter: scene.film.filter.to_string(),
            settings: scene.render.clone(),
            spp_done: 0,
            stopped_by: outcome.stop.name(),
            adaptive: options.adaptive,
            target_error: options.target_error,
            expected_error: outcome.error.map(|error| error.mean),
            error_bound: outcome.error.map(|error| error.upper),
            tails_decide: outcome.error.map(|error| error.tails_decide()),
            target_interval: options.interval.and_then(|interval| interval.target),
            interval: outcome.interval,
            light_by_chance: outcome.error.map(|_| scene.has_light_by_chance()),
            first_sample: options.first_sample,
            seconds: Seconds {
                learn: report.learn_seconds,
                build: report.build_seconds,
                compile: report.compile_seconds,
                render: report.render_seconds,
                ..Seconds::default()
            },
            samples: report.samples,
            resumed_samples: 0,
            samples_per_second: per_second(report.samples),
            rays: report.rays,
            rays_per_second: per_second(report.rays),
            non_finite_samples: report.non_finite_samples,
            clamped_samples: (scene.render.clamp > 0.0).then_some(report.clamped_samples),
            clamped_light: None,
            peak_device_bytes: report.peak_device_bytes,
            peak_host_bytes: peak_host_bytes(),
            expected_host_bytes: None,
            mean: [0.0; 3],
            interrupted: report.interrupted,
            outputs: Vec::new(),
            version: env!("CARGO_PKG_VERSION"),
        }
    }

    /// The statistics of a picture in memory that was rendered so.
    pub fn of_image(image: &Image, scene: &Scene, options: &RenderOptions) -> Option<Self> {
        let outcome = image.outcome()?;
        let mut stats = Self::new(scene, options, outcome);
        stats.scene_hash = image.scene_hash()?.to_owned();
        let pixels = image.pixels();
        let mut mean = [0.0; 3];
        for pixel in pixels {
            for (mean, value) in mean.iter_mut().zip(pixel) {
                *mean += f64::from(*value) / pixels.len() as f64;
            }
        }
        let average = outcome.report.samples as f64 / pixels.len() as f64;
        let fewest = if options.adaptive { average.round() as u32 } else { image.fewest_samples() };
        stats.picture(scene, outcome, fewest, mean);
        Some(stats)
    }

    /// Adds the picture's own figures: samples of the pixels that have fewest (on average, where samples
    /// follow the noise), and its mean radiance.
    pub fn picture(&mut self, scene: &Scene, outcome: &Outcome, samples: u32, mean: [f64; 3]) {
        self.spp_done = samples;
        self.mean = mean;
        self.clamped_light = self.clamped_samples.map(|_| outcome.report.clamped_light(scene.render.clamp, mean));
    }

    /// So many of the samples were finished by an earlier render; the rates are this one's.
    pub fn resumed(&mut self, samples: u64) {
        self.resumed_samples = samples;
        if self.samples > 0 {
            let share = self.samples.saturating_sub(samples) as f64 / self.samples as f64;
            self.samples_per_second *= share;
            self.rays_per_second *= share;
        }
    }
}

/// The kernel's high-water mark of this process's resident memory, in bytes (Linux).
fn peak_host_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}
