//! From a scene to a picture: which renderer takes the scene, how long it goes on, and what a user of the crate calls.
//!
//! - `scene`, [`options`], [`stream`], [`image`]: what users of the crate see.
//! - [`checkpoint`]: states of a render in a file, from which another goes on.
//! - [`layers`]: what is rendered beside the picture. [`cryptomatte`]: mattes of objects and materials.
//! - [`stats`]: what a render did, for other programs.
//! - [`progressive`]: renders that end by a time or an error, and samples that follow the noise. [`error_estimate`]: how far a picture is from the truth.

pub mod checkpoint;
pub mod cryptomatte;
pub mod error_estimate;
pub mod frames;
mod free_memory;
pub mod image;
pub mod intervals;
pub mod layers;
pub mod measure;
pub mod options;
pub mod progressive;
#[doc(hidden)]
pub mod scene;
pub mod stats;
pub mod stream;
pub mod verify;
