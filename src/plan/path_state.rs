//! How the wavefront keeps paths in flight and their queues.

use crate::shader::shared::shared_constants;

shared_constants!(constants {
    /// Invocations of a workgroup of every stage but `prepare`.
    pub const WORKGROUP: u32 = 64;
    /// vec4s of a path's state: `shaders/stages/wavefront.wgsl` says what they hold.
    pub const PATH_STATE_WORDS: u32 = 5;
    /// The same where shadow rays go through surfaces.
    pub const TRANSPARENT_PATH_STATE_WORDS: u32 = PATH_STATE_WORDS + 1;
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

/// Bytes of state per path: ray, throughput, radiance, hit (`shaders/stages/wavefront.wgsl`), and where `shadows_are_transparent` the point
/// that light was last sampled from.
pub fn path_state_bytes(shadows_are_transparent: bool) -> u64 {
    16 * u64::from(if shadows_are_transparent { TRANSPARENT_PATH_STATE_WORDS } else { PATH_STATE_WORDS })
}
