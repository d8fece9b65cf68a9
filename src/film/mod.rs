//! What rendering produces: finished rows of pixels.

/// Consecutive full-width rows of the picture. A renderer works through the film band by band, so that memory does not grow with
/// the picture.
#[derive(Debug, Clone, Default)]
pub struct Band {
    /// First row, counted from the top.
    pub first_row: u32,
    pub width: u32,
    pub rows: u32,
    /// Samples each pixel of the band received; where they differ, the fewest.
    pub samples: u32,
    /// Samples of each pixel, in the order of `mean`, where a render ended in the middle of a sweep or samples follow the noise; None: every
    /// pixel has `samples`. A picture's bands all have counts, or none has.
    pub counts: Option<Vec<u32>>,
    /// Mean radiance per pixel, row by row from the top; `width * rows` long.
    pub mean: Vec<[f32; 3]>,
    /// Mean of the squared luminance per pixel, same order.
    pub second_moment: Vec<f32>,
}
