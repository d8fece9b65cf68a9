//! The WGSL sources, and how they become the kernels of one plan.

pub mod compose;
pub mod sources;

pub use compose::{ComposeError, ComposedShader, Switches, compose};
