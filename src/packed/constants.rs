//! Constants that several of the packed arrays share.

/// "No index" in every array.
pub const NONE: u32 = u32::MAX;
