//! The alternatives of a plan, and the numbers that decide between them.

use crate::renderer::state::MOST_SAMPLES_PER_ITERATION;

/// Registers that a packet's stack may take: few enough that compilers keep them, enough for hundreds of millions of primitives.
pub(super) const MOST_STACK_REGISTERS: u32 = 16;
/// Samples of one pixel in one pass: as many as an iteration may have.
pub const MAX_SAMPLES_PER_PASS: u32 = MOST_SAMPLES_PER_ITERATION;

/// The form in which kernels have the geometry.
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

/// Bytes of film per pixel of a band: sum and compensation.
pub const FILM_BYTES: u64 = 2 * 16;

/// The storage of the film's sums.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilmStorage {
    /// rgba32float storage textures, where the device can read and write them.
    Texture,
    /// Storage buffers: works everywhere.
    Buffer,
}
