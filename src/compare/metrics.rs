//! Error metrics between a picture and its reference, per channel, in f64.

use serde::Serialize;

use crate::choice::choices;
use crate::output::Image;

/// Keeps dark pixels from deciding the relative error, as in pbrt's `imgtool` and Rousselle et al. 2011.
pub const RELATIVE_EPSILON: f64 = 1e-2;

/// The factor of a squared difference in the relative error, for this value of the reference.
pub fn relative_weight(reference: f64) -> f64 {
    1.0 / (reference * reference + RELATIVE_EPSILON)
}

choices! {
    /// The quantity that is averaged over pixels and channels; a is the picture, b the reference.
    pub enum Metric {
        /// Mean squared error: (a − b)².
        Mse = "mse",
        /// Relative mean squared error: (a − b)² / (b² + 0.01).
        RelMse = "relmse",
        /// Mean absolute error: |a − b|.
        Mae = "mae",
        /// Peak signal-to-noise ratio in decibels: 10 log₁₀(p² / MSE), p the reference's largest value.
        Psnr = "psnr",
    }
}

/// A metric's value for red, green and blue, and over all three.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MetricValue {
    /// The metric of red, green and blue.
    pub channels: [f64; 3],
    /// Over all channels.
    pub all: f64,
}

/// The pixel where two pictures are farthest apart.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Extreme {
    /// Its absolute value, in the units of the pictures.
    pub difference: f64,
    /// Column from the left.
    pub x: u32,
    /// Row from the top.
    pub y: u32,
    /// 0 red, 1 green, 2 blue.
    pub channel: usize,
}

/// Everything that is known of two pictures of one size. Means and metrics leave out pixels that are not finite in either picture; where none is left,
/// they are not numbers (JSON says null).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Columns of both pictures.
    pub width: u32,
    /// Rows of both pictures.
    pub height: u32,
    /// Per-channel means of the picture and of the reference.
    pub means: [[f64; 3]; 2],
    /// [`Metric::Mse`].
    pub mse: MetricValue,
    /// [`Metric::RelMse`].
    pub relmse: MetricValue,
    /// [`Metric::Mae`].
    pub mae: MetricValue,
    /// Infinite where the mean squared error is 0; JSON has no such number and says null.
    pub psnr: MetricValue,
    /// The pixel where they are farthest apart.
    pub largest: Extreme,
    /// Pixels that differ in some channel.
    pub different_pixels: u64,
    /// Pixels with a value that is not finite, in the picture and in the reference.
    pub non_finite_pixels: [u64; 2],
}

/// The two pictures have different sizes.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the pictures have different sizes: {}x{} and {}x{}", sizes[0][0], sizes[0][1], sizes[1][0], sizes[1][1])]
pub struct SizeMismatch {
    /// Width and height of the picture and of the reference.
    pub sizes: [[u32; 2]; 2],
}

impl Comparison {
    /// One metric's values.
    pub fn value(&self, metric: Metric) -> MetricValue {
        match metric {
            Metric::Mse => self.mse,
            Metric::RelMse => self.relmse,
            Metric::Mae => self.mae,
            Metric::Psnr => self.psnr,
        }
    }

    /// True if the pictures count as equal. Without a metric the largest absolute difference must not exceed
    /// `tolerance`; with one its value over all channels, and for [`Metric::Psnr`] it must not fall below.
    /// Values that are not finite are never equal.
    pub fn within(&self, metric: Option<Metric>, tolerance: f64) -> bool {
        let close = match metric {
            None => self.largest.difference <= tolerance,
            Some(Metric::Psnr) => self.psnr.all >= tolerance,
            Some(metric) => self.value(metric).all <= tolerance,
        };
        close && self.non_finite_pixels == [0, 0]
    }
}

/// Sums over the pixels seen so far, per channel.
#[derive(Default)]
struct Sums {
    values: [[f64; 3]; 2],
    squared: [f64; 3],
    relative: [f64; 3],
    absolute: [f64; 3],
    peak: [f64; 3],
    pixels: u64,
}

impl Sums {
    fn add(&mut self, picture: [f64; 3], reference: [f64; 3]) {
        for channel in 0..3 {
            let (a, b) = (picture[channel], reference[channel]);
            let squared = (a - b) * (a - b);
            self.values[0][channel] += a;
            self.values[1][channel] += b;
            self.squared[channel] += squared;
            self.relative[channel] += squared * relative_weight(b);
            self.absolute[channel] += (a - b).abs();
            self.peak[channel] = self.peak[channel].max(b);
        }
        self.pixels += 1;
    }

    /// Not numbers where there is no pixel to compare: nothing would be said of them by 0.
    fn means(&self, sums: [f64; 3]) -> [f64; 3] {
        sums.map(|sum| if self.pixels == 0 { f64::NAN } else { sum / self.pixels as f64 })
    }

    fn metric(&self, sums: [f64; 3]) -> MetricValue {
        let channels = self.means(sums);
        MetricValue { channels, all: channels.iter().sum::<f64>() / 3.0 }
    }

    fn psnr(&self) -> MetricValue {
        let mse = self.metric(self.squared);
        let decibels = |peak: f64, mse: f64| if mse == 0.0 { f64::INFINITY } else { 10.0 * (peak * peak / mse).log10() };
        let channels = std::array::from_fn(|channel| decibels(self.peak[channel], mse.channels[channel]));
        MetricValue { channels, all: decibels(self.peak.into_iter().fold(0.0, f64::max), mse.all) }
    }
}

