//! The WGSL sources, and how they become the kernels of one plan.

pub mod compose;
mod fold;
pub mod reach;
pub mod shared;
pub mod sources;
pub mod switches;

pub use compose::{ComposeError, ComposedShader, Switches, compose};
