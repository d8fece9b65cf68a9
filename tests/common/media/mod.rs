//! Numbers that pictures of participating media must show, in double precision and independent of the renderer: nothing here imports it.
//!
//! - [`phase`]: phase functions with their integrals and moments.
//! - [`transmittance`]: what is left of light, and what a glowing medium adds, along a line through bodies.
//! - [`grid`]: optical depths of grids of density, exact for trilinear and nearest interpolation.
//! - [`airlight`]: light scattered once, of a point light and of a distant light.
//! - [`half_space`]: Chandrasekhar's H function and the albedo of a half space.
//! - [`slab`]: all orders of scattering in a layer by adding and doubling, with [`fresnel`] boundaries and [`matrix`] algebra.
//! - [`walk`]: a random walk through a layer, the third opinion.
//! - [`quadrature`]: numerical integration over an interval.
//!
//! `tests/cpu/media` holds each of them against something independent.

pub mod airlight;
pub mod fresnel;
pub mod grid;
pub mod half_space;
pub mod matrix;
pub mod phase;
pub mod quadrature;
pub mod slab;
pub mod transmittance;
pub mod walk;
