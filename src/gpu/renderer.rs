//! Renders a scene on a device: bands, sweeps, passes, submissions.

use std::cell::Cell;
use std::mem::ManuallyDrop;
use std::ops::Range;
use std::time::Instant;

use super::buffers::STATISTICS_BYTES;
use super::device::{Device, OpeningDevice};
use super::film::{Reached, deliver_band};
use super::passes::{Pass, PassLimits, PassSizer};
use super::pipeline::Pipeline;
use super::profile::{self, Profile};
use super::snapshot::Snapshot;
use super::trace::{self, GpuPathTrace};
use crate::film::Band;
use crate::packed::{PackError, PackedScene};
use crate::plan::bindings::Binding;
use crate::plan::{Plan, PlanOptions, StageMode};
use crate::renderer::{Batch, DeviceChoice, Ending, Observer, RenderError, RenderReport, Renderer, Stopping};
use crate::sampling::Sampling;
use crate::scene::{MaterialId, Scene};

/// A scene uploaded, its kernels compiled.
pub struct GpuRenderer {
    /// Left behind where the device is lost: a driver that hangs, hangs when its memory is to be freed as well.
    pipeline: ManuallyDrop<Pipeline>,
    size: [u32; 2],
    sampling: Sampling,
    /// Which of the scene's materials the packed ones are.
    scene_materials: Vec<MaterialId>,
    sizer: PassSizer,
}

/// A band being rendered.
struct BandState {
    first_row: u32,
    rows: u32,
    /// Pixels that take part, and how many of them have samples, from the first.
    pixels: u32,
    reached: u32,
    /// Pixels may differ in their numbers of samples: the band ended in the middle of a sweep.
    is_uneven: bool,
    /// Finished samples, over all pixels of the band.
    samples_done: u64,
}

/// What all bands of a batch have in common.
struct Sweeps<'a> {
    samples: Range<u32>,
    sampling: Sampling,
    stopping: Stopping<'a>,
    /// Is told how many samples of the band are done.
    progress: &'a dyn Fn(u64),
}

/// Sweeps are planned to take so much of the time that is left.
const CAUTION: f64 = 0.95;

impl GpuRenderer {
    /// Packs the scene, plans, uploads and compiles.
    ///
    /// # Errors
    /// [`RenderError::NoDevice`], or [`RenderError::DoesNotFit`] where the scene is too large for the device.
    pub fn new(scene: &Scene, choice: &DeviceChoice, options: &PlanOptions) -> Result<Self, RenderError> {
        Self::once_open(OpeningDevice::begin(choice, options), scene, options)
    }

    /// As [`GpuRenderer::new`], on a device that is already open.
    ///
    /// # Errors
    /// [`RenderError::DoesNotFit`] where the scene is too large for the device.
    pub fn on(device: &Device, scene: &Scene, options: &PlanOptions) -> Result<Self, RenderError> {
        Self::once_open(OpeningDevice::is_open(device), scene, options)
    }

    /// As [`GpuRenderer::new`], on a device that opens while the scene is packed.
    ///
    /// # Errors
    /// As [`GpuRenderer::new`].
    pub fn once_open(opening: OpeningDevice, scene: &Scene, options: &PlanOptions) -> Result<Self, RenderError> {
        let start = Instant::now();
        let does_not_fit = |error: PackError| RenderError::DoesNotFit(error.to_string());
        let pack = |()| PackedScene::for_traversal(scene, options.packed_traversal()).map_err(does_not_fit);
        let packed = scene.validate().map_err(RenderError::from).and_then(pack);
        // Where there is no device, that is what is told, whatever the scene: it may then go to the CPU.
        let device = opening.wait()?;
        let packed = packed?;
        let pipeline = Self::pipeline(device, scene, &packed, options, start)?;
        let plan = &pipeline.plan;
        let sizer = PassSizer::new(PassLimits {
            stages: plan.stages,
            paths: plan.path_capacity,
            pixels: plan.pixels_per_dispatch,
            lanes: plan.lanes,
        });
        // The table of the sequence is laid out for the light samples that the kernels take.
        let sampling = Sampling {
            light_samples: plan.light_samples,
            light_samples_depth: plan.light_samples_depth,
            ..Sampling::from(&scene.render)
        };
        let pipeline = ManuallyDrop::new(pipeline);
        Ok(Self { pipeline, size: scene.film.size, sampling, scene_materials: packed.materials.scene_ids, sizer })
    }

