//! The comparison of two pictures: whether they show the same, and how far they are apart.
//!
//! - [`metrics`]: errors of one picture against another.
//! - [`image_tests`]: tests with a stated level, tile by tile and as a whole.
//! - [`hypothesis`]: Student's t, Welch's t, the z-test, and Šidák's correction for many tests at once.
//! - [`flip`]: how different pictures look to the eye.
//! - [`intervals`]: by how much pictures differ at least, where their pixels have intervals.
//! - [`moments`]: mean and variance of a stream of numbers.

pub mod flip;
pub mod hypothesis;
pub mod image_tests;
pub mod intervals;
pub mod metrics;
pub mod moments;

pub use hypothesis::{TestResult, one_sample_t_test, one_sample_t_test_beyond, paired_t_test, sidak, welch_t_test, z_test};
pub use image_tests::{
    Finding, ImageComparison, ImageView, Region, Scatter, TileSettings, compare_independent, compare_measured, compare_paired,
    compare_paired_above, compare_replications,
};
pub use metrics::{Comparison, Extreme, Metric, MetricValue, RELATIVE_EPSILON, SizeMismatch, compare, relative_weight};
pub use moments::Moments;
