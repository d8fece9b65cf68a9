//! A scene on a device: its memory, its kernels, and how a pass runs through them.

use std::time::Instant;

use super::buffers::{Buffers, TAKEN_PIXELS, VERTICES_PER_SUBMISSION, vertex_parameters};
use super::device::Device;
use super::kernels::{self, Kernel};
use super::passes::Pass;
use crate::packed::PackedScene;
use crate::plan::bindings::Binding;
use crate::plan::parameters::PassParameters;
use crate::plan::path_state::{CONNECT_SIZE, COUNTS, WORKGROUP};
use crate::plan::stages::{Over, When};
use crate::plan::{Plan, StageMode};
use crate::renderer::{Ending, RenderError, Stopping};
use crate::sampling::{Sampling, SequencePoint};
use crate::scene::Scene;

/// A kernel and how many workgroups of it run.
pub struct Step<'a> {
    pub kernel: &'a Kernel,
    pub workgroups: Workgroups<'a>,
}

#[derive(Clone, Copy)]
pub enum Workgroups<'a> {
    Direct(u32),
    /// Read by the device, at this offset in bytes.
    Indirect(&'a wgpu::Buffer, u64),
}

impl Step<'_> {
    /// Adds it to a pass, for the submission's vertex number `vertex_index` (from 0).
    pub fn encode(&self, compute: &mut wgpu::ComputePass<'_>, vertex_index: u32) {
        self.kernel.set(compute, vertex_index);
        match self.workgroups {
            Workgroups::Direct(count) => compute.dispatch_workgroups(count, 1, 1),
            Workgroups::Indirect(sizes, offset) => compute.dispatch_workgroups_indirect(sizes, offset),
        }
    }
}

/// A plan that is ready to run on a device.
pub struct Pipeline {
    pub device: Device,
    pub plan: Plan,
    pub buffers: Buffers,
    kernels: Vec<Kernel>,
    /// Width of the film in pixels.
    pub width: u32,
    /// Vertices of a path at most; None: no limit.
    max_vertices: Option<u32>,
    /// Vertices encoded before the host looks again.
    vertices_per_submission: u32,
    /// Seconds since `start` until the scene was uploaded, and seconds of the compiler.
    pub build_seconds: f64,
    pub compile_seconds: f64,
}

impl Pipeline {
    /// Uploads the scene and compiles the plan's stages. `start` is when packing began.
    ///
    /// # Errors
    /// [`RenderError`] that the device or the compiler reports.
    pub fn new(device: Device, plan: Plan, scene: &Scene, packed: &PackedScene, start: Instant) -> Result<Self, RenderError> {
        let width = scene.film.size[0];
        // With null surfaces, whose vertices end no edge, a path's depth does not bound the number of its
        // vertices; most paths
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
            || (Buffers::new(&device, packed, &plan, width), start.elapsed().as_secs_f64()),
        );
        let (stages, compile_seconds) = compiled;
        let bound = device.check().and_then(|()| kernels::bind(&device, stages?, &buffers));
        let kernels = bound.inspect_err(|_| device.leave_if_lost())?;
        Ok(Self { device, plan, buffers, kernels, width, max_vertices, vertices_per_submission, build_seconds, compile_seconds })
    }

    /// Uploads the contents of a buffer, where the plan has it.
    pub fn write(&self, binding: Binding, bytes: &[u8]) {
        if let Some(buffer) = self.buffers.buffer(binding) {
            self.device.queue.write_buffer(buffer, 0, bytes);
        }
    }

    /// Says that the kernels look up their pixels in a list.
    pub fn takes_pixel_list(&self) -> bool {
        self.plan.switches.enabled.contains("PIXEL_LIST")
    }

    /// Uploads what a pass over a band that begins at `first_row` needs: its parameters, and its samples' points of the sampler's sequence.
    pub fn write_pass(&self, first_row: u32, pass: &Pass, sampling: &Sampling) {
        let first_of_band = first_row * self.width;
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
        };
        self.write(Binding::Pass, bytemuck::bytes_of(&parameters));
        if let (Some(_), Some(statistics)) = (self.plan.pixel_takers, self.buffers.buffer(Binding::Statistics)) {
            self.device.queue.write_buffer(statistics, TAKEN_PIXELS, &[0; 4]);
        }
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

    /// Traces the paths of one pass and adds them to the film. Where paths are given up because they do not end, the film stays as it was, and
    /// the reason is returned.
    pub fn run_pass(&self, pass: &Pass, stopping: &Stopping<'_>) -> Result<Option<Ending>, RenderError> {
        match self.plan.stages {
            StageMode::Fused => self.submit(|compute| self.encode(compute, When::PassStart, 0, true, pass)).map(|()| None),
            StageMode::Wavefront => self.run_wavefront(pass, stopping),
        }
    }

    /// Vertices are encoded ahead, so that none waits for the host; only paths longer than a submission holds do.
    fn run_wavefront(&self, pass: &Pass, stopping: &Stopping<'_>) -> Result<Option<Ending>, RenderError> {
        self.begin_paths(pass);
        let mut first_vertex = 1;
        loop {
            let vertices = self.vertices_ahead(first_vertex);
            let last = self.max_vertices.is_some_and(|most| first_vertex + vertices > most);
            if first_vertex > 1 {
                self.write(Binding::Vertex, &vertex_parameters(first_vertex));
            }
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
                return Ok(None);
            }
            if self.living_paths(first_vertex)? == 0 {
                return self.submit(|compute| self.encode(compute, When::PassEnd, 0, false, pass)).map(|()| None);
            }
            if let Some(ending) = stopping.gives_up_paths() {
                return Ok(Some(ending));
            }
        }
    }

    /// Puts all paths of a pass into the queue that its first vertex reads.
    pub fn begin_paths(&self, pass: &Pass) {
        let mut counts = [0_u32; COUNTS as usize];
        counts[0] = pass.paths() as u32;
        self.write(Binding::Counts, bytemuck::cast_slice(&counts));
        self.write(Binding::Vertex, &vertex_parameters(1));
    }

    /// How many vertices a submission holds whose first is `first_vertex`.
    pub fn vertices_ahead(&self, first_vertex: u32) -> u32 {
        self.max_vertices.map_or(u32::MAX, |most| most - first_vertex + 1).min(self.vertices_per_submission)
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
    pub fn steps(&self, when: When, first_vertex: bool, pass: &Pass) -> impl Iterator<Item = Step<'_>> {
        let (paths, pixels) = (pass.paths() as u32, pass.pixel_count);
        self.kernels.iter().filter(move |kernel| kernel.stage.when == when).map(move |kernel| {
            let direct = |invocations: u32| Workgroups::Direct(invocations.div_ceil(WORKGROUP));
            let workgroups = match kernel.stage.over {
                Over::Paths => direct(paths),
                Over::Pixels => direct(pixels),
                Over::PixelsThatAreTaken => self.plan.pixel_takers.map_or_else(|| direct(pixels), Workgroups::Direct),
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
        let counts = self.read_words::<4>(Binding::Counts)?;
        Ok(counts[((vertex - 1) % 2) as usize])
    }

    /// The first words of a buffer; zeros where the plan does not have it.
    pub fn read_words<const N: usize>(&self, binding: Binding) -> Result<[u32; N], RenderError> {
        let Some(source) = self.buffers.buffer(binding) else { return Ok([0; N]) };
        let bytes = self.device.read_start(source, 4 * N as u64)?;
        Ok(std::array::from_fn(|word| bytemuck::pod_read_unaligned(&bytes[4 * word..][..4])))
    }
}
