//! Renders a scene on a device: bands, sweeps, passes, submissions.

use std::ops::Range;
use std::time::Instant;

use super::buffers::STATISTICS_BYTES;
use super::device::{Device, OpeningDevice};
use super::film::read_band;
use super::passes::{Pass, PassSizer};
use super::pipeline::Pipeline;
use super::profile::{self, Profile};
use super::trace::{self, GpuPathTrace};
use crate::film::Band;
use crate::packed::{PackError, PackedScene};
use crate::plan::bindings::Binding;
use crate::plan::{Plan, PlanOptions, StageMode};
use crate::renderer::{Batch, DeviceChoice, Observer, RenderError, RenderReport, Renderer};
use crate::sampling::Sampling;
use crate::scene::{MaterialId, Scene};

/// A scene uploaded, its kernels compiled.
pub struct GpuRenderer {
    pipeline: Pipeline,
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
    /// Finished samples, over all pixels of the band.
    samples_done: u64,
}

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
        let plan = Plan::new(scene, &packed, &device.limits, options)?;
        let pipeline = Pipeline::new(device, plan, scene, &packed, start)?;
        let plan = &pipeline.plan;
        let sizer = PassSizer::new(plan.stages, plan.path_capacity, plan.lanes);
        // The table of the sequence is laid out for the light samples that the kernels take.
        let sampling = Sampling {
            light_samples: plan.light_samples,
            light_samples_depth: plan.light_samples_depth,
            ..Sampling::from(&scene.render)
        };
        Ok(Self { pipeline, size: scene.film.size, sampling, scene_materials: packed.materials.scene_ids, sizer })
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
    fn listed_pixels(&self, band: &BandState, batch: &Batch<'_>) -> Result<u32, RenderError> {
        let count = self.size[0] * band.rows;
        if !self.pipeline.takes_pixel_list() {
            let missing = || RenderError::Internal("the kernels were not compiled for lists of pixels".into());
            return if batch.selection.is_none() { Ok(count) } else { Err(missing()) };
        }
        let first_of_band = band.first_row * self.size[0];
        let takes_part = |pixel: &u32| batch.selection.is_none_or(|selection| selection[(first_of_band + pixel) as usize]);
        let list: Vec<u32> = (0..count).filter(takes_part).collect();
        self.write_list(&list);
        Ok(list.len() as u32)
    }

    /// Renders these samples, by their absolute indices, of the band's first `pixels` pixels, or of as many that its list has; true where
    /// the observer stopped it.
    fn render_pixels(
        &mut self,
        band: &mut BandState,
        pixels: u32,
        indices: Range<u32>,
        sampling: &Sampling,
        progress: &dyn Fn(u64) -> bool,
    ) -> Result<bool, RenderError> {
        let samples = if pixels > 0 { indices.len() as u32 } else { 0 };
        let mut done = 0;
        while done < samples {
            let sweep = self.sizer.sweep_samples(pixels, done, samples - done);
            let mut first_pixel = 0;
            while first_pixel < pixels {
                let pass = Pass {
                    first_pixel,
                    pixel_count: self.sizer.pass_pixels(sweep, pixels - first_pixel),
                    first_sample: indices.start + done,
                    sample_count: sweep,
                    film_is_empty: done == 0,
                };
                let start = Instant::now();
                self.pipeline.write_pass(band.first_row, &pass, sampling);
                self.pipeline.run_pass(&pass)?;
                self.sizer.learn(&pass, start.elapsed());
                first_pixel += pass.pixel_count;
                band.samples_done += pass.paths();
                // A first sweep is finished, so that no pixel is left without a sample.
                if progress(band.samples_done) && (done > 0 || first_pixel == pixels) {
                    return Ok(true);
                }
            }
            done += sweep;
        }
        Ok(false)
    }
}

impl Renderer for GpuRenderer {
    fn device(&self) -> &str {
        &self.pipeline.device.name
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
        let sampling = Sampling { seed: batch.seed.unwrap_or(self.sampling.seed), ..self.sampling };
        let total = batch.total_samples(self.size[0]);
        let mut finished = 0;
        let mut interrupted = false;
        let mut first_row = request.rows.start;
        let mut camera_rays = 0;
        while first_row < request.rows.end && !interrupted {
            let rows = self.pipeline.plan.band_rows.min(request.rows.end - first_row);
            let mut band = BandState { first_row, rows, samples_done: 0 };
            let progress = |done: u64| {
                observer.progress(finished + done, total);
                observer.stop_requested()
            };
            let pixels = self.listed_pixels(&band, batch)?;
            interrupted = self.render_pixels(&mut band, pixels, request.samples.clone(), &sampling, &progress)?;
            finished += band.samples_done;
            if self.pipeline.plan.stages == StageMode::Wavefront {
                // `prepare` counts the rays to later vertices; those to the first are the paths themselves.
                camera_rays += band.samples_done;
            }
            let Pipeline { device, buffers, .. } = &self.pipeline;
            on_band(read_band(device, &buffers.film, first_row, [self.size[0], rows], batch)?)?;
            first_row += rows;
        }
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
            interrupted: interrupted && finished < total,
        })
    }
}
