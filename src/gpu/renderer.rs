//! Renders a scene on a device: bands, iterations, passes, submissions.

use std::cell::Cell;
use std::mem::ManuallyDrop;
use std::time::Instant;

use glam::DVec3;

use super::band::{BandProgress, BatchContext};
use super::buffers::STATISTICS_BYTES;
use super::device::{Device, OpeningDevice};
use super::film::{self, Reached, deliver_band};
use super::fitting::{self, Fitting};
use super::passes::{PassLimits, PassSizer};
use super::pipeline::Pipeline;
use super::profile::{self, Profile};
use super::trace::{self, GpuPathTrace};
use crate::binary_tree::parts::KeptTrees;
use crate::film::Band;
use crate::learn::{self, Effort};
use crate::packed::PackedScene;
use crate::packed::environment::PackedEnvironment;
use crate::packed::hierarchy::Traversal;
use crate::packed::view::View;
use crate::plan::bindings::Binding;
use crate::plan::counters::{CLAMPED_COUNTER, CLAMPED_UNITS_COUNTER, COUNTER_WORDS, RAYS_COUNTER, REFUSED_COUNTER};
use crate::plan::{Plan, PlanOptions, StageMode};
use crate::renderer::sink::Sink;
use crate::renderer::state::{BatchState, Tally};
use crate::renderer::{Batch, Change, DeviceChoice, Ending, Observer, RenderError, RenderReport, Renderer, Stopping};
use crate::sampling::Sampling;
use crate::scene::{MaterialId, Scene};

/// A scene uploaded, its kernels compiled.
pub struct GpuRenderer {
    /// Left behind where the device is lost: a driver that hangs, hangs when its memory is to be freed as well.
    pub(super) pipeline: ManuallyDrop<Pipeline>,
    pub(super) size: [u32; 2],
    sampling: Sampling,
    /// Which of the scene's materials the packed ones are.
    scene_materials: Vec<MaterialId>,
    pub(super) sizer: PassSizer,
    /// The centre and the environment that a camera which moves is packed with.
    center: DVec3,
    environment: PackedEnvironment,
    /// Paths were traced before the first sample to learn about the scene.
    depends_on_view: bool,
    /// Seconds that learning took.
    learn_seconds: f64,
    /// Options of this plan, and of the plans of further frames.
    options: PlanOptions,
    /// Trees that the next frame's hierarchy may be made of.
    trees: KeptTrees,
}

impl GpuRenderer {
    /// Packs the scene, plans, uploads and compiles.
    ///
    /// # Errors
    /// [`RenderError::NoDevice`], or [`RenderError::DoesNotFit`] where the scene is too large for the device.
    pub fn new(scene: &Scene, choice: &DeviceChoice, options: &PlanOptions) -> Result<Self, RenderError> {
        Self::from_opening_device(OpeningDevice::begin(choice, options), scene, options)
    }

    /// [`GpuRenderer::new`] on a device that is already open.
    ///
    /// # Errors
    /// [`RenderError::DoesNotFit`] where the scene is too large for the device.
    pub fn on(device: &Device, scene: &Scene, options: &PlanOptions) -> Result<Self, RenderError> {
        Self::from_opening_device(OpeningDevice::already_open(device), scene, options)
    }

    /// [`GpuRenderer::from_opening_device`] with the trees of an earlier frame.
    fn with_trees(
        opening: OpeningDevice,
        scene: &Scene,
        options: &PlanOptions,
        mut trees: KeptTrees,
    ) -> Result<Self, RenderError> {
        let start = Instant::now();
        // How much is learned depends on the device.
        let waits = options.waits_for_device() || learn::may_learn(scene);
        let opening = if waits { OpeningDevice::already_open(&opening.wait()?) } else { opening };
        let fitting = Fitting::new(scene, opening.limits(), options, &mut trees);
        // Without a device, that is the error, whatever the scene: it may then go to the CPU.
        let device = opening.wait()?;
        let mut fitting = fitting?;
        let pipeline = loop {
            let Fitting { settled, packed, options, .. } = &fitting;
            match Self::pipeline(device.clone(), &settled.scene, packed, options, start) {
                Err(RenderError::DoesNotFit(_)) if fitting.gives_something_up(&mut trees)? => {}
                pipeline => break pipeline?,
            }
        };
        let Fitting { settled, packed, .. } = fitting;
        let scene = &*settled.scene;
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
        Ok(Self {
            pipeline: ManuallyDrop::new(pipeline),
            size: scene.film.size,
            sampling,
            scene_materials: packed.materials.scene_ids,
            sizer,
            center: scene.center(),
            environment: packed.environment,
            depends_on_view: settled.depends_on_view,
            learn_seconds: settled.seconds,
            options: options.clone(),
            trees,
        })
    }

