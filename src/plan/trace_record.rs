//! The record that a kernel which follows one path writes of each vertex.

use crate::shader::shared::shared_constants;

shared_constants!(constants {
    /// Vertices that are written down; of longer paths the rest is not seen.
    pub const TRACED_VERTICES: u32 = 64;
    /// vec4s of a vertex; `shaders/shading/path/trace.wgsl` says what they hold.
    pub const TRACE_WORDS: u32 = 10;
    // Facts about a vertex, a bit each.
    pub const TRACED_VERTEX: u32 = 1;
    pub const TRACED_LIGHT: u32 = 2;
    pub const TRACED_LIGHT_SEEN: u32 = 4;
    pub const TRACED_SAMPLE: u32 = 8;
    pub const TRACED_NULL: u32 = 16;
    pub const TRACED_ROULETTE: u32 = 32;
    pub const TRACED_FOUND: u32 = 64;
    pub const TRACED_MEDIUM: u32 = 128;
});

/// Bytes of the record of a path.
pub const TRACE_BYTES: u64 = 16 * (TRACED_VERTICES * TRACE_WORDS) as u64;
