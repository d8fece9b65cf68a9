//! The reference integrator: one readable loop in f64, on the CPU, over the scene as it stands.
//!
//! The reference draws the same random numbers as the device and takes the same decisions, so that the two
//! agree path by path. The CPU's renderer ([`crate::cpu`]) and learning ([`crate::learn`]) use it. The way of
//! a sample: [`camera`] makes a ray, [`integrator`] follows it from surface to surface,
//! [`intersect`] says which surface it meets, [`bsdf`] how that scatters, [`texture`](crate::texture) what it is made of there, [`lights`] where light is looked for, [`mis`](crate::sampling::mis) how the
//! two ways of finding light share it.

pub mod bsdf;
pub mod camera;
pub mod coverage;
pub mod emission;
mod free_flight;
pub mod guided;
pub mod integrator;
pub mod intersect;
pub mod layer;
mod layered;
pub mod lights;
mod medium;
mod phase;
pub mod roulette;
pub mod rounding;
pub mod sample_bound;
pub mod scatterer;
pub mod trace;
mod tracking;
pub mod warp;
pub mod work;

pub use integrator::Integrator;
pub use trace::{PathTrace, PathVertex};
