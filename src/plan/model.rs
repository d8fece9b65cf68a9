//! The plan itself: every decision, as data.

use std::fmt;

use super::choices::{FilmStorage, GeometryPlacement, StageMode};
use super::chunks::Chunks;
use super::memory::Memory;
use super::path_state;
use crate::packed::hierarchy::Traversal;
use crate::renderer::Decision;
use crate::sampling::dimension::SEQUENCE_DIMENSIONS;
use crate::shader::Switches;
use crate::shader::switches::SWITCHES;

/// Blocks of four dimensions that the sequence's table holds per sample.
pub const SEQUENCE_BLOCKS: u32 = SEQUENCE_DIMENSIONS / 4;

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
    /// The arrays of primitives, nodes and attributes in storage buffers, cut where one binding cannot hold
    /// them.
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
    /// Workgroups of a fused kernel whose invocations take pixels from a counter until none is left: one for each thread of a software device, which
    /// deals workgroups to its threads beforehand, and lets none help another. None: each invocation has the pixel of its number.
    pub pixel_takers: Option<u32>,
    /// Pixels that a kernel can have an invocation each for.
    pub pixels_per_dispatch: u32,
    /// Rows of a band at most.
    pub band_rows: u32,
    pub switches: Switches,
    pub memory: Memory,
    pub checked_shaders: bool,
    /// The choices above in words, with the reason for each.
    pub decisions: Vec<Decision>,
}

impl Plan {
    /// Blocks of four numbers that the table of the sampler's sequence holds for each sample.
    pub fn sequence_stride(&self) -> u32 {
        SEQUENCE_BLOCKS + self.light_samples_depth * (self.light_samples - 1)
    }

    /// Bytes of the shadow rays that a path in flight has at a time.
    pub fn shadow_ray_bytes(&self) -> u64 {
        let words = path_state::shadow_ray_words(|switch| self.switches.enabled.contains(switch));
        u64::from(self.light_samples * words) * 16
    }

    /// Bytes of the state of a path in flight.
    pub fn path_state_bytes(&self) -> u64 {
        path_state::path_state_bytes(|switch| self.switches.enabled.contains(switch))
    }

    /// How rays find what stands in the hierarchy, where there is one.
    pub fn traversal_in_use(&self) -> Option<Traversal> {
        Some(self.traversal).filter(|_| self.geometry == GeometryPlacement::Hierarchy)
    }

    /// True where kernels traverse nodes of the bounding volume hierarchy.
    pub(crate) fn has_nodes(&self) -> bool {
        self.traversal_in_use() == Some(Traversal::Bvh)
    }

    /// True where any shadow ray is ever traced.
    pub fn samples_lights(&self) -> bool {
        self.switches.enabled.contains("LIGHTS")
    }
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