    /// [`GpuRenderer::new`] on a device that opens while the scene is packed.
    ///
    /// # Errors
    /// [`RenderError`] as of [`GpuRenderer::new`].
    pub fn from_opening_device(opening: OpeningDevice, scene: &Scene, options: &PlanOptions) -> Result<Self, RenderError> {
        Self::with_trees(opening, scene, options, KeptTrees::default())
    }

    /// Plans, uploads and compiles; for a film in bands and fewer paths where the device has no memory for all of it.
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
        match (on(device), with_less.limits.with_less_memory(scene.film.size)) {
            (Err(RenderError::DoesNotFit(_)), Some(limits)) if with_less.forget_refusal() => {
                with_less.limits = limits;
                on(with_less)
            }
            (outcome, _) => outcome,
        }
    }

    /// The plan for this scene on this device.
    pub fn plan(&self) -> &Plan {
        &self.pipeline.plan
    }

    /// The length of its renders, by which it learned about the scene.
    pub fn effort(&self) -> Effort {
        fitting::effort(Some(&self.pipeline.device.limits), &self.options)
    }

    /// The time that each stage of a pass takes; None where the device has no time stamps. The film
    /// afterwards holds nothing of use.
    ///
    /// # Errors
    /// [`RenderError`] that the device reports.
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
            return if batch.selects() { Err(missing()) } else { Ok(count) };
        }
        let first_of_band = first_row * self.size[0];
        let takes_part = |pixel: &u32| batch.takes_part((first_of_band + pixel) as usize, self.size[0]);
        let list: Vec<u32> = (0..count).filter(takes_part).collect();
        self.write_list(&list);
        Ok(list.len() as u32)
    }

    /// Hands over what of a band has samples.
    pub(super) fn deliver_band(
        &self,
        reached: &Reached,
        batch: &Batch<'_>,
        on_band: &mut dyn FnMut(Band) -> std::io::Result<()>,
    ) -> Result<(), RenderError> {
        let Pipeline { device, buffers, .. } = &*self.pipeline;
        let width = self.size[0];
        let read = |rows| film::read_rows(device, &buffers.film, width, rows);
        deliver_band(width, reached, batch, &read, on_band).map_err(|error| match error {
            RenderError::NoDevice(message) => RenderError::NoDevice(format!("{}: {message}", device.name)),
            error => error,
        })
    }

    /// Counts since the batch began, with `samples` in this band.
    pub(super) fn tally(&self, samples: u64, context: &BatchContext<'_>) -> Result<Tally, RenderError> {
        let words = self.pipeline.read_words::<{ COUNTER_WORDS as usize }>(Binding::Statistics)?;
        let counted = |counter: u32| u64::from(words[counter as usize + 1]) << 32 | u64::from(words[counter as usize]);
        let samples = context.finished.get() + samples;
        // `prepare` counts the wavefront's rays to later vertices; those to the first are the paths themselves.
        let camera_rays = if self.pipeline.plan.stages == StageMode::Wavefront { samples - context.before.samples } else { 0 };
        Ok(Tally {
            rays: context.before.rays + counted(RAYS_COUNTER) + camera_rays,
            samples,
            non_finite_samples: context.before.non_finite_samples + counted(REFUSED_COUNTER),
            clamped_samples: context.before.clamped_samples + counted(CLAMPED_COUNTER),
            clamped_units: context.before.clamped_units + counted(CLAMPED_UNITS_COUNTER),
        })
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

    fn with_scene(mut self: Box<Self>, scene: &Scene, change: Change) -> Result<Box<dyn Renderer>, RenderError> {
        // Learning may depend on what the camera sees.
        if change == Change::Camera && !self.depends_on_view && scene.center() == self.center {
            let start = Instant::now();
            let view = View::new(&scene.centered(), &self.environment);
            self.pipeline.write(Binding::View, bytemuck::bytes_of(&view));
            self.pipeline.compile_seconds = 0.0;
            self.learn_seconds = 0.0;
            self.pipeline.build_seconds = start.elapsed().as_secs_f64();
            return Ok(self);
        }
        let device = self.pipeline.device.clone();
        let (options, trees) = (std::mem::take(&mut self.options), std::mem::take(&mut self.trees));
        // Its memory is free before the next scene's is taken.
        drop(self);
        Ok(Box::new(Self::with_trees(OpeningDevice::already_open(&device), scene, &options, trees)?))
    }

    fn holds_whole_film(&self) -> bool {
        self.pipeline.plan.band_rows >= self.size[1]
    }

    fn set_samples_per_pixel(&mut self, spp: u32) {
        self.sampling.samples = spp.max(1);
    }

    fn render_into(
        &mut self,
        batch: &Batch<'_>,
        observer: &dyn Observer,
        sink: &mut dyn Sink,
    ) -> Result<RenderReport, RenderError> {
        let start = Instant::now();
        self.pipeline.write(Binding::Statistics, &[0; STATISTICS_BYTES as usize]);
        let request = batch.request;
        let width = self.size[0];
        let total = batch.total_samples(width);
        let before = batch.resume.map(|state| state.tally).unwrap_or_default();
        let finished = Cell::new(before.samples);
        let context = BatchContext {
            batch,
            samples: request.samples.clone(),
            sampling: Sampling { seed: batch.seed.unwrap_or(self.sampling.seed), ..self.sampling },
            stopping: Stopping::new(observer, batch.deadline),
            progress: &|done| observer.progress(finished.get() + done, total),
            before,
            finished: &finished,
        };
        let mut ended = None;
        let begin = batch.resume.map_or(request.rows.start, |state| state.rows.start);
        let mut first_row = begin;
        let is_cut = request.rows.len() as u32 > self.pipeline.plan.band_rows;
        while first_row < request.rows.end && ended.is_none() {
            let mut rows = self.pipeline.plan.band_rows.min(request.rows.end - first_row);
            let resume = batch.resume.filter(|state| state.rows.start == first_row && !state.film.is_empty());
            if let Some(state) = resume {
                rows = rows.min(state.rows.len() as u32);
            }
            let mut begun = BatchState::before(first_row..first_row + rows, before);
            if first_row > begin {
                (begun.tally, ended) = self.between_bands(&begun, &context, sink)?;
                if ended.is_some() {
                    break;
                }
            }
            let pixels = self.listed_pixels([first_row, rows], batch)?;
            let mut band = BandProgress::new([first_row, rows], pixels);
            ended = self.render_and_deliver(&mut band, &context, resume.unwrap_or(&begun), is_cut, sink)?;
            finished.set(finished.get() + band.samples_done);
            first_row += rows;
        }
        let tally = self.tally(0, &context)?;
        Ok(RenderReport {
            device: self.pipeline.device.name.clone(),
            hierarchy: self.pipeline.plan.traversal_in_use().map(Traversal::key),
            decisions: self.pipeline.plan.decisions.clone(),
            compiled_in: self.pipeline.plan.switches.enabled.iter().copied().collect(),
            rays: tally.rays,
            samples: tally.samples,
            non_finite_samples: tally.non_finite_samples,
            clamped_samples: tally.clamped_samples,
            clamped_units: tally.clamped_units,
            peak_device_bytes: self.pipeline.buffers.bytes,
            learn_seconds: self.learn_seconds,
            build_seconds: self.pipeline.build_seconds - self.learn_seconds,
            compile_seconds: self.pipeline.compile_seconds,
            render_seconds: start.elapsed().as_secs_f64(),
            interrupted: ended == Some(Ending::Interrupted),
            out_of_time: ended == Some(Ending::OutOfTime),
        })
    }
}
