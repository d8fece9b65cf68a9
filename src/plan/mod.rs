//! What a scene needs of the device, and what is skipped.
//!
//! The plan looks at a packed scene and the device's limits, and decides where geometry lives, which stages run, how many paths are in
//! flight, and which parts of the shaders are compiled at all. `gpt check` prints it.

pub mod bindings;
pub mod chunks;
pub mod decisions;
pub mod fault;
pub mod layout;
pub mod limits;
pub mod lobes;
pub mod memory;
mod options;
pub mod parameters;
pub mod path_state;
mod ray_query;
pub mod stages;
pub mod switches;
pub mod trace_record;
pub mod unroll;

use std::fmt;

use crate::packed::hierarchy::Traversal;
use crate::packed::{NONE, PackedScene};
use crate::renderer::RenderError;
use crate::scene::Scene;
use crate::shader::Switches;
use crate::shader::switches::{SWITCHES, contradiction};

pub use chunks::Chunks;
pub use decisions::Decision;
pub use fault::Fault;
pub use limits::{DeviceLimits, RayQueryLimits};
pub use memory::Memory;
pub use options::{PlanOptions, TraversalChoice};

/// Primitives up to which geometry is written into the kernels as constants.
pub const UNROLL_LIMIT: usize = 64;
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

/// The decisions for one scene on one device.
#[derive(Debug, Clone)]
pub struct Plan {
    pub geometry: GeometryPlacement,
    /// How rays find what stands in the hierarchy; without effect where there is none.
    pub traversal: Traversal,
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
    /// Lanes that trace samples of one pixel side by side, their rays in packets; None: each has a pixel of its own.
    pub lanes: Option<u32>,
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
        let traversal = packed.hierarchy.traversal;
        if options.packed_traversal() != traversal {
            return Err(RenderError::Internal(format!("the scene was packed for another traversal: {}", traversal.key())));
        }
        let ray_queries = traversal == Traversal::RayQuery;
        if ray_queries {
            ray_query::check(packed, limits)?;
        }
        if options.trace && options.stages == Some(StageMode::Wavefront) {
            return Err(RenderError::Internal(
                "a path is written down by the kernel that traces whole paths, not by the wavefront".into(),
            ));
        }
        let (geometry, why_geometry) = decisions::geometry(packed, options);
        let light_samples = if switches::samples_lights(scene, packed) { scene.render.light_samples } else { 1 };
        let (stages, why_stages) = decisions::stages(geometry, limits, options);
        // On software devices the arithmetic of a step through a hierarchy costs the same for one lane as for all, so the lanes of a subgroup
        // go through it as one packet, whose stack lies in registers, an entry a lane (shaders/geometry/software/packet.wgsl). Geometry that is code is
        // met by all lanes anyway, and there a lane that starts its next path at once gains.
        let packets = limits.software
            && stages == StageMode::Fused
            && geometry == GeometryPlacement::Hierarchy
            && !options.trace
            && !ray_queries;
        let lanes = limits.subgroup_size.filter(|lanes| {
            packets
                && (4..=64).contains(lanes)
                && lanes.is_power_of_two()
                && packed.hierarchy.stack_size <= MOST_STACK_REGISTERS * lanes
        });
        // Known practice on hardware, and on lavapipe no slower (docs/notes/2026-11-22-wavefront-queues.md).
        let subgroup_queues = stages == StageMode::Wavefront && limits.subgroups;
        let width = scene.film.size[0];
        let film = if limits.read_write_rgba32float && width <= limits.max_texture_side {
            FilmStorage::Texture
        } else {
            FilmStorage::Buffer
        };
        let tables = packed.tables().words;
        let uniform_limit = u64::from(limits.max_uniform_binding);
        let fits_uniform = |bytes: usize| bytes as u64 <= uniform_limit.min(limits.max_array);
        let uniform_primitives = fits_uniform(size_of_val(&packed.primitives[..]));
        let uniform_tables = 16 * tables.len() as u64 <= uniform_limit;
        // Real GPUs serialise divergent reads of uniform buffers; software ones read them faster than storage.
        let uniform_nodes = limits.software && !ray_queries && fits_uniform(size_of_val(&packed.hierarchy.nodes[..]));
        let band_rows = limits.band_rows(scene.film.size, film);
        let mut plan = Self {
            geometry,
            traversal,
            uniform_primitives,
            uniform_tables,
            uniform_nodes,
            chunks: Vec::new(),
            stages,
            film,
            path_capacity: limits.paths_with_shadow_rays(u64::from(light_samples) * memory::SHADOW_RAY_BYTES),
            rays_per_invocation: if limits.software { 32 } else { 1 },
            lanes,
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
        plan.chunks = chunks::cut(packed, &plan, limits.max_array);
        let other_arrays = u32::from(!uniform_tables) + u32::from(!packed.textures.texels.is_empty());
        chunks::check(&plan.chunks, other_arrays, limits.max_array, limits)?;
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
        plan.switches.generated.insert(layout::FILE, layout::wgsl());
        plan.switches.generated.insert(lobes::FILE, lobes::wgsl());
        plan.switches.generated.insert("geometry/constants.wgsl", unroll::constants(packed, first_constant));
        for array in plan.chunks.iter().filter(|array| !array.is_whole()) {
            plan.switches.enable(array.array.switch, true);
            plan.switches.generated.insert(array.array.file, array.wgsl());
        }
        if let Some(contradiction) = contradiction(&plan.switches.enabled) {
            return Err(RenderError::Internal(format!("the plan turns on switches that do not go together: {contradiction}")));
        }
        plan.memory = Memory::new(packed, &plan, width);
        plan.memory.check(limits)?;
        plan.decisions = decisions::explain(&plan, scene, packed, limits, why_geometry, why_stages);
        Ok(plan)
    }

    /// Blocks of four numbers that the table of the sampler's sequence holds for each sample.
    pub fn sequence_stride(&self) -> u32 {
        switches::SEQUENCE_BLOCKS + self.light_samples_depth * (self.light_samples - 1)
    }

    /// Bytes of the shadow rays that a path in flight has at a time.
    pub fn shadow_ray_bytes(&self) -> u64 {
        u64::from(self.light_samples) * memory::SHADOW_RAY_BYTES
    }

    /// How rays find what stands in the hierarchy, where there is one.
    pub fn traversal_in_use(&self) -> Option<Traversal> {
        Some(self.traversal).filter(|_| self.geometry == GeometryPlacement::Hierarchy)
    }

    /// Whether kernels walk nodes of the bounding volume hierarchy.
    pub(crate) fn has_nodes(&self) -> bool {
        self.traversal_in_use() == Some(Traversal::Bvh)
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
        let left_out = SWITCHES.iter().filter(|row| !row.debug && !self.switches.enabled.contains(row.name));
        let skipped: Vec<&str> = left_out.map(|row| row.name).collect();
        writeln!(f, "left out       {}", skipped.join(" "))?;
        writeln!(f, "paths          {} in flight", self.path_capacity)?;
        write!(f, "device memory  {}", self.memory)
    }
}
