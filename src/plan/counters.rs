//! Counters of kernels, and their words in the statistics' buffer.

use crate::shader::shared::shared_constants;

shared_constants!(constants {
    /// Rays traced; the low word of 64 bits, as all but the last.
    pub const RAYS_COUNTER: u32 = 0;
    /// Samples refused because they were not finite.
    pub const REFUSED_COUNTER: u32 = 2;
    /// Samples that were brighter than the setting `clamp` allows.
    pub const CLAMPED_COUNTER: u32 = 4;
    /// The luminance that clamping took, in [`CLAMP_UNITS`](crate::renderer::state::CLAMP_UNITS) of the radiance that is allowed.
    pub const CLAMPED_UNITS_COUNTER: u32 = 6;
    /// Pixels of the pass that were taken: one word.
    pub const TAKEN_COUNTER: u32 = 8;
    /// Words of all counters, in whole vectors of four.
    pub const COUNTER_WORDS: u32 = 12;
});
