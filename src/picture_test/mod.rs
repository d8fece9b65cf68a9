//! A picture test that knows noise: is what a scene renders to now what it rendered to when its golden picture was made?
//!
//! - [`golden`]: a picture with the variance of its samples and their numbers, in an EXR file.
//! - [`replications`]: renders of one scene, each with random numbers of its own, and what they scatter by.
//! - [`power`]: how many samples it takes to find a change of a stated size.
//! - [`bless`]: makes a golden picture that is good enough for that.
//! - [`judge`]: the test. A render of fresh random numbers is compared with the golden picture, tile by tile, at a level that is corrected for
//!   their number. What is rejected is rendered again, several times, and only what those reject too is a difference: a few bright samples
//!   that the golden picture happened to miss do not count.
//! - [`candidate`]: the same for pictures of other programs.
//! - `unseen`: the noise that pictures of few samples have and do not show.

pub mod bless;
pub mod candidate;
pub mod golden;
pub mod judge;
pub mod power;
pub mod replications;

mod error;
mod settings;
mod unseen;

pub use error::PictureTestError;
pub use settings::TestSettings;
