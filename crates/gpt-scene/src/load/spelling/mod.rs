//! How models and material libraries spell what they say: where lines end, what a number looks like, when two names are one.
//!
//! Programs of four decades wrote these files, and people edited them since. What has one meaning is read so; what has none is for the reader of
//! the format to mend and to tell ([`crate::load::mends`]).

pub mod lines;
pub mod names;
pub mod numbers;
