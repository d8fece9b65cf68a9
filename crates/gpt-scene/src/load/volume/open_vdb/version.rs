//! Versions of the format.

/// The version that brought a switch for compression, the oldest that is read.
pub const SELECTIVE_COMPRESSION: u32 = 220;
/// The version that brought a byte for each node about inactive values, and has compression said for each grid.
pub const NODE_MASK_COMPRESSION: u32 = 222;
/// The newest that is known.
pub const NEWEST: u32 = 225;
