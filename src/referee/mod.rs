//! The referee: small scenes that each ask one thing of a renderer, their true pictures, and a judge that names what a renderer's picture gets wrong.

pub mod causes;
pub mod formulas;
pub mod judge;
pub mod picture;
pub mod replay;
pub mod shipped;
pub mod suite;
pub mod test;
pub mod truth;

pub use judge::{Difference, DifferenceOf, Judgement, Outcome, Seeds, judge};
pub use picture::TruthPicture;
pub use suite::all_tests;
pub use test::{Test, Variant};
pub use truth::Truth;
