//! Parameters of kernels beside the scene.

use crate::shader::shared::shared_struct;

shared_struct! {
/// One pass: a run of consecutive pixels of the band, each with the same samples.
pub struct PassParameters {
    /// First pixel of the pass, over the whole film; where pixels are listed, first pixel of the band.
    pub first_pixel: u32,
    /// First pixel of the pass within the band; where pixels are listed, in the list of the band's pixels.
    pub first_pixel_in_band: u32,
    pub pixel_count: u32,
    /// Absolute index.
    pub first_sample: u32,
    pub sample_count: u32,
    /// 1 until each pixel of the band has its first samples.
    pub film_is_empty: u32,
    /// Always 0.
    pub opaque_zero: u32,
    pub seed: u32,
}
}

shared_struct! {
/// Which vertex of its path a dispatch works on, from 1.
pub struct VertexParameters {
    pub vertex: u32,
    /// Which half of the queues is read.
    pub queue: u32,
    pub padding: [u32; 2],
}
}