    /// Plans, uploads and compiles; for a film in bands where the device has no memory for all of it.
    fn pipeline(
        device: Device,
        scene: &Scene,
        packed: &PackedScene,
        options: &PlanOptions,
        start: Instant,
    ) -> Result<Pipeline, RenderError> {
        let on = |device: Device| {
            let plan = Plan::new(scene, packed, &device.limits, options)?;
            Pipeline::new(device, plan, scene, packed, start)
        };
        let mut with_less = device.clone();
        match (on(device), with_less.limits.with_small_film(scene.film.size)) {
            (Err(RenderError::DoesNotFit(_)), Some(limits)) if with_less.forget_refusal() => {
                with_less.limits = limits;
                on(with_less)
            }
            (outcome, _) => outcome,
        }
    }

    /// What was decided for this scene on this device.
    pub fn plan(&self) -> &Plan {
        &self.pipeline.plan
    }

    /// Where the time of a pass goes; None where the device has no time stamps. The film afterwards holds nothing of use.
    ///
    /// # Errors
    /// What the device reports.
    pub fn profile(&self) -> Result<Option<Profile>, RenderError> {
        profile::profile(&self.pipeline, &self.sampling)
    }

    /// Follows one path, sample `sample` of the pixel at column `x` and row `y`.
    ///
    /// # Errors
    /// [`RenderError::Internal`] where the renderer was not made with [`PlanOptions::trace`]; else what the device reports.
    pub fn trace(&self, x: u32, y: u32, sample: u32) -> Result<GpuPathTrace, RenderError> {
        trace::trace(&self.pipeline, &self.sampling, [x, y, sample], &self.scene_materials)
    }

    /// Uploads the order in which passes take the band's pixels.
    fn write_list(&self, pixels: &[u32]) {
        if let Some(buffer) = self.pipeline.buffers.buffer(Binding::Statistics) {
            self.pipeline.device.queue.write_buffer(buffer, STATISTICS_BYTES, bytemuck::cast_slice(pixels));
        }
    }

    /// How many pixels of a band take part, and the upload of their list, in the order of the film, where the kernels look them up.
    fn listed_pixels(&self, [first_row, rows]: [u32; 2], batch: &Batch<'_>) -> Result<u32, RenderError> {
        let count = self.size[0] * rows;
        if !self.pipeline.takes_pixel_list() {
            let missing = || RenderError::Internal("the kernels were not compiled for lists of pixels".into());
            return if batch.selection.is_none() { Ok(count) } else { Err(missing()) };
        }
        let first_of_band = first_row * self.size[0];
        let takes_part = |pixel: &u32| batch.selection.is_none_or(|selection| selection[(first_of_band + pixel) as usize]);
        let list: Vec<u32> = (0..count).filter(takes_part).collect();
        self.write_list(&list);
        Ok(list.len() as u32)
    }

    fn run_pass(&self, band: &BandState, pass: &Pass, sweeps: &Sweeps<'_>) -> Result<Option<Ending>, RenderError> {
        self.pipeline.write_pass(band.first_row, pass, &sweeps.sampling);
        self.pipeline.run_pass(pass, &sweeps.stopping)
    }

