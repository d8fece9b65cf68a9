//! Randomness as a pure function of (seed, pixel, sample index, named dimension), the same bits on every device.
//!
//! Every random number starts as 32 bits, a fixed-point fraction of [0, 1). Both devices use its upper 24 bits, so that the f32
//! and the f64 number are the same number. `shaders/sampler.wgsl` is the device's half of this module.

pub mod alias;
pub mod dimension;
pub mod halton;
pub mod hash;
pub mod sampler;

pub use alias::AliasTable;
pub use dimension::{BounceDimension, CameraDimension, Dimension};
pub use sampler::{PathSampler, SequencePoint};
