//! What a scene needs of the device, and what is skipped.
//!
//! The plan looks at a packed scene and the device's limits, and decides where geometry lives, which stages run, how many paths are in
//! flight, and which parts of the shaders are compiled at all. `gpt check` prints it.

pub mod chunks;
pub mod decisions;
pub mod fault;
pub mod limits;
pub mod memory;
mod ray_query;
pub mod switches;
pub mod unroll;

use std::fmt;

use crate::packed::hierarchy::HierarchyKind;
use crate::packed::{NONE, PackedScene};
use crate::renderer::RenderError;
use crate::scene::Scene;
use crate::shader::Switches;

pub use chunks::Chunks;
pub use decisions::Decision;
pub use fault::Fault;
pub use limits::DeviceLimits;
pub use memory::Memory;

/// Primitives up to which geometry is written into the kernels as constants.
pub const UNROLL_LIMIT: usize = 64;
/// The fastest form of hierarchy on software devices (BENCHMARKS.md).
const SOFTWARE_HIERARCHY: HierarchyKind = HierarchyKind::Bvh4;
/// Registers that a packet's stack may take: few enough that compilers keep them, enough for hundreds of millions of primitives.
const MOST_STACK_REGISTERS: u32 = 16;
/// Samples of one pixel in one pass.
pub const MAX_SAMPLES_PER_PASS: u32 = 64;

/// Where the geometry lives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GeometryPlacement {
    /// Every primitive is code with constant coordinates; there is no hierarchy.
    Unrolled,
    /// A bounding volume hierarchy, in buffers or the device's own.
    Hierarchy,
}

/// How the stages run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StageMode {
    /// Separate kernels over queues: generate, extend, shade, connect, accumulate.
    Wavefront,
    /// One kernel traces whole paths.
    Fused,
}

/// Where the film's sums live.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilmStorage {
    /// rgba32float storage textures, where the device can read and write them.
    Texture,
    /// Storage buffers: works everywhere.
    Buffer,
}

/// Choices forced from outside, for tests and measurements. None: the plan decides. What moves is never unrolled.
#[derive(Debug, Clone, Default)]
pub struct PlanOptions {
    pub geometry: Option<GeometryPlacement>,
    /// The form of the hierarchy, where there is one; the scene must have been packed with it ([`PlanOptions::hierarchy()`]). With
    /// [`HierarchyKind::RayQuery`] the device must have been opened for it ([`crate::gpu::Device::open_for`]).
    pub hierarchy: Option<HierarchyKind>,
    pub stages: Option<StageMode>,
    pub film: Option<FilmStorage>,
    pub path_capacity: Option<u32>,
    /// Bytes of primitives, nodes or attributes that one binding may hold, where the device would allow more.
    pub largest_chunk: Option<u64>,
    /// Let the lanes of a subgroup trace samples of one pixel; without effect where the stages or the device do not allow it.
    pub share_pixels: Option<bool>,
    /// Let those lanes go through the hierarchy together; without effect where they do not share a pixel.
    pub packets: Option<bool>,
    /// Let a subgroup take its places in the wavefront's queues by one atomic; without effect where the stages or the device do not
    /// allow it.
    pub subgroup_queues: Option<bool>,
    /// Keep naga's bounds checks and loop bounds in the kernels.
    pub checked_shaders: bool,
    /// Write down what happens along a path, for [`crate::gpu::GpuRenderer::trace`]; one kernel then traces whole paths.
    pub trace: bool,
    /// Let a batch leave pixels out ([`crate::renderer::Batch::selection`]).
    pub pixel_list: bool,
    /// Switches of parts that are compiled though the scene does not need them, to measure what leaving them out is worth.
    pub compile_in: Vec<&'static str>,
    /// Compute wrongly, so that tests can see whether it is noticed.
    pub fault: Option<Fault>,
}

impl PlanOptions {
    /// The form of hierarchy in which a scene has to be packed for a device.
    pub fn hierarchy(&self, limits: &DeviceLimits) -> HierarchyKind {
        let preferred = if limits.software { SOFTWARE_HIERARCHY } else { HierarchyKind::default() };
        self.hierarchy.unwrap_or(preferred)
    }

    /// Whether plans may need ray queries of the device, which has to be opened for them.
    pub fn asks_for_ray_queries(&self) -> bool {
        self.hierarchy == Some(HierarchyKind::RayQuery)
    }
}