    /// Times short passes, so that the first sweep has none that take long.
    fn probe(&mut self, band: &BandState, sweeps: &Sweeps<'_>) -> Result<Option<Ending>, RenderError> {
        let probes = self.sizer.probes(band.pixels, sweeps.samples.start, sweeps.samples.len() as u32);
        for (index, pass) in probes.iter().enumerate() {
            let start = Instant::now();
            let ended = self.run_pass(band, pass, sweeps)?;
            if ended.is_some() {
                return Ok(ended);
            }
            // The driver compiles when it first runs a kernel.
            if index > 0 {
                self.sizer.learn(band.pixels, pass, start.elapsed());
            }
        }
        if !probes.is_empty() {
            // What they counted, the sweeps count again.
            self.pipeline.write(Binding::Statistics, &[0; 16]);
        }
        Ok(None)
    }

    /// Samples per pixel of the next sweep; None: there is no time for one.
    fn next_sweep(&self, band: &BandState, done: u32, sweeps: &Sweeps<'_>) -> Option<u32> {
        let left = sweeps.samples.len() as u32 - done;
        let wanted = self.sizer.sweep_samples(band.pixels, done, left);
        match sweeps.stopping.time_left() {
            None => Some(wanted),
            // A picture has a sample in every pixel, however little time there is.
            Some(_) if done == 0 => Some(1),
            Some(time) => {
                Some(self.sizer.samples_within(band.pixels, time.mul_f64(CAUTION)).min(wanted)).filter(|samples| *samples > 0)
            }
        }
    }

    fn deliver_band(
        &self,
        reached: &Reached,
        batch: &Batch<'_>,
        on_band: &mut dyn FnMut(Band) -> std::io::Result<()>,
    ) -> Result<(), RenderError> {
        let Pipeline { device, buffers, .. } = &*self.pipeline;
        deliver_band(device, &buffers.film, self.size[0], reached, batch, on_band)
    }

    /// Renders the samples of the band's pixels that take part; why it ended early, if it did.
    fn render_band(
        &mut self,
        band: &mut BandState,
        sweeps: &Sweeps<'_>,
        snapshot: &mut Snapshot<'_>,
    ) -> Result<Option<Ending>, RenderError> {
        let samples = if band.pixels > 0 { sweeps.samples.len() as u32 } else { 0 };
        let ended = if samples > 0 { self.probe(band, sweeps)? } else { None };
        if ended.is_some() {
            return Ok(ended);
        }
        let mut done = 0;
        while done < samples {
            let Some(sweep) = self.next_sweep(band, done, sweeps) else { return Ok(Some(Ending::OutOfTime)) };
            let mut first_pixel = 0;
            while first_pixel < band.pixels {
                let pass = Pass {
                    first_pixel,
                    pixel_count: self.sizer.pass_pixels(sweep, band.pixels, first_pixel),
                    first_sample: sweeps.samples.start + done,
                    sample_count: sweep,
                    film_is_empty: done == 0,
                };
                let start = Instant::now();
                let ended = self.run_pass(band, &pass, sweeps)?;
                if ended.is_some() {
                    return Ok(ended);
                }
                self.sizer.learn(band.pixels, &pass, start.elapsed());
                first_pixel += pass.pixel_count;
                band.reached = band.reached.max(first_pixel);
                band.samples_done += pass.paths();
                band.is_uneven = first_pixel < band.pixels;
                (sweeps.progress)(band.samples_done);
                let is_last = first_pixel == band.pixels && done + sweep == samples;
                if !is_last && let Some(ending) = sweeps.stopping.after_pass(band.reached == band.pixels) {
                    return Ok(Some(ending));
                }
                if !is_last && band.reached == band.pixels && snapshot.is_due() {
                    let reached = Reached { first_row: band.first_row, rows: band.rows, pixels: band.reached, with_counts: true };
                    snapshot.take(|batch, on_band| self.deliver_band(&reached, batch, on_band))?;
                }
            }
            done += sweep;
        }
        Ok(None)
    }
}

