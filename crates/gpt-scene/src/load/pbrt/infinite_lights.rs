//! The lights from everywhere that a file has so far.

use glam::DMat3;

use super::text::Spot;
use crate::scene::ImageData;
use crate::spectrum::Spectrum;

/// The `infinite` lights so far.
#[derive(Default)]
pub struct InfiniteLights {
    pub constant: Spectrum,
    pub maps: Vec<InfiniteMap>,
    /// The place of the first of them.
    pub spot: Option<Spot>,
}

/// A light with a picture.
pub struct InfiniteMap {
    pub image: ImageData,
    /// From the world's directions to the light's.
    pub to_light: DMat3,
    pub scale: f64,
}