/// The decisions for one scene on one device.
#[derive(Debug, Clone)]
pub struct Plan {
    pub geometry: GeometryPlacement,
    /// The form of the hierarchy; without effect where there is none.
    pub hierarchy: HierarchyKind,
    /// Primitives are few enough for a uniform buffer, whose loads cost less.
    pub uniform_primitives: bool,
    /// So are the tables of materials, lights and textures.
    pub uniform_tables: bool,
    /// So are the hierarchy's nodes.
    pub uniform_nodes: bool,
    /// Those of the arrays of primitives, nodes and attributes that stand in storage buffers, cut where one binding cannot hold them.
    pub chunks: Vec<Chunks>,
    pub stages: StageMode,
    pub film: FilmStorage,
    /// Paths in flight at most.
    pub path_capacity: u32,
    /// Rays that one invocation of extend or connect traces, one after the other.
    pub rays_per_invocation: u32,
    /// Lanes that trace samples of one pixel side by side; None: each has a pixel of its own.
    pub lanes: Option<u32>,
    /// Those lanes go through the hierarchy together.
    pub packets: bool,
    /// A subgroup takes its places in queues by one atomic, not one for each invocation.
    pub subgroup_queues: bool,
    /// Light samples at a path's first surfaces, and at how many of them; 1 and 0 where each takes one at most.
    pub light_samples: u32,
    pub light_samples_depth: u32,
    /// Runs of workgroups into which the device cuts a dispatch, one for each of its threads. Neighbouring workgroups are dealt to
    /// different runs, because no thread helps another with its own.
    pub runs: u32,
    /// Rows of a band at most.
    pub band_rows: u32,
    pub switches: Switches,
    pub memory: Memory,
    pub checked_shaders: bool,
    /// The choices above in words, with the reason for each.
    pub decisions: Vec<Decision>,
}

impl Plan {
    /// Decides.
    ///
    /// # Errors
    /// [`RenderError::DoesNotFit`] where an array is larger than the device can bind, naming both sizes. [`RenderError::Internal`] where
    /// the scene was packed with another hierarchy than the options say.
    pub fn new(scene: &Scene, packed: &PackedScene, limits: &DeviceLimits, options: &PlanOptions) -> Result<Self, RenderError> {
        let hierarchy = packed.hierarchy.kind();
        if options.hierarchy.is_some_and(|wanted| wanted != hierarchy) {
            return Err(RenderError::Internal(format!("the scene was packed with a hierarchy that is {hierarchy}")));
        }
        let ray_queries = hierarchy == HierarchyKind::RayQuery;
        if ray_queries {
            ray_query::check(packed, limits)?;
        }
        let (geometry, why_geometry) = decisions::geometry(packed, options);
        let light_samples = if switches::samples_lights(scene, packed) { scene.render.light_samples } else { 1 };
        let (stages, why_stages) = decisions::stages(geometry, light_samples, limits, options);
        // On software devices the arithmetic of a step through a hierarchy costs the same for one lane as for all, so lanes should go
        // the same way. Geometry that is code is met by all lanes anyway, and there a lane that starts its next path at once gains.
        let may_share = limits.software && stages == StageMode::Fused && !options.trace && !ray_queries;
        let lanes = limits.subgroup_size.filter(|size| may_share && (2..=64).contains(size) && size.is_power_of_two());
        let lanes = lanes.filter(|_| options.share_pixels.unwrap_or(geometry == GeometryPlacement::Hierarchy));
        // Packets are written for that form alone, and their stack lies in registers, an entry a lane (shaders/geometry/packet.wgsl).
        let packets = geometry == GeometryPlacement::Hierarchy
            && hierarchy == HierarchyKind::Bvh4
            && lanes.is_some_and(|lanes| lanes >= 4 && packed.hierarchy.stack_size <= MOST_STACK_REGISTERS * lanes)
            && options.packets.unwrap_or(true);
        // Known practice on hardware, and on lavapipe no slower (BENCHMARKS.md).
        let subgroup_queues = stages == StageMode::Wavefront && limits.subgroups && options.subgroup_queues.unwrap_or(true);
        let width = scene.film.size[0];
        let film = options.film.unwrap_or(if limits.read_write_rgba32float && width <= limits.max_texture_side {
            FilmStorage::Texture
        } else {
            FilmStorage::Buffer
        });
        let tables = packed.tables().words;
        let uniform_limit = u64::from(limits.max_uniform_binding);
        let largest_chunk = options.largest_chunk.unwrap_or(u64::MAX).min(limits.largest_array());
        let fits_uniform = |bytes: usize| bytes as u64 <= uniform_limit.min(largest_chunk);
        let uniform_primitives = fits_uniform(size_of_val(&packed.primitives[..]));
        let uniform_tables = 16 * tables.len() as u64 <= uniform_limit;
        // Real GPUs serialise divergent reads of uniform buffers; software ones read them faster than storage.
        let uniform_nodes = limits.software && !ray_queries && fits_uniform(packed.hierarchy.nodes.bytes().len());
        let path_capacity = options.path_capacity.unwrap_or_else(|| limits.path_capacity());
        let band_rows = limits.band_rows(scene.film.size, film);
        let mut plan = Self {
            geometry,
            hierarchy,
            uniform_primitives,
            uniform_tables,
            uniform_nodes,
            chunks: Vec::new(),
            stages,
            film,
            path_capacity,
            rays_per_invocation: if limits.software { 32 } else { 1 },
            lanes,
            packets,
            subgroup_queues,
            light_samples,
            light_samples_depth: if light_samples > 1 { scene.render.light_samples_depth } else { 0 },
            runs: limits.threads.max(1),
            band_rows,
            switches: Switches::default(),
            memory: Memory::default(),
            checked_shaders: options.checked_shaders,
            decisions: Vec::new(),
        };
        plan.chunks = chunks::cut(packed, &plan, largest_chunk);
        let other_arrays = u32::from(!uniform_tables) + u32::from(!packed.textures.texels.is_empty());
        chunks::check(&plan.chunks, other_arrays, largest_chunk, limits)?;
        plan.switches = switches::choose(scene, packed, &plan);
        plan.switches.enable("TRACE", options.trace);
        plan.switches.enable("PIXEL_LIST", options.pixel_list && !options.trace);
        for switch in &options.compile_in {
            plan.switches.enable(switch, true);
        }
        if let Some(fault) = options.fault {
            fault.plant(packed, &mut plan.switches);
        }
        let first_constant = match geometry {
            GeometryPlacement::Unrolled => 0,
            GeometryPlacement::Hierarchy => packed.hierarchy.primitive_count as usize,
        };
        plan.switches.generated.insert("geometry/constants.wgsl", unroll::constants(packed, first_constant));
        for array in plan.chunks.iter().filter(|array| !array.is_whole()) {
            plan.switches.enable(array.array.switch, true);
            plan.switches.generated.insert(array.array.file, array.wgsl());
        }
        plan.memory = Memory::new(packed, &plan, width);
        plan.memory.check(limits)?;
        plan.decisions = decisions::explain(&plan, scene, packed, limits, options, why_geometry, why_stages);
        Ok(plan)
    }

