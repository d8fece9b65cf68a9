//! Intervals that hold the truth at every look: confidence sequences.
//!
//! An interval for a fixed number of samples holds the truth with the stated probability if one looks once. Whoever renders until the
//! interval is narrow enough looks again and again, and stops where chance made it narrow. A confidence sequence holds at all numbers of
//! samples together, so it may be looked at, and stopped by, whenever one likes (Howard, Ramdas, McAuliffe and Sekhon 2021,
//! "Time-uniform, nonparametric, nonasymptotic confidence sequences").
//!
//! - [`sums`] keeps what intervals need of each pixel, sample by sample.
//! - [`boundary`] says how far sums may stray from their expectation.
//! - [`estimate`] makes intervals of pixels, of tiles and of the picture from these. Upper ends need to know how bright one sample can be, for light that
//!   is rare enough has not been seen yet: [`crate::reference::sample_bound`] derives that from a scene.

pub mod boundary;
pub mod estimate;
pub mod options;
pub mod sums;

pub use estimate::IntervalEstimate;
pub use options::{IntervalBasis, IntervalGoal, IntervalOptions, IntervalScope};
