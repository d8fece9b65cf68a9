//! Bounds of Russian roulette.

/// Edges from which on roulette always has a chance to end the path.
pub const CERTAIN_ROULETTE_DEPTH: u32 = 64;
/// Largest probability of surviving from there on: even a lossless path ends some day.
pub const LARGEST_SURVIVAL: f64 = 0.999;
