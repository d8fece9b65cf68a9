//! Parts of a picture, rendered on several machines or one after the other, joined to the picture that one render would have given.
//!
//! A part is an EXR file with some samples of every pixel, or of a region's pixels: its means with what their rounding lost, their variance
//! and numbers of samples. Parts of other pictures, and samples that come twice, are refused from the headers alone (`part`, `cover`).
//! Sums are formed in double precision, in an order that does not depend on that of the files (`sum`).

mod chunks;
mod cover;
mod error;
mod layers;
mod part;
mod sum;

pub use chunks::chunks;
pub use cover::Missing;
pub use part::{MergeError, PartHeader};
pub use sum::{Merged, merge};
