//! How the wavefront keeps paths in flight and their queues.

use crate::shader::shared::shared_constants;

shared_constants!(constants {
    /// Invocations of a workgroup of every stage but `prepare`.
    pub const WORKGROUP: u32 = 64;
    /// vec4s of a path's state: `shaders/stages/wavefront.wgsl` says what they hold.
    pub const PATH_STATE_WORDS: u32 = 5;
    /// Flag beside the primitive of a hit in an instance, which has the instance's number in place of the distance; primitives have 24 bits.
    pub const HIT_IN_INSTANCE: u32 = 1 << 31;
    /// vec4s of a shadow ray.
    pub const SHADOW_RAY_WORDS: u32 = 3;
    /// Queues of paths: one is read while the other is filled.
    pub const QUEUES: u32 = 2;
    /// Counts: paths in queue 0 and 1; paths with shadow rays of vertices that read queue 0 and 1; where paths have several, all shadow
    /// rays of a vertex.
    pub const COUNTS: u32 = 5;
    pub const COUNT_OF_SHADOW_RAYS: u32 = 4;
    // Where the workgroups of a stage stand among the dispatch sizes, three words each.
    pub const SHADE_SIZE: u32 = 0;
    pub const EXTEND_SIZE: u32 = 3;
    pub const CONNECT_SIZE: u32 = 6;
    /// Words of all dispatch sizes.
    pub const DISPATCH_SIZE_WORDS: u32 = 9;
});

/// What paths in flight remember beside what all do (`shaders/stages/wavefront.wgsl`).
#[derive(Debug, Clone, Copy, Default)]
pub struct PathMemory {
    /// Shadow rays go through surfaces: the point that light was last sampled from.
    pub lit_from: bool,
    /// Volumes take light: the extinction of the one that the ray goes through.
    pub extinction: bool,
}

impl PathMemory {
    /// As much as any scene asks for.
    pub const MOST: Self = Self { lit_from: true, extinction: true };

    /// Bytes of state per path: ray, throughput, radiance, hit, and what this says.
    pub fn bytes(self) -> u64 {
        16 * u64::from(PATH_STATE_WORDS + u32::from(self.lit_from) + u32::from(self.extinction))
    }
}
