//! Renders a scene on a device: bands, sweeps, passes, submissions.

use std::time::Instant;

use super::buffers::{Buffers, EDGES_PER_SUBMISSION, FilmHalf, binding, edge_parameters};
use super::device::Device;
use super::kernels::{self, Kernel};
use super::parameters::PassParameters;
use super::passes::{Pass, PassSizer};
use crate::film::Band;
use crate::flat::FlatScene;
use crate::plan::{Plan, PlanOptions, StageMode};
use crate::render::{DeviceChoice, Observer, RenderError, RenderReport, RenderRequest, Renderer};
use crate::sampling::{Sampling, SequencePoint};
use crate::scene::Scene;

/// A scene uploaded, its kernels compiled.
pub struct GpuRenderer {
    pub(super) device: Device,
    pub(super) plan: Plan,
    pub(super) buffers: Buffers,
    kernels: Vec<Kernel>,
    pub(super) size: [u32; 2],
    sampling: Sampling,
    /// Edges of a path at most; None: no limit.
    max_depth: Option<u32>,
    /// Edges encoded before the host looks again.
    edges_per_submission: u32,
    build_seconds: f64,
    compile_seconds: f64,
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
        Self::on(&Device::open(choice)?, scene, options)
    }

    /// As [`GpuRenderer::new`], on a device that is already open.
    ///
    /// # Errors
    /// [`RenderError::DoesNotFit`] where the scene is too large for the device.
    pub fn on(device: &Device, scene: &Scene, options: &PlanOptions) -> Result<Self, RenderError> {
        let device = device.clone();
        let start = Instant::now();
        let flat = FlatScene::new(scene).map_err(|error| RenderError::DoesNotFit(error.to_string()))?;
        let plan = Plan::new(scene, &flat, &device.limits, options)?;
        // Where paths may pass through surfaces without ending an edge, edges do not bound the number of vertices; most paths still
        // end by then.
        let passes = plan.switches.enabled.contains("PASS");
        let depth = Some(scene.render.max_depth).filter(|depth| *depth > 0);
        let edges_per_submission = depth.unwrap_or(EDGES_PER_SUBMISSION).min(EDGES_PER_SUBMISSION);
        let max_depth = depth.filter(|_| !passes);
        let buffers = Buffers::new(&device, &flat, &plan, scene.film.size[0]);
        device.check()?;
        let build_seconds = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let kernels = kernels::build(&device, &plan, &buffers)?;
        Ok(Self {
            device,
            plan,
            buffers,
            kernels,
            size: scene.film.size,
            sampling: Sampling::from(&scene.render),
            max_depth,
            edges_per_submission,
            build_seconds,
            compile_seconds: start.elapsed().as_secs_f64(),
        })
    }

    /// What was decided for this scene on this device.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    fn write(&self, number: u32, bytes: &[u8]) {
        if let Some(buffer) = self.buffers.buffer(number) {
            self.device.queue.write_buffer(buffer, 0, bytes);
        }
    }

    fn kernel(&self, entry: &str) -> Option<&Kernel> {
        self.kernels.iter().find(|kernel| kernel.entry == entry)
    }

    fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>, entry: &str, invocations: u32) {
        if let Some(kernel) = self.kernel(entry) {
            kernel.set(pass, 0);
            pass.dispatch_workgroups(invocations.div_ceil(64), 1, 1);
        }
    }

    /// Uploads what a pass needs: its parameters, and its samples' points of the sampler's sequence.
    pub(super) fn write_pass(&self, band: &BandState, pass: &Pass, request: &RenderRequest) {
        let first_sample = request.samples.start + pass.first_sample;
        let parameters = PassParameters {
            first_pixel: band.first_row * self.size[0] + pass.first_pixel,
            first_pixel_in_band: pass.first_pixel,
            pixel_count: pass.pixel_count,
            first_sample,
            sample_count: pass.sample_count,
            film_is_empty: u32::from(pass.film_is_empty),
            opaque_zero: 0,
            seed: self.sampling.seed,
        };
        self.write(binding::PASS, bytemuck::bytes_of(&parameters));
        if self.sampling.uses_sequence() {
            let samples = first_sample..first_sample + pass.sample_count;
            let points: Vec<u32> = samples.flat_map(|sample| SequencePoint::new(&self.sampling, sample).bits).collect();
            self.write(binding::SEQUENCE, bytemuck::cast_slice(&points));
        }
    }

    /// Traces the paths of one pass and adds them to the film.
    pub(super) fn run_pass(&self, pass: &Pass) -> Result<(), RenderError> {
        match self.plan.stages {
            StageMode::Fused => {
                let mut encoder = self.device.device.create_command_encoder(&Default::default());
                let mut compute = encoder.begin_compute_pass(&Default::default());
                self.dispatch(&mut compute, "trace_paths", pass.pixel_count);
                drop(compute);
                self.device.submit_and_wait(encoder.finish())
            }
            StageMode::Wavefront => self.run_wavefront(pass),
        }
    }

    /// Edges are encoded ahead, so that no bounce waits for the host; only paths longer than a submission holds do.
    fn run_wavefront(&self, pass: &Pass) -> Result<(), RenderError> {
        let paths = pass.paths() as u32;
        self.write(binding::COUNTS, bytemuck::cast_slice(&[paths, 0, 0, 0]));
        let mut first_edge = 1;
        loop {
            let edges = self.max_depth.map_or(u32::MAX, |depth| depth - first_edge + 1).min(self.edges_per_submission);
            let last = self.max_depth.is_some_and(|depth| first_edge + edges > depth);
            self.write(binding::EDGE, &edge_parameters(first_edge));
            let mut encoder = self.device.device.create_command_encoder(&Default::default());
            let mut compute = encoder.begin_compute_pass(&Default::default());
            if first_edge == 1 {
                self.dispatch(&mut compute, "generate", paths);
            }
            self.encode_edges(&mut compute, first_edge, edges, paths)?;
            if last {
                self.dispatch(&mut compute, "accumulate", pass.pixel_count);
            }
            drop(compute);
            self.device.submit_and_wait(encoder.finish())?;
            first_edge += edges;
            if last {
                return Ok(());
            }
            if self.living_paths(first_edge)? == 0 {
                let mut encoder = self.device.device.create_command_encoder(&Default::default());
                let mut compute = encoder.begin_compute_pass(&Default::default());
                self.dispatch(&mut compute, "accumulate", pass.pixel_count);
                drop(compute);
                return self.device.submit_and_wait(encoder.finish());
            }
        }
    }

    fn encode_edges(
        &self,
        compute: &mut wgpu::ComputePass<'_>,
        first_edge: u32,
        edges: u32,
        paths: u32,
    ) -> Result<(), RenderError> {
        let missing = || RenderError::Internal("a stage of the wavefront is missing".into());
        let [extend, shade, prepare] = ["extend", "shade", "prepare"].map(|entry| self.kernel(entry).ok_or_else(missing));
        let (extend, shade, prepare) = (extend?, shade?, prepare?);
        let sizes = self.buffers.buffer(binding::DISPATCH_SIZES).ok_or_else(missing)?;
        // The first edge's queue holds all paths of the pass; later sizes come from `prepare`: shade's, extend's, connect's.
        let rays = 64 * self.plan.rays_per_invocation;
        for index in 0..edges {
            for (kernel, size_offset, per_workgroup) in [(extend, 12, rays), (shade, 0, 64)] {
                kernel.set(compute, index);
                if first_edge + index == 1 {
                    compute.dispatch_workgroups(paths.div_ceil(per_workgroup), 1, 1);
                } else {
                    compute.dispatch_workgroups_indirect(sizes, size_offset);
                }
            }
            prepare.set(compute, index);
            compute.dispatch_workgroups(1, 1, 1);
            if let Some(connect) = self.kernel("connect") {
                connect.set(compute, index);
                compute.dispatch_workgroups_indirect(sizes, 24);
            }
        }
        Ok(())
    }

    /// Paths waiting in the queue that `edge` will read.
    fn living_paths(&self, edge: u32) -> Result<u32, RenderError> {
        let counts: [u32; 4] = self.read_words(binding::COUNTS)?;
        Ok(counts[((edge - 1) % 2) as usize])
    }

    fn read_words(&self, number: u32) -> Result<[u32; 4], RenderError> {
        let Some(source) = self.buffers.buffer(number) else { return Ok([0; 4]) };
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

    /// One half of the film of the band's first `rows` rows.
    pub(super) fn read_film(&self, half: &FilmHalf, rows: u32) -> Result<Vec<[f32; 4]>, RenderError> {
        let row_bytes = self.size[0] * 16;
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        let (target, stride) = match half {
            FilmHalf::Texture(texture) => {
                let stride = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
                let target = self.readback_buffer(u64::from(stride) * u64::from(rows));
                let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(stride), rows_per_image: None };
                encoder.copy_texture_to_buffer(
                    texture.as_image_copy(),
                    wgpu::TexelCopyBufferInfo { buffer: &target, layout },
                    wgpu::Extent3d { width: self.size[0], height: rows, depth_or_array_layers: 1 },
                );
                (target, stride)
            }
            FilmHalf::Buffer(buffer) => {
                let size = u64::from(row_bytes) * u64::from(rows);
                let target = self.readback_buffer(size);
                encoder.copy_buffer_to_buffer(buffer, 0, &target, 0, size);
                (target, row_bytes)
            }
        };
        self.device.submit_and_wait(encoder.finish())?;
        let bytes = self.device.read(&target)?;
        let rows = bytes.chunks(stride as usize).map(|row| &row[..row_bytes as usize]);
        Ok(rows.flat_map(|row| row.chunks_exact(16).map(bytemuck::pod_read_unaligned)).collect())
    }

    /// Means of a band from its sums.
    fn finish_band(&self, band: &BandState) -> Result<Band, RenderError> {
        let sums = self.read_film(&self.buffers.film[0], band.rows)?;
        let compensations = self.read_film(&self.buffers.film[1], band.rows)?;
        let mut samples = u32::MAX;
        let mut mean = Vec::with_capacity(sums.len());
        let mut second_moment = Vec::with_capacity(sums.len());
        for (sum, compensation) in sums.iter().zip(&compensations) {
            let count = f64::from(sum[3]);
            samples = samples.min(sum[3] as u32);
            let per_sample = |x: f64| if count > 0.0 { (x / count) as f32 } else { 0.0 };
            // The true sum is the stored one less what its compensation still owes.
            mean.push([0, 1, 2].map(|c| per_sample(f64::from(sum[c]) - f64::from(compensation[c]))));
            second_moment.push(per_sample(f64::from(compensation[3])));
        }
        Ok(Band { first_row: band.first_row, width: self.size[0], rows: band.rows, samples, mean, second_moment })
    }

    /// Renders one band; true where the observer stopped it.
    fn render_band(
        &self,
        band: &mut BandState,
        request: &RenderRequest,
        sizer: &mut PassSizer,
        progress: &dyn Fn(u64) -> bool,
    ) -> Result<bool, RenderError> {
        let pixels = self.size[0] * band.rows;
        let samples = request.samples.end - request.samples.start;
        let mut done = 0;
        while done < samples {
            let sweep = sizer.sweep_samples(pixels, done, samples - done);
            let mut first_pixel = 0;
            while first_pixel < pixels {
                let pixel_count = sizer.pass_pixels(sweep, pixels - first_pixel);
                let pass = Pass { first_pixel, pixel_count, first_sample: done, sample_count: sweep, film_is_empty: done == 0 };
                let start = Instant::now();
                self.write_pass(band, &pass, request);
                self.run_pass(&pass)?;
                sizer.learn(&pass, start.elapsed());
                first_pixel += pixel_count;
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

    fn render(
        &mut self,
        request: &RenderRequest,
        observer: &dyn Observer,
        on_band: &mut dyn FnMut(Band) -> std::io::Result<()>,
    ) -> Result<RenderReport, RenderError> {
        let start = Instant::now();
        self.write(binding::STATISTICS, &[0; 16]);
        let samples = u64::from(request.samples.end - request.samples.start);
        let total = u64::from(self.size[0]) * u64::from(request.rows.end - request.rows.start) * samples;
        let mut sizer = PassSizer::new(self.plan.stages, self.plan.path_capacity);
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
            interrupted = self.render_band(&mut band, request, &mut sizer, &progress)?;
            finished += band.samples_done;
            if self.plan.stages == StageMode::Wavefront {
                // `prepare` counts the rays of later edges; the first edge's are the paths themselves.
                camera_rays += band.samples_done;
            }
            on_band(self.finish_band(&band)?)?;
            first_row += rows;
        }
        let [low, high, non_finite_samples, _] = self.read_words(binding::STATISTICS)?;
        Ok(RenderReport {
            device: self.device.name.clone(),
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
