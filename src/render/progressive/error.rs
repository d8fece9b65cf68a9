//! How far a picture is from the truth, estimated from independent renderings of it.
//!
//! The picture is the mean of R streams with random numbers of their own, so the variance of their values, over R, is the expected
//! squared error of the mean, whatever correlates the samples inside a stream. Its estimate from few streams is coarse in one pixel
//! and good over all of them.
//!
//! The relative error divides by the truth, which is not known. Where one stream holds a rare bright path, the mean holds it too, and dividing
//! by that would call the pixel's error small. So each stream's deviation is divided by the mean of the *other* streams.
//!
//! All of this is of light that samples have found. What none has found is in no variance, and a bound that is made of variances holds where light is
//! not rare; docs/strategies.md has measurements. Where what was found shows that few paths decide, [`ErrorEstimate::tails_decide`].

use crate::compare::RELATIVE_EPSILON;
use crate::film::Band;
use crate::render::error_estimate::{ErrorEstimate, PixelErrors};
use crate::sampling::hash::mix;

/// Pixels that are looked at, at most; of larger pictures an even sample of them.
const MOST_PIXELS: u64 = 1 << 18;

/// An estimate of the error by the streams, from the pixels that are looked at.
pub struct ErrorEstimator {
    width: u32,
    total_pixels: u64,
    /// Index of each pixel looked at, ascending.
    pixels: Vec<u64>,
    /// Per stream: sums of these pixels' means, each by its number of samples, and of these numbers.
    sums: Vec<Vec<[f64; 4]>>,
    looks: u32,
}

impl ErrorEstimator {
    pub fn new([width, height]: [u32; 2], streams: u32) -> Self {
        let total_pixels = u64::from(width) * u64::from(height);
        let stride = total_pixels.div_ceil(MOST_PIXELS);
        // One pixel of each run of `stride`, at random, so that no pattern of the picture is missed.
        let in_run = |run: u64| run * stride + u64::from(mix(run as u32)) % stride;
        let pixels: Vec<u64> = (0..total_pixels / stride).map(in_run).collect();
        let sums = vec![vec![[0.0; 4]; pixels.len()]; streams as usize];
        Self { width, total_pixels, pixels, sums, looks: 0 }
    }

    /// Goes on from the sums and looks of an earlier render; None where they are of another size.
    pub fn with_sums(mut self, sums: Vec<Vec<[f64; 4]>>, looks: u32) -> Option<Self> {
        let fits = sums.len() == self.sums.len() && sums.iter().all(|sums| sums.len() == self.pixels.len());
        (self.sums, self.looks) = (sums, looks);
        fits.then_some(self)
    }

    /// For each stream, the sums of the pixels that are looked at.
    pub fn sums(&self) -> &[Vec<[f64; 4]>] {
        &self.sums
    }

    /// How often the error was looked at.
    pub fn looks(&self) -> u32 {
        self.looks
    }

    /// Adds a stream's band, of the pixels that took part.
    pub fn add(&mut self, stream: u32, band: &Band, selection: Option<&[bool]>) {
        let weight = f64::from(band.samples);
        let first = u64::from(band.first_row) * u64::from(self.width);
        let start = self.pixels.partition_point(|pixel| *pixel < first);
        let end = self.pixels.partition_point(|pixel| *pixel < first + band.mean.len() as u64);
        let sums = &mut self.sums[stream as usize];
        for (sum, pixel) in sums[start..end].iter_mut().zip(&self.pixels[start..end]) {
            if selection.is_none_or(|selection| selection[*pixel as usize]) {
                let [r, g, b] = band.mean[(pixel - first) as usize].map(f64::from);
                sum.iter_mut().zip([r, g, b, 1.0]).for_each(|(sum, mean)| *sum += weight * mean);
            }
        }
    }

    /// The error of the mean of all streams. Looking again and again makes it likelier that once the estimate is too low by chance, so each
    /// look is more careful than the last.
    pub fn look(&mut self) -> ErrorEstimate {
        self.looks += 1;
        let streams = self.sums.len();
        let mut errors = PixelErrors::default();
        for pixel in 0..self.pixels.len() {
            let (mut squared, mut by_one) = (0.0, 0.0);
            for channel in 0..3 {
                let values = (0..streams).map(|stream| self.sums[stream][pixel][channel] / self.sums[stream][pixel][3]);
                let (of_channel, of_one) = squared_error_of_mean(values);
                squared += of_channel / 3.0;
                by_one += of_one / 3.0;
            }
            errors.add(squared, by_one);
        }
        errors.estimate(self.total_pixels, streams as f64 - 1.0, self.looks)
    }
}

/// Estimated squared relative error of the mean of independent values: their variance over their number, each deviation relative to
/// the mean of the others. And what of it is by the one value that adds most.
fn squared_error_of_mean(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count() as f64;
    let total: f64 = values.clone().sum();
    let mean = total / count;
    let relative = |value: f64| {
        let others = (total - value) / (count - 1.0);
        (value - mean).powi(2) / (others * others + RELATIVE_EPSILON)
    };
    let (sum, largest) = values.map(relative).fold((0.0, 0.0), |(sum, largest): (f64, f64), one| (sum + one, largest.max(one)));
    let scale = 1.0 / (count * (count - 1.0));
    (scale * sum, scale * largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_values_have_no_error_and_a_rare_bright_one_is_not_its_own_excuse() {
        assert!(squared_error_of_mean([0.7; 8].into_iter()).0 < 1e-30);
        let mut values = [1.0; 8];
        values[3] = 101.0;
        // The mean is 13.5: 12.5 too much if the others are right.
        let (error, by_one) = squared_error_of_mean(values.into_iter());
        assert!(error > 100.0 && by_one > 0.95 * error, "{error} {by_one}");
        // Relative to the common mean, the control, it would be below 1.
        let variance = (87.5_f64.powi(2) + 7.0 * 12.5 * 12.5) / 56.0;
        assert!(variance / (13.5 * 13.5) < 1.0);
    }

    /// Bands of a picture larger than what is looked at find their pixels.
    #[test]
    fn pixels_are_an_even_sample() {
        let estimator = ErrorEstimator::new([1024, 1000], 2);
        let stride = 1_024_000_u64.div_ceil(MOST_PIXELS);
        assert!(estimator.pixels.iter().zip(0..).all(|(pixel, run)| pixel / stride == run));
        let mut estimator = ErrorEstimator::new([1024, 1000], 2);
        for stream in 0..2 {
            for first_row in (0..1000).step_by(100) {
                let value = |index: u32| [(first_row * 1024 + index) as f32; 3];
                let mean = (0..102_400).map(value).collect();
                let band = Band { first_row, width: 1024, rows: 100, samples: 2, mean, ..Band::default() };
                estimator.add(stream, &band, None);
            }
        }
        assert!(
            estimator.pixels.iter().zip(&estimator.sums[1]).all(|(pixel, sum)| sum[0] == 2.0 * *pixel as f64 && sum[3] == 2.0)
        );
        assert_eq!(estimator.look().mean, 0.0);
    }
}
