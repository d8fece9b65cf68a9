//! A headless GPU path tracer that proves its pictures against a CPU reference.
//!
//! ```text
//! scene file ─▶ Scene ─▶ PackedScene ─▶ Plan ─▶ stages (GPU) ─▶ Film ─▶ EXR / PNG / stats
//!                 └────────────────▶ reference integrator (CPU, f64) ────┘
//! ```

#[cfg(feature = "bench")]
pub mod bench;
pub mod compare;
pub mod film;
pub mod gpu;
pub mod load;
pub mod math;
pub mod output;
pub mod packed;
pub mod plan;
pub mod reference;
pub mod render;
pub mod renderer;
pub mod sampling;
pub mod scene;
pub mod shader;
pub mod verify;

#[cfg(test)]
#[path = "../tests/statistics/mod.rs"]
mod statistics;
