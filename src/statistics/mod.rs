//! The statistics by which pictures and samplers are judged: no comparison in this project rests on a bare tolerance.
//!
//! - [`moments`]: mean and variance of a stream of numbers.
//! - [`hypothesis`]: Student's t, Welch's t, the z-test, and Šidák's correction for many tests at once.
//! - [`chi_squared`]: Pearson's goodness of fit, with bins of small expectation pooled.
//! - [`image_tests`]: whether two pictures show the same, tile by tile and as a whole.
//! - [`directional`]: whether a sampler of directions follows the density it states, and what that density integrates to.
//! - [`jacobian`]: whether a sampling map stretches the unit square as its density says.
//! - [`quadrature`], [`random`]: the numerical integration and the random numbers these need.

pub mod chi_squared;
pub mod directional;
pub mod hypothesis;
pub mod image_tests;
pub mod jacobian;
pub mod moments;
pub mod quadrature;
pub mod random;

pub use chi_squared::{ChiSquared, chi_squared_test};
pub use directional::{DirectionalReport, SphereBins, test_directional_sampler};
pub use hypothesis::{TestResult, one_sample_t_test, one_sample_t_test_beyond, paired_t_test, sidak, welch_t_test, z_test};
pub use image_tests::{ImageComparison, Picture, TileSettings, compare_independent, compare_paired, compare_replications};
pub use jacobian::{density_by_differences, worst_jacobian_deviation};
pub use moments::Moments;
