//! The time that each stage of a render takes, and how full the pool of paths is, vertex by vertex.

use super::device::Device;
use super::passes::Pass;
use super::pipeline::{Pipeline, Step};
use crate::plan::bindings::Binding;
use crate::plan::stages::When;
use crate::plan::{MAX_SAMPLES_PER_PASS, StageMode};
use crate::renderer::RenderError;
use crate::sampling::Sampling;

/// The time of one stage in one pass, over all vertices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StageTime {
    /// The kernel's entry point.
    pub stage: &'static str,
    pub seconds: f64,
    pub dispatches: u32,
}

/// One pass, looked at from inside.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// In the order in which they first run.
    pub stages: Vec<StageTime>,
    /// Paths that the pass began with.
    pub paths: u32,
    /// Most paths that the pool holds.
    pub capacity: u32,
    /// Paths alive at the first vertex, the second, … as far as vertices were encoded. Empty for the fused kernel, whose lanes take the next
    /// path by themselves.
    pub alive: Vec<u32>,
}

/// Dispatches of a pass, each between two time stamps.
struct Recorder<'a> {
    device: &'a Device,
    encoder: wgpu::CommandEncoder,
    stamps: wgpu::QuerySet,
    stages: Vec<&'static str>,
}

impl<'a> Recorder<'a> {
    fn new(device: &'a Device, dispatches: u32) -> Self {
        let stamps = device.device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("time stamps"),
            ty: wgpu::QueryType::Timestamp,
            count: 2 * dispatches,
        });
        Self { device, encoder: device.device.create_command_encoder(&Default::default()), stamps, stages: Vec::new() }
    }

    fn record(&mut self, step: &Step<'_>, vertex_index: u32) {
        let first = 2 * self.stages.len() as u32;
        let timestamp_writes = Some(wgpu::ComputePassTimestampWrites {
            query_set: &self.stamps,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        });
        let mut compute = self
            .encoder
            .begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(step.kernel.stage.entry), timestamp_writes });
        step.encode(&mut compute, vertex_index);
        drop(compute);
        self.stages.push(step.kernel.stage.entry);
    }

    /// Runs what was recorded.
    fn finish(mut self) -> Result<Vec<StageTime>, RenderError> {
        let count = 2 * self.stages.len() as u32;
        let bytes = 8 * u64::from(count);
        let device = self.device;
        let resolved = device.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("time stamps"),
            size: bytes,
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let target = device.readback_buffer(bytes);
        self.encoder.resolve_query_set(&self.stamps, 0..count, &resolved, 0);
        self.encoder.copy_buffer_to_buffer(&resolved, 0, &target, 0, bytes);
        device.submit_and_wait(self.encoder.finish())?;
        let ticks: Vec<u64> = device.read(&target)?.chunks_exact(8).map(bytemuck::pod_read_unaligned).collect();
        let period = f64::from(device.queue.get_timestamp_period()) * 1e-9;
        let mut stages: Vec<StageTime> = Vec::new();
        for (stage, pair) in self.stages.iter().zip(ticks.chunks_exact(2)) {
            let seconds = pair[1].saturating_sub(pair[0]) as f64 * period;
            match stages.iter_mut().find(|one| one.stage == *stage) {
                Some(one) => {
                    one.seconds += seconds;
                    one.dispatches += 1;
                }
                None => stages.push(StageTime { stage, seconds, dispatches: 1 }),
            }
        }
        Ok(stages)
    }
}

/// Runs one pass that fills the pool, or the first band, with time stamps around every stage. Vertices beyond those of one submission are
/// left out. The film afterwards holds nothing of use. None where the device has no time stamps.
///
/// # Errors
/// [`RenderError`] that the device reports.
pub(super) fn profile(pipeline: &Pipeline, sampling: &Sampling) -> Result<Option<Profile>, RenderError> {
    let Pipeline { device, plan, width, .. } = pipeline;
    if !device.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
        return Ok(None);
    }
    let wavefront = plan.stages == StageMode::Wavefront;
    let rows = plan.band_rows.min(if wavefront { (plan.path_capacity / width).max(1) } else { u32::MAX });
    let pixel_count = (width * rows).min(plan.path_capacity);
    let samples = (plan.path_capacity / pixel_count).clamp(1, MAX_SAMPLES_PER_PASS);
    let pass = Pass { first_pixel: 0, pixel_count, first_sample: 0, sample_count: samples, film_is_empty: true };
    pipeline.write_pass(0, &pass, sampling);
    if wavefront { profile_wavefront(pipeline, &pass).map(Some) } else { profile_fused(pipeline, &pass).map(Some) }
}

fn profile_fused(pipeline: &Pipeline, pass: &Pass) -> Result<Profile, RenderError> {
    let mut recorder = Recorder::new(&pipeline.device, 1);
    for step in pipeline.steps(When::PassStart, true, pass) {
        recorder.record(&step, 0);
    }
    let paths = pass.paths() as u32;
    Ok(Profile { stages: recorder.finish()?, paths, capacity: paths, alive: Vec::new() })
}

fn profile_wavefront(pipeline: &Pipeline, pass: &Pass) -> Result<Profile, RenderError> {
    let device = &pipeline.device;
    let paths = pass.paths() as u32;
    let vertices = pipeline.vertices_ahead(1);
    pipeline.begin_paths(pass);
    let stages = |when: When| pipeline.plan.pipeline().filter(|stage| stage.when == when).count() as u32;
    let dispatches = stages(When::PassStart) + vertices * stages(When::EachVertex) + stages(When::PassEnd);
    let mut recorder = Recorder::new(device, dispatches);
    let counts = device.readback_buffer(16 * u64::from(vertices));
    for step in pipeline.steps(When::PassStart, true, pass) {
        recorder.record(&step, 0);
    }
    for index in 0..vertices {
        for step in pipeline.steps(When::EachVertex, index == 0, pass) {
            recorder.record(&step, index);
        }
        if let Some(source) = pipeline.buffers.buffer(Binding::Counts) {
            recorder.encoder.copy_buffer_to_buffer(source, 0, &counts, 16 * u64::from(index), 16);
        }
    }
    for step in pipeline.steps(When::PassEnd, false, pass) {
        recorder.record(&step, 0);
    }
    let stages = recorder.finish()?;
    let words: Vec<[u32; 4]> = device.read(&counts)?.chunks_exact(16).map(bytemuck::pod_read_unaligned).collect();
    // After vertex number i (from 1) its survivors wait in the queue that vertex i + 1 reads.
    let survivors = words.iter().zip(1..).map(|(counts, vertex)| counts[(vertex % 2) as usize]);
    let mut alive: Vec<u32> = std::iter::once(paths).chain(survivors).take(vertices as usize).collect();
    while alive.last() == Some(&0) {
        alive.pop();
    }
    Ok(Profile { stages, paths, capacity: pipeline.plan.path_capacity, alive })
}
