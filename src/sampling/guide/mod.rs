//! A guide: from where light arrives at the surfaces of a scene, as a table that both devices read (after Müller, Gross and Novák 2017).
//!
//! Space is cut into cells, by position and by which way a surface faces. Each cell has a histogram over the hemisphere about the mean normal
//! of its surfaces. Bins have equal projected solid angle, so that even bins are the cosine distribution, and the histogram of a diffuse
//! surface holds the product with the cosine. Media have cells of their own, with histograms over all directions, whose bins have equal solid angle. All choices are made by integers, so that devices that round differently draw the same bin
//! unless a position or a direction lies on a border. `shaders/shading/path/guide.wgsl` is the device's half.

mod learn;
pub mod table;

pub use learn::{Arrival, learn};
pub use table::{BINS, Guide, GuideCell};

#[cfg(test)]
mod tests;
