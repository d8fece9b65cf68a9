//! A headless GPU path tracer that proves its pictures against a CPU reference.
//!
//! ```text
//! scene file ─▶ Scene ─▶ FlatScene ─▶ Plan ─▶ wavefront stages (GPU) ─▶ Film ─▶ EXR / PNG / stats
//!                 └────────────────▶ reference integrator (CPU, f64) ────┘
//! ```

pub mod bench;
pub mod compare;
pub mod film;
pub mod flat;
pub mod gpu;
pub mod output;
pub mod plan;
pub mod progressive;
pub mod reference;
pub mod render;
pub mod renderer;
pub mod sampling;
pub mod scene;
pub mod shader;
pub mod statistics;
pub mod verify;
