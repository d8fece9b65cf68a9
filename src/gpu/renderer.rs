//! Renders a scene on a device: bands, sweeps, passes, submissions.

use std::ops::Range;
use std::time::Instant;

use super::buffers::{Buffers, STATISTICS_BYTES, VERTICES_PER_SUBMISSION, vertex_parameters};
use super::device::{Device, OpeningDevice};
use super::kernels::{self, Kernel};
use super::passes::{Pass, PassSizer};
use crate::film::Band;
use crate::packed::{PackError, PackedScene};
use crate::plan::bindings::Binding;
use crate::plan::parameters::PassParameters;
use crate::plan::path_state::{CONNECT_SIZE, COUNTS, WORKGROUP};
use crate::plan::stages::{Over, When};
use crate::plan::{Plan, PlanOptions, StageMode};
use crate::renderer::{Batch, DeviceChoice, Observer, RenderError, RenderReport, Renderer};
use crate::sampling::{Sampling, SequencePoint};
use crate::scene::{MaterialId, Scene};

/// A scene uploaded, its kernels compiled.
pub struct GpuRenderer {
    pub(super) device: Device,
    pub(super) plan: Plan,
    pub(super) buffers: Buffers,
    kernels: Vec<Kernel>,
    pub(super) size: [u32; 2],
    pub(super) sampling: Sampling,
    /// Which of the scene's materials the packed ones are.
    pub(super) scene_materials: Vec<MaterialId>,
    sizer: PassSizer,
    /// Vertices of a path at most; None: no limit.
    pub(super) max_vertices: Option<u32>,
    /// Vertices encoded before the host looks again.
    pub(super) vertices_per_submission: u32,
    build_seconds: f64,
    compile_seconds: f64,
}

/// A kernel and how many workgroups of it run.
pub(super) struct Step<'a> {
    pub(super) kernel: &'a Kernel,
    pub(super) workgroups: Workgroups<'a>,
}

#[derive(Clone, Copy)]
pub(super) enum Workgroups<'a> {
    Direct(u32),
    /// Read by the device, at this offset in bytes.
    Indirect(&'a wgpu::Buffer, u64),
}

impl Step<'_> {
    /// Adds it to a pass, for the submission's vertex number `vertex_index` (from 0).
    pub(super) fn encode(&self, compute: &mut wgpu::ComputePass<'_>, vertex_index: u32) {
        self.kernel.set(compute, vertex_index);
        match self.workgroups {
            Workgroups::Direct(count) => compute.dispatch_workgroups(count, 1, 1),
            Workgroups::Indirect(sizes, offset) => compute.dispatch_workgroups_indirect(sizes, offset),
        }
    }
}

