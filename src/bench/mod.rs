//! Run time against error: what a second of rendering buys.
//!
//! - [`setting`]: which settings are compared.
//! - [`subject`]: what renders and tells the time; tests put in estimators of known variance, bias and speed.
//! - [`mod@reference`]: what errors are measured against, with its own error.
//! - [`schedule`]: pictures of rising numbers of samples, over and over, settings in turn.
//! - [`analysis`]: errors with intervals, slopes, floors, ratios at equal time and at equal error.
//! - [`convergence`]: all of it for one scene.
//! - [`speed`], [`growth`]: samples and rays a second, where the time goes, how it grows.
//! - [`features`]: what a feature costs when used, and when only compiled in.
//! - [`scenes`]: what these are measured on.
//! - [`report`]: the page, the tables.
//! - [`interval`]: medians, spreads, and whether a difference is more than noise.

pub mod analysis;
pub mod convergence;
mod denoised;
pub mod feature_rooms;
pub mod features;
pub mod growth;
pub mod interval;
pub mod machine;
pub mod reference;
pub mod report;
pub mod scenes;
pub mod schedule;
pub mod setting;
pub mod speed;
pub mod subject;
#[cfg(test)]
mod synthetic;
