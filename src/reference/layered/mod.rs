//! Real layers: interfaces one above the other, with slabs of media between them.
//!
//! Everything is taken to happen in one point (position-free; Guo, Hašan and Zhao 2018): only the directions of light count, and within a slab the depth.
//! `shaders/shading/layered` is the same in f32.

mod approximation;
mod evaluation;
mod layers;
mod scatterer;
mod stack;
mod walker;

#[cfg(test)]
mod tests;

pub use layers::LayersOfMaterials;
pub use scatterer::SurfaceScatterer;