/// A band being rendered.
pub(super) struct BandState {
    pub(super) first_row: u32,
    pub(super) rows: u32,
    /// Finished samples, over all pixels of the band.
    pub(super) samples_done: u64,
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
        // Where there are null surfaces, whose vertices end no edge, a path's depth does not bound the number of its vertices; most paths
        // still end by then.
        let null_surfaces = plan.switches.enabled.contains("NULL_SURFACES");
        let depth = Some(scene.render.max_depth).filter(|depth| *depth > 0);
        let vertices_per_submission = depth.unwrap_or(VERTICES_PER_SUBMISSION).min(VERTICES_PER_SUBMISSION);
        let max_vertices = depth.filter(|_| !null_surfaces);
        // The compiler needs the plan and not the scene, which is uploaded meanwhile.
        let (compiled, (buffers, build_seconds)) = rayon::join(
            || {
                let start = Instant::now();
                (kernels::compile(&device, &plan), start.elapsed().as_secs_f64())
            },
            || (Buffers::new(&device, &packed, &plan, scene.film.size[0]), start.elapsed().as_secs_f64()),
        );
        device.check()?;
        let (stages, compile_seconds) = compiled;
        let kernels = kernels::bind(&device, stages?, &buffers)?;
        let sizer = PassSizer::new(plan.stages, plan.path_capacity, plan.lanes);
        // The table of the sequence is laid out for the light samples that the kernels take.
        let sampling = Sampling {
            light_samples: plan.light_samples,
            light_samples_depth: plan.light_samples_depth,
            ..Sampling::from(&scene.render)
        };
        Ok(Self {
            device,
            plan,
            buffers,
            kernels,
            size: scene.film.size,
            sampling,
            scene_materials: packed.materials.scene_ids,
            sizer,
            max_vertices,
            vertices_per_submission,
            build_seconds,
            compile_seconds,
        })
    }

    /// What was decided for this scene on this device.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    pub(super) fn write(&self, binding: Binding, bytes: &[u8]) {
        if let Some(buffer) = self.buffers.buffer(binding) {
            self.device.queue.write_buffer(buffer, 0, bytes);
        }
    }

    /// Uploads the order in which passes take the band's pixels.
    fn write_list(&self, pixels: &[u32]) {
        if let Some(buffer) = self.buffers.buffer(Binding::Statistics) {
            self.device.queue.write_buffer(buffer, STATISTICS_BYTES, bytemuck::cast_slice(pixels));
        }
    }

    /// Workgroups of a fused kernel: as many in every run.
    fn fused_workgroups(&self, pass: &Pass) -> u32 {
        self.run_length(pass) * self.plan.runs
    }

    fn run_length(&self, pass: &Pass) -> u32 {
        pass.pixel_count.div_ceil(WORKGROUP).div_ceil(self.plan.runs)
    }

    /// Uploads what a pass needs: its parameters, and its samples' points of the sampler's sequence.
    pub(super) fn write_pass(&self, band: &BandState, pass: &Pass, sampling: &Sampling) {
        let first_of_band = band.first_row * self.size[0];
        let parameters = PassParameters {
            // A list of pixels counts them within the band.
            first_pixel: if self.takes_pixel_list() { first_of_band } else { first_of_band + pass.first_pixel },
            first_pixel_in_band: pass.first_pixel,
            pixel_count: pass.pixel_count,
            first_sample: pass.first_sample,
            sample_count: pass.sample_count,
            film_is_empty: u32::from(pass.film_is_empty),
            opaque_zero: 0,
            seed: sampling.seed,
            run_length: self.run_length(pass),
            ..Default::default()
        };
        self.write(Binding::Pass, bytemuck::bytes_of(&parameters));
        if sampling.uses_sequence() {
            let samples = pass.first_sample..pass.first_sample + pass.sample_count;
            let mut words = Vec::new();
            for point in samples.map(|sample| SequencePoint::new(sampling, sample)) {
                words.extend(point.bits);
                words.extend(point.more_lights.as_flattened());
            }
            self.write(Binding::Sequence, bytemuck::cast_slice(&words));
        }
    }

    /// Traces the paths of one pass and adds them to the film.
    pub(super) fn run_pass(&self, pass: &Pass) -> Result<(), RenderError> {
        match self.plan.stages {
            StageMode::Fused => self.submit(|compute| self.encode(compute, When::PassStart, 0, true, pass)),
            StageMode::Wavefront => self.run_wavefront(pass),
        }
    }

    /// Vertices are encoded ahead, so that none waits for the host; only paths longer than a submission holds do.
    fn run_wavefront(&self, pass: &Pass) -> Result<(), RenderError> {
        let mut counts = [0_u32; COUNTS as usize];
        counts[0] = pass.paths() as u32;
        self.write(Binding::Counts, bytemuck::cast_slice(&counts));
        let mut first_vertex = 1;
        loop {
            let vertices = self.max_vertices.map_or(u32::MAX, |most| most - first_vertex + 1).min(self.vertices_per_submission);
            let last = self.max_vertices.is_some_and(|most| first_vertex + vertices > most);
            self.write(Binding::Vertex, &vertex_parameters(first_vertex));
            self.submit(|compute| {
                if first_vertex == 1 {
                    self.encode(compute, When::PassStart, 0, true, pass);
                }
                for index in 0..vertices {
                    self.encode(compute, When::EachVertex, index, first_vertex == 1 && index == 0, pass);
                }
                if last {
                    self.encode(compute, When::PassEnd, 0, false, pass);
                }
            })?;
            first_vertex += vertices;
            if last {
                return Ok(());
            }
            if self.living_paths(first_vertex)? == 0 {
                return self.submit(|compute| self.encode(compute, When::PassEnd, 0, false, pass));
            }
        }
    }

    /// Submits what `encode` adds to a compute pass, and waits.
    fn submit(&self, encode: impl FnOnce(&mut wgpu::ComputePass<'_>)) -> Result<(), RenderError> {
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        let mut compute = encoder.begin_compute_pass(&Default::default());
        encode(&mut compute);
        drop(compute);
        self.device.submit_and_wait(encoder.finish())
    }

    /// Adds the stages of this time to a compute pass, for the submission's vertex number `vertex_index` (from 0).
    fn encode(&self, compute: &mut wgpu::ComputePass<'_>, when: When, vertex_index: u32, first_vertex: bool, pass: &Pass) {
        for step in self.steps(when, first_vertex, pass) {
            step.encode(compute, vertex_index);
        }
    }

    /// The stages of this time, in order, with the workgroups of each. `first_vertex`: queues hold all paths of the pass.
    pub(super) fn steps(&self, when: When, first_vertex: bool, pass: &Pass) -> impl Iterator<Item = Step<'_>> {
        let (paths, pixels, in_runs) = (pass.paths() as u32, pass.pixel_count, self.fused_workgroups(pass));
        self.kernels.iter().filter(move |kernel| kernel.stage.when == when).map(move |kernel| {
            let direct = |invocations: u32| Workgroups::Direct(invocations.div_ceil(WORKGROUP));
            let workgroups = match kernel.stage.over {
                Over::Paths => direct(paths),
                Over::Pixels => direct(pixels),
                Over::PixelsInRuns => Workgroups::Direct(in_runs),
                Over::Once => Workgroups::Direct(1),
                Over::Queue { size, rays } => match self.buffers.buffer(Binding::DispatchSizes) {
                    // Shadow rays come after `prepare`, which knows how many there are, at the first vertex as well.
                    Some(sizes) if !first_vertex || size == CONNECT_SIZE => Workgroups::Indirect(sizes, 4 * u64::from(size)),
                    _ => direct(paths.div_ceil(if rays { self.plan.rays_per_invocation } else { 1 })),
                },
            };
            Step { kernel, workgroups }
        })
    }

    /// Paths waiting in the queue that `vertex` will read.
    fn living_paths(&self, vertex: u32) -> Result<u32, RenderError> {
        let counts: [u32; 4] = self.read_words(Binding::Counts)?;
        Ok(counts[((vertex - 1) % 2) as usize])
    }

    fn read_words(&self, binding: Binding) -> Result<[u32; 4], RenderError> {
        let Some(source) = self.buffers.buffer(binding) else { return Ok([0; 4]) };
        let target = self.readback_buffer(16);
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(source, 0, &target, 0, 16);
        self.device.submit_and_wait(encoder.finish())?;
        let bytes = self.device.read(&target)?;
        Ok(bytemuck::pod_read_unaligned(&bytes[..16]))
    }

    pub(super) fn readback_buffer(&self, size: u64) -> wgpu::Buffer {
        self.device.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        })
    }

    /// Whether the kernels look up their pixels in a list.
    fn takes_pixel_list(&self) -> bool {
        self.plan.switches.enabled.contains("PIXEL_LIST")
    }

    /// How many pixels of a band take part, and the upload of their list, in the order of the film, where the kernels look them up.
    fn listed_pixels(&self, band: &BandState, batch: &Batch<'_>) -> Result<u32, RenderError> {
        let count = self.size[0] * band.rows;
        if !self.takes_pixel_list() {
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
                self.write_pass(band, &pass, sampling);
                self.run_pass(&pass)?;
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
        &self.device.name
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
        self.write(Binding::Statistics, &[0; 16]);
        let request = batch.request;
        let sampling = Sampling { seed: batch.seed.unwrap_or(self.sampling.seed), ..self.sampling };
        let total = batch.total_samples(self.size[0]);
        let mut finished = 0;
        let mut interrupted = false;
        let mut first_row = request.rows.start;
        let mut camera_rays = 0;
        while first_row < request.rows.end && !interrupted {
            let rows = self.plan.band_rows.min(request.rows.end - first_row);
            let mut band = BandState { first_row, rows, samples_done: 0 };
            let progress = |done: u64| {
                observer.progress(finished + done, total);
                observer.stop_requested()
            };
            let pixels = self.listed_pixels(&band, batch)?;
            interrupted = self.render_pixels(&mut band, pixels, request.samples.clone(), &sampling, &progress)?;
            finished += band.samples_done;
            if self.plan.stages == StageMode::Wavefront {
                // `prepare` counts the rays to later vertices; those to the first are the paths themselves.
                camera_rays += band.samples_done;
            }
            on_band(self.finish_band(&band, batch)?)?;
            first_row += rows;
        }
        let [low, high, non_finite_samples, _] = self.read_words(Binding::Statistics)?;
        Ok(RenderReport {
            device: self.device.name.clone(),
            traversal: self.plan.traversal_in_use(),
            decisions: self.plan.decisions.clone(),
            compiled_in: self.plan.switches.enabled.iter().copied().collect(),
            rays: (u64::from(high) << 32 | u64::from(low)) + camera_rays,
            samples: finished,
            non_finite_samples: u64::from(non_finite_samples),
            peak_device_bytes: self.buffers.bytes,
            build_seconds: self.build_seconds,
            compile_seconds: self.compile_seconds,
            render_seconds: start.elapsed().as_secs_f64(),
            interrupted: interrupted && finished < total,
        })
    }
}
