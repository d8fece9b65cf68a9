//! The reference integrator: one readable loop in f64, on the CPU, over the scene as it stands.
//!
//! It draws the same random numbers as the device and takes the same decisions, so that the two agree path by path, and it renders
//! where there is no device. The way of a sample: [`camera`] makes a ray, [`integrator`] follows it from surface to surface,
//! [`intersect`] says which surface it meets, [`bsdf`] how that scatters, [`texture`](crate::texture) what it is made of there, [`lights`] where light is looked for, [`mis`] how the
//! two ways of finding light share it.

pub mod bsdf;
pub mod camera;
mod clamp;
mod coverage;
pub mod emission;
mod film;
mod guided;
pub mod integrator;
pub mod intersect;
pub mod layer;
pub mod light_cells;
pub mod lights;
pub mod mis;
pub mod pilot;
mod renderer;
mod roulette;
pub mod rounding;
mod spread;
pub mod trace;
pub mod training;
mod volume;
pub mod warp;
pub mod work;
pub mod work_of_path;

pub use integrator::Integrator;
pub use renderer::ReferenceRenderer;
pub use trace::{PathTrace, PathVertex};