    /// The shader files whose entry points run, in the order of the data's way.
    pub fn stage_files(&self) -> &'static [(&'static str, &'static str)] {
        match self.stages {
            StageMode::Fused if self.lanes.is_some() => &[("stages/fused_lanes.wgsl", "trace_paths")],
            StageMode::Fused => &[("stages/fused.wgsl", "trace_paths")],
            StageMode::Wavefront => &[
                ("stages/generate.wgsl", "generate"),
                ("stages/extend.wgsl", "extend"),
                ("stages/shade.wgsl", "shade"),
                ("stages/prepare.wgsl", "prepare"),
                ("stages/connect.wgsl", "connect"),
                ("stages/accumulate.wgsl", "accumulate"),
            ],
        }
    }

    /// Blocks of four numbers that the table of the sampler's sequence holds for each sample.
    pub fn sequence_stride(&self) -> u32 {
        switches::SEQUENCE_BLOCKS + self.light_samples_depth * (self.light_samples - 1)
    }

    /// The form of the hierarchy, where rays go through one.
    pub fn hierarchy_in_use(&self) -> Option<HierarchyKind> {
        Some(self.hierarchy).filter(|_| self.geometry == GeometryPlacement::Hierarchy)
    }

    /// Whether kernels walk nodes of ours.
    pub(crate) fn has_nodes(&self) -> bool {
        self.hierarchy_in_use().is_some_and(|kind| kind != HierarchyKind::RayQuery)
    }

    /// Whether any shadow ray is ever traced.
    pub fn samples_lights(&self) -> bool {
        self.switches.enabled.contains("LIGHTS")
    }
}

/// Whether some primitive carries normals or texture coordinates.
pub(crate) fn has_attributes(packed: &PackedScene) -> bool {
    packed.primitives.iter().any(|primitive| primitive.attributes != NONE)
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for Decision { about, choice, because } in &self.decisions {
            writeln!(f, "{about:<14} {choice} ({because})")?;
        }
        let features: Vec<&str> = self.switches.enabled.iter().copied().collect();
        writeln!(f, "compiled in    {}", features.join(" "))?;
        let skipped: Vec<&str> = switches::ALL
            .iter()
            .copied()
            .filter(|name| !self.switches.enabled.contains(name) && !switches::DEBUG.contains(name))
            .collect();
        writeln!(f, "left out       {}", skipped.join(" "))?;
        writeln!(f, "paths          {} in flight", self.path_capacity)?;
        write!(f, "device memory  {}", self.memory)
    }
}
