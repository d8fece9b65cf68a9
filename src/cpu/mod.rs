//! The CPU as a device: the reference integrator renders films.

mod clamp;
mod film;
mod renderer;

pub use renderer::ReferenceRenderer;