impl Drop for GpuRenderer {
    fn drop(&mut self) {
        if !self.pipeline.device.is_lost() {
            // SAFETY: nothing uses it after this.
            unsafe { ManuallyDrop::drop(&mut self.pipeline) };
        }
    }
}

impl Renderer for GpuRenderer {
    fn device(&self) -> &str {
        &self.pipeline.device.name
    }

    fn holds_whole_film(&self) -> bool {
        self.pipeline.plan.band_rows >= self.size[1]
    }

    fn set_samples_per_pixel(&mut self, spp: u32) {
        self.sampling.samples = spp.max(1);
    }

    fn render_batch(
        &mut self,
        batch: &Batch<'_>,
        observer: &dyn Observer,
        on_band: &mut dyn FnMut(Band) -> std::io::Result<()>,
    ) -> Result<RenderReport, RenderError> {
        let start = Instant::now();
        self.pipeline.write(Binding::Statistics, &[0; 16]);
        let request = batch.request;
        let total = batch.total_samples(self.size[0]);
        let finished = Cell::new(0);
        let sweeps = Sweeps {
            samples: request.samples.clone(),
            sampling: Sampling { seed: batch.seed.unwrap_or(self.sampling.seed), ..self.sampling },
            stopping: Stopping::new(observer, batch.deadline),
            progress: &|done| observer.progress(finished.get() + done, total),
        };
        let mut ended = None;
        let mut first_row = request.rows.start;
        let mut camera_rays = 0;
        let is_cut = request.rows.len() as u32 > self.pipeline.plan.band_rows;
        while first_row < request.rows.end && ended.is_none() {
            let rows = self.pipeline.plan.band_rows.min(request.rows.end - first_row);
            let pixels = self.listed_pixels([first_row, rows], batch)?;
            let mut band = BandState { first_row, rows, pixels, reached: 0, is_uneven: false, samples_done: 0 };
            let mut snapshot = Snapshot::new(batch);
            ended = match self.render_band(&mut band, &sweeps, &mut snapshot) {
                Err(error @ RenderError::DeviceLost(_)) => {
                    snapshot.deliver(0, on_band)?;
                    return Err(error);
                }
                ended => ended?,
            };
            finished.set(finished.get() + band.samples_done);
            if self.pipeline.plan.stages == StageMode::Wavefront {
                // `prepare` counts the rays to later vertices; those to the first are the paths themselves.
                camera_rays += band.samples_done;
            }
            let reached = Reached { first_row, rows, pixels: band.reached, with_counts: is_cut || band.is_uneven };
            if band.reached > 0 || pixels == 0 {
                let mut next_row = first_row;
                let delivered = self.deliver_band(&reached, batch, &mut |band| {
                    next_row = band.first_row + band.rows;
                    on_band(band)
                });
                if let Err(error) = delivered {
                    if matches!(error, RenderError::DeviceLost(_)) {
                        snapshot.deliver(next_row, on_band)?;
                    }
                    return Err(error);
                }
            }
            first_row += rows;
        }
        let finished = finished.get();
        let [low, high, non_finite_samples, _] = self.pipeline.read_words(Binding::Statistics)?;
        Ok(RenderReport {
            device: self.pipeline.device.name.clone(),
            traversal: self.pipeline.plan.traversal_in_use(),
            decisions: self.pipeline.plan.decisions.clone(),
            compiled_in: self.pipeline.plan.switches.enabled.iter().copied().collect(),
            rays: (u64::from(high) << 32 | u64::from(low)) + camera_rays,
            samples: finished,
            non_finite_samples: u64::from(non_finite_samples),
            peak_device_bytes: self.pipeline.buffers.bytes,
            build_seconds: self.pipeline.build_seconds,
            compile_seconds: self.pipeline.compile_seconds,
            render_seconds: start.elapsed().as_secs_f64(),
            interrupted: ended == Some(Ending::Interrupted),
            out_of_time: ended == Some(Ending::OutOfTime),
        })
    }
}
