//! Statistics that only tests use: goodness of fit, and what samplers of directions are held against.
//!
//! - [`chi_squared`]: Pearson's goodness of fit, with bins of small expectation pooled.
//! - [`directional`]: whether a sampler of directions follows the density it states, and what that density integrates to.
//! - [`jacobian`]: whether a sampling map stretches the unit square as its density says.
//! - [`quadrature`], [`random`]: the numerical integration and the random numbers these need.

#![allow(dead_code, unused_imports)] // each test program uses a part of it

pub mod chi_squared;
pub mod directional;
pub mod jacobian;
pub mod quadrature;
pub mod random;

pub use chi_squared::{ChiSquared, chi_squared_test};
pub use directional::{DirectionalReport, SphereBins, test_directional_sampler};
pub use jacobian::{density_by_differences, worst_jacobian_deviation};