/// Compares a picture with its reference.
///
/// # Errors
/// Pictures of different sizes.
pub fn compare(picture: &Image, reference: &Image) -> Result<Comparison, SizeMismatch> {
    let sizes = [[picture.width, picture.height], [reference.width, reference.height]];
    if sizes[0] != sizes[1] {
        return Err(SizeMismatch { sizes });
    }
    let mut sums = Sums::default();
    let mut largest = Extreme { difference: 0.0, x: 0, y: 0, channel: 0 };
    let mut different_pixels = 0;
    let mut non_finite_pixels = [0, 0];
    for (index, (a, b)) in picture.pixels.iter().zip(&reference.pixels).enumerate() {
        different_pixels += u64::from(a != b);
        let finite = [a, b].map(|pixel| pixel.iter().all(|value| value.is_finite()));
        for (count, finite) in non_finite_pixels.iter_mut().zip(finite) {
            *count += u64::from(!finite);
        }
        if finite != [true, true] {
            continue;
        }
        let [a, b] = [a, b].map(|pixel| pixel.map(f64::from));
        sums.add(a, b);
        for channel in 0..3 {
            let difference = (a[channel] - b[channel]).abs();
            if difference > largest.difference {
                let [x, y] = [index as u32 % picture.width, index as u32 / picture.width];
                largest = Extreme { difference, x, y, channel };
            }
        }
    }
    Ok(Comparison {
        width: picture.width,
        height: picture.height,
        means: sums.values.map(|values| sums.means(values)),
        mse: sums.metric(sums.squared),
        relmse: sums.metric(sums.relative),
        mae: sums.metric(sums.absolute),
        psnr: sums.psnr(),
        largest,
        different_pixels,
        non_finite_pixels,
    })
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    fn image(pixels: &[[f32; 3]]) -> Image {
        Image { width: pixels.len() as u32, height: 1, pixels: pixels.to_vec() }
    }

    #[test]
    fn of_pixels_that_are_no_numbers_nothing_is_said() {
        let comparison = compare(&image(&[[f32::NAN; 3]; 2]), &image(&[[1.0; 3]; 2])).unwrap();
        for metric in Metric::ALL {
            assert!(comparison.value(metric).all.is_nan(), "{metric:?}");
            assert!(!comparison.within(Some(metric), 1e9));
        }
        assert!(comparison.means[0][0].is_nan() && comparison.non_finite_pixels == [2, 0]);
        // The control: one finite pixel is compared.
        assert_eq!(compare(&image(&[[f32::NAN; 3], [2.0; 3]]), &image(&[[1.0; 3]; 2])).unwrap().mse.all, 1.0);
    }

    #[test]
    fn metrics_are_what_their_formulas_say() {
        // Differences: red 0.5 in one of two pixels, blue 2 in the other.
        let comparison =
            compare(&image(&[[1.5, 0.0, 0.0], [0.0, 0.0, 3.0]]), &image(&[[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])).unwrap();
        assert_relative_eq!(comparison.mse.channels[..], [0.125, 0.0, 2.0][..]);
        assert_relative_eq!(comparison.mse.all, 2.125 / 3.0);
        assert_relative_eq!(comparison.relmse.channels[..], [0.125 / 1.01, 0.0, 2.0 / 1.01][..]);
        assert_relative_eq!(comparison.mae.channels[..], [0.25, 0.0, 1.0][..]);
        assert_relative_eq!(comparison.psnr.channels[2], -10.0 * 2.0_f64.log10());
        assert_relative_eq!(comparison.psnr.all, -10.0 * (2.125_f64 / 3.0).log10());
        assert_eq!(comparison.means, [[0.75, 0.0, 1.5], [0.5, 0.0, 0.5]]);
        assert_eq!(comparison.largest, Extreme { difference: 2.0, x: 1, y: 0, channel: 2 });
        assert_eq!(comparison.different_pixels, 2);
        assert!(comparison.within(None, 2.0) && !comparison.within(None, 1.9));
        assert!(comparison.within(Some(Metric::Mae), 0.5) && !comparison.within(Some(Metric::Mae), 0.4));
        assert!(comparison.within(Some(Metric::Psnr), 1.0) && !comparison.within(Some(Metric::Psnr), 2.0));
    }

    #[test]
    fn equal_pictures_are_equal_and_a_last_bit_is_a_difference() {
        let picture = image(&[[0.3, 0.2, 0.1], [1e-20, 5.0, 0.0]]);
        let comparison = compare(&picture, &picture).unwrap();
        assert!(comparison.within(None, 0.0));
        assert_eq!(comparison.psnr.all, f64::INFINITY);

        let mut other = picture.clone();
        other.pixels[1][1] = 5.0_f32.next_up();
        let comparison = compare(&other, &picture).unwrap();
        assert!(!comparison.within(None, 0.0));
        assert_eq!(comparison.different_pixels, 1);
        assert_eq!((comparison.largest.x, comparison.largest.channel), (1, 1));
    }

    #[test]
    fn values_that_are_not_finite_are_counted_and_never_equal() {
        let picture = image(&[[f32::NAN, 0.0, 0.0], [1.0, f32::INFINITY, 0.0], [2.0; 3]]);
        let comparison = compare(&picture, &picture).unwrap();
        assert_eq!(comparison.non_finite_pixels, [2, 2]);
        assert_eq!(comparison.means[0], [2.0; 3]);
        assert!(!comparison.within(None, f64::INFINITY));
        assert!(!comparison.within(Some(Metric::Mse), f64::INFINITY));
    }

    #[test]
    fn sizes_must_agree() {
        let error = compare(&image(&[[0.0; 3]; 2]), &image(&[[0.0; 3]; 3])).unwrap_err();
        assert_eq!(error.to_string(), "the pictures have different sizes: 2x1 and 3x1");
    }
}
