//! The results of rendering: finished rows of pixels, and layers beside them.

mod count;

pub use count::{count_in, count_word};
pub use gpt_scene::layer::{KernelLayer, Layer, PartChannels, RenderedLayer, group_channels};

use crate::spectrum::Spectrum;

/// Most pixels of a film that is rendered as a whole: those of an 8K picture, which take 1 GiB on a device. Larger pictures are
/// rendered in bands, one after the other, so that memory stays bounded.
pub const MOST_FILM_PIXELS: u64 = 1 << 25;

/// Consecutive full-width rows of the picture. A renderer works through the film band by band, so that memory does not grow with
/// the picture.
#[derive(Debug, Clone, Default)]
pub struct Band {
    /// First row, counted from the top.
    pub first_row: u32,
    /// Columns.
    pub width: u32,
    /// Number of rows.
    pub rows: u32,
    /// Samples each pixel of the band received; where they differ, the fewest.
    pub samples: u32,
    /// Samples of each pixel, in the order of `mean`, where a render ended in the middle of an iteration or samples follow the noise; None: every
    /// pixel has `samples`. A picture's bands all have counts, or none has.
    pub counts: Option<Vec<u32>>,
    /// Mean radiance per pixel, row by row from the top; `width * rows` long.
    pub mean: Vec<[f32; 3]>,
    /// The rounding error of `mean`, in the same order; empty where it is not known.
    pub remainder: Vec<[f32; 3]>,
    /// Mean of the squared luminance per pixel, same order.
    pub second_moment: Vec<f32>,
    /// The ends of each pixel's interval, same order; empty where none was asked for.
    pub low: Vec<[f32; 3]>,
    pub high: Vec<[f32; 3]>,
    /// The low and the high end of the interval of the whole picture's mean, where it was asked for.
    pub picture_ends: Option<[[f64; 3]; 2]>,
}

impl Band {
    /// The part of a region, first column and row, width and height, all of whose rows that the band has; counted from the region's first.
    pub fn cropped(self, [x, y, columns, _]: [u32; 4]) -> Self {
        Self {
            first_row: self.first_row - y,
            width: columns,
            counts: self.counts.map(|counts| columns_of(&counts, self.width, x, columns)),
            mean: columns_of(&self.mean, self.width, x, columns),
            remainder: columns_of(&self.remainder, self.width, x, columns),
            second_moment: columns_of(&self.second_moment, self.width, x, columns),
            low: columns_of(&self.low, self.width, x, columns),
            high: columns_of(&self.high, self.width, x, columns),
            ..self
        }
    }
}

/// Some columns of rows of this width.
fn columns_of<T: Copy>(items: &[T], width: u32, x: u32, columns: u32) -> Vec<T> {
    let range = x as usize..(x + columns) as usize;
    items.chunks_exact(width as usize).flat_map(|row| &row[range.clone()]).copied().collect()
}

/// A mean as the nearest numbers of single precision, and what they lack: 48 bits together.
pub fn rounded(mean: [f64; 3]) -> ([f32; 3], [f32; 3]) {
    let nearest = mean.map(|value| value as f32);
    (nearest, std::array::from_fn(|channel| (mean[channel] - f64::from(nearest[channel])) as f32))
}

/// The unbiased variance of a pixel's samples, channel by channel; 0 of a single sample. That of their mean is smaller by their number, if they are
/// independent. Of the squares the film has those of luminance, so channels are taken to vary as it does, in proportion to their means.
pub fn variance(mean: [f64; 3], second_moment: f64, samples: f64) -> [f64; 3] {
    let luminance = luminance_of(mean);
    let of_luminance = (second_moment - luminance * luminance).max(0.0) * samples / (samples - 1.0);
    let share = |channel: f64| if luminance > 0.0 { (channel / luminance).powi(2) } else { 1.0 };
    if samples > 1.0 { mean.map(|channel| of_luminance * share(channel)) } else { [0.0; 3] }
}

/// The mean of the squared luminance that has these variances.
pub fn second_moment(mean: [f64; 3], variance: [f64; 3], samples: f64) -> f64 {
    let luminance = luminance_of(mean);
    // The brightest channel has the most digits.
    let brightest = (0..3).max_by(|a, b| mean[*a].total_cmp(&mean[*b])).unwrap_or(0);
    let share = if mean[brightest] > 0.0 { (luminance / mean[brightest]).powi(2) } else { 1.0 };
    luminance * luminance + variance[brightest] * share * (samples - 1.0).max(0.0) / samples.max(1.0)
}

fn luminance_of(mean: [f64; 3]) -> f64 {
    Spectrum::from_rgb(mean).luminance()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_region_has_its_columns() {
        let mean: Vec<[f32; 3]> = (0..8).map(|pixel| [pixel as f32; 3]).collect();
        let band = Band { first_row: 7, width: 4, rows: 2, counts: Some((10..18).collect()), mean, ..Band::default() };
        let region = band.cropped([1, 5, 2, 9]);
        assert_eq!((region.first_row, region.width, region.rows), (2, 2, 2));
        assert_eq!(region.mean.iter().map(|mean| mean[0]).collect::<Vec<_>>(), [1.0, 2.0, 5.0, 6.0]);
        assert_eq!(region.counts.as_deref(), Some([11, 12, 15, 16].as_slice()));
    }

    #[test]
    fn means_and_squares_survive_the_way_through_a_file() {
        for mean in [[0.1, 1.0 / 3.0, 0.7], [0.0, 0.0, 2.0], [0.0; 3]] {
            let (nearest, rest) = rounded(mean);
            for channel in 0..3 {
                let back = f64::from(nearest[channel]) + f64::from(rest[channel]);
                assert!((back - mean[channel]).abs() <= 1e-14 * mean[channel]);
            }
            for samples in [2.0, 77.0] {
                let squares = 1.5;
                let back = second_moment(mean, variance(mean, squares, samples), samples);
                assert!((back - squares).abs() < 1e-12, "{back}");
            }
            let luminance = luminance_of(mean);
            assert_eq!(
                second_moment(mean, variance(mean, 3.0, 1.0), 1.0),
                luminance * luminance,
                "of one sample there is no variance"
            );
        }
        // Grey samples 0 and 2: their variance is (1 + 1) / (2 - 1).
        let grey = variance([1.0; 3], 2.0, 2.0);
        assert!(grey.iter().all(|variance| (variance - 2.0).abs() < 1e-12), "{grey:?}");
    }

    /// No channel of a part is two things.
    #[test]
    fn channels_of_parts_have_names_of_their_own() {
        let kernels = KernelLayer::ALL.into_iter().map(KernelLayer::part_channels);
        let group = RenderedLayer::LightGroup("emission".to_owned()).part_channels();
        let mut names: Vec<String> = kernels
            .chain([group])
            .flat_map(|PartChannels { values, remainders, count }| [values, remainders, vec![count]].concat())
            .chain(crate::output::part_channels().map(str::to_owned))
            .collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
    }
}
