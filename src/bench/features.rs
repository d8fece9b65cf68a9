//! The cost of a feature: used, and only compiled in.
//!
//! Every feature is measured in a room beside the same room without it, in turn. *Compiled in* renders the plain room by kernels that hold
//! the feature's code though nothing there needs it: what "a scene compiles only what it uses" saves. *Used* renders a room that has it.

use std::collections::BTreeSet;
use std::time::Instant;

use serde::Serialize;

use super::feature_rooms::Feature;
use super::interval::{Ratio, Spread};
use super::scenes::Room;
use super::subject::{BenchError, Devices, SceneSubject, Subject};
use crate::gpu::{Device, GpuRenderer};
use crate::plan::PlanOptions;
use crate::renderer::{DeviceChoice, Observer, RenderError, RenderRequest, Renderer};
use crate::scene::Scene;

/// The options of a measurement of features.
#[derive(Debug, Clone)]
pub struct FeatureOptions {
    pub device: DeviceChoice,
    pub size: [u32; 2],
    pub spp: u32,
    /// Measured rounds, after one that is thrown away.
    pub rounds: u32,
}

/// One way of rendering a feature's room.
#[derive(Debug, Clone, Serialize)]
pub struct Variant {
    pub seconds: Spread,
    /// To one sample of every pixel, the driver's compiler included; a driver that keeps kernels answers from what it kept.
    pub first_picture_seconds: f64,
    pub rays_per_sample: f64,
    /// Time over that of the plain room, run by run.
    pub time: Ratio,
}

/// The cost of one feature.
#[derive(Debug, Clone, Serialize)]
pub struct FeatureCost {
    pub feature: String,
    pub switches: Vec<&'static str>,
    pub off: Variant,
    /// None where it adds no switch, or is never compiled without being used.
    pub compiled_in: Option<Variant>,
    pub used: Variant,
    /// The plain room came out the same with the feature compiled in as without, but for rounding.
    pub compiled_in_agrees: Option<bool>,
}

/// Measures one feature.
///
/// # Errors
/// Errors of the device, and [`BenchError::Interrupted`].
pub fn measure(
    feature: &Feature,
    options: &FeatureOptions,
    devices: &mut Devices,
    observer: &dyn Observer,
) -> Result<FeatureCost, BenchError> {
    let Some(device) = devices.get(&options.device)? else {
        let message = "only a GPU's kernels leave out what a scene does not use; there is no adapter";
        return Err(RenderError::NoDevice(message.to_owned()).into());
    };
    let sized = |room: &Room| -> Result<Scene, BenchError> {
        let mut scene = room.scene()?;
        scene.film.size = options.size;
        Ok(scene)
    };
    let (plain, with) = (sized(&Room::default())?, sized(&feature.room)?);
    let off = Candidate::new(&device, &plain, &feature.plan(&[]), observer)?;
    let used = Candidate::new(&device, &with, &feature.plan(&[]), observer)?;
    let switches = feature.switches(&off.switches, &used.switches);
    let mut candidates = vec![off];
    if !switches.is_empty() {
        candidates.push(Candidate::new(&device, &plain, &feature.plan(&switches), observer)?);
    }
    candidates.push(used);
    for round in 0..=options.rounds {
        for turn in 0..candidates.len() {
            let index = (turn + round as usize) % candidates.len();
            candidates[index].run(options.spp, round > 0)?;
        }
    }
    let compiled_in_agrees = (candidates.len() == 3).then(|| agree(&candidates[0].pixels, &candidates[1].pixels));
    let first: Vec<f64> = candidates[0].seconds.clone();
    let mut variants = candidates.into_iter().map(|candidate| candidate.finish(&first));
    let missing = || BenchError::Internal("a variant was not measured".to_owned());
    let off = variants.next().ok_or_else(missing)?;
    let used = variants.next_back().ok_or_else(missing)?;
    Ok(FeatureCost { feature: feature.name.to_owned(), switches, off, compiled_in: variants.next(), used, compiled_in_agrees })
}

/// A room made ready, and its runs.
struct Candidate<'a> {
    /// The switches of its kernels.
    switches: BTreeSet<&'static str>,
    subject: SceneSubject<'a>,
    first_picture_seconds: f64,
    seconds: Vec<f64>,
    rays_per_sample: f64,
    pixels: Vec<[f32; 3]>,
}

impl<'a> Candidate<'a> {
    fn new(device: &Device, scene: &Scene, plan: &PlanOptions, observer: &'a dyn Observer) -> Result<Self, BenchError> {
        let start = Instant::now();
        let mut renderer = GpuRenderer::on(device, scene, plan)?;
        renderer.render(&RenderRequest { rows: 0..scene.film.size[1], samples: 0..1 }, observer, &mut |_| Ok(()))?;
        Ok(Self {
            switches: renderer.plan().switches.enabled.clone(),
            first_picture_seconds: start.elapsed().as_secs_f64(),
            subject: SceneSubject { renderer: Box::new(renderer), size: scene.film.size, observer },
            seconds: Vec::new(),
            rays_per_sample: f64::NAN,
            pixels: Vec::new(),
        })
    }

    fn run(&mut self, spp: u32, counts: bool) -> Result<(), BenchError> {
        let run = self.subject.render(1, spp)?;
        self.rays_per_sample = run.rays as f64 / run.samples as f64;
        self.pixels = run.picture.pixels;
        if counts {
            self.seconds.push(run.seconds);
        }
        Ok(())
    }

    fn finish(self, off: &[f64]) -> Variant {
        Variant {
            seconds: Spread::of(&self.seconds),
            first_picture_seconds: self.first_picture_seconds,
            rays_per_sample: self.rays_per_sample,
            time: Ratio::of_pairs(self.seconds.iter().copied().zip(off.iter().copied())),
        }
    }
}

/// Other code may round otherwise, which moves a path here and there; a feature that does something it should not moves most pixels.
fn agree(one: &[[f32; 3]], other: &[[f32; 3]]) -> bool {
    let close = |(a, b): (&[f32; 3], &[f32; 3])| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-3 * a.abs().max(0.1));
    let same = one.iter().zip(other).filter(|pair| close(*pair)).count();
    same as f64 >= 0.98 * one.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The check of the pictures lets rounding pass and nothing else.
    #[test]
    fn a_picture_that_changes_is_told_from_rounding() {
        let pixels = vec![[0.5, 0.2, 0.1]; 1000];
        let mut rounded = pixels.clone();
        rounded[7] = [0.9; 3];
        rounded.iter_mut().for_each(|pixel| pixel[0] *= 1.0 + 1e-6);
        assert!(agree(&pixels, &rounded));
        let darker: Vec<[f32; 3]> = pixels.iter().map(|pixel| pixel.map(|value| 0.99 * value)).collect();
        assert!(!agree(&pixels, &darker));
    }
}
