//! How far a picture is from the truth, estimated from what its parts differ by.
//!
//! With m of n samples of a pixel, a part's mean has the variance σ²/m if parts are independent; then Σ m (x − x̄)² / (K − 1) over K parts is
//! an estimate of σ², and σ²/n the squared error of the mean of all. Parts of one low-discrepancy sequence complete each other, so the truth is
//! rather better.
//!
//! Errors are relative to the joint mean of all parts. The mean of the other parts, by which streams of one render are measured
//! ([`crate::render::progressive::error`]), is no measure here: a short part beside a long one has others that are few and noisy, and where they are dark
//! by chance the quotient is anything.

use crate::compare::RELATIVE_EPSILON;
use crate::render::error_estimate::{ErrorEstimate, PixelErrors};
use crate::sampling::hash::mix;

/// Values of pixels that are kept, at most: parts times pixels.
const MOST_VALUES: u64 = 1 << 21;
const MOST_PIXELS: u64 = 1 << 18;

/// The estimate of the error by the parts, from the pixels that are looked at.
pub struct PartsError {
    total_pixels: u64,
    /// Index of each pixel looked at, ascending, and its value and number of samples in each part that has it.
    pixels: Vec<u64>,
    values: Vec<Vec<([f32; 3], f32)>>,
}

impl PartsError {
    /// An estimate for a picture of so many pixels, and at most so many parts of each.
    pub fn new(total_pixels: u64, parts: usize) -> Self {
        let most = (MOST_VALUES / (parts as u64).max(1)).clamp(1, MOST_PIXELS);
        let stride = total_pixels.div_ceil(most).max(1);
        // One pixel of each run of `stride`, at random, so that no pattern of the picture is missed.
        let in_run = |run: u64| run * stride + u64::from(mix(run as u32)) % stride;
        let pixels: Vec<u64> = (0..total_pixels / stride).map(in_run).collect();
        let values = vec![Vec::new(); pixels.len()];
        Self { total_pixels, pixels, values }
    }

    /// Adds a run of a part's pixels, the first of which is pixel `first` of the picture.
    pub fn add(&mut self, first: u64, values: impl Fn(usize) -> ([f32; 3], f32), count: usize) {
        let start = self.pixels.partition_point(|pixel| *pixel < first);
        let end = self.pixels.partition_point(|pixel| *pixel < first + count as u64);
        for index in start..end {
            self.values[index].push(values((self.pixels[index] - first) as usize));
        }
    }

    /// The relative mean squared error of the mean of all parts; None where too few pixels are in several parts.
    pub fn estimate(&self) -> Option<ErrorEstimate> {
        let found: Vec<PixelError> = self.values.iter().filter_map(|values| squared_error(values)).collect();
        if found.is_empty() || found.len() * 2 < self.pixels.len() {
            return None;
        }
        let mut errors = PixelErrors::default();
        found.iter().for_each(|error| errors.add(error.squared, error.by_one));
        let freedom = found.iter().map(|error| error.freedom).sum::<f64>() / errors.count;
        Some(errors.estimate(self.total_pixels, freedom, 1))
    }
}

/// The parts' evidence on a pixel.
struct PixelError {
    /// Estimated squared relative error of its mean, averaged over the channels.
    squared: f64,
    /// Its share by the part that adds most.
    by_one: f64,
    /// Degrees of freedom.
    freedom: f64,
}

fn squared_error(values: &[([f32; 3], f32)]) -> Option<PixelError> {
    let freedom = values.len().checked_sub(1).filter(|freedom| *freedom > 0)? as f64;
    let samples: f64 = values.iter().map(|(_, count)| f64::from(*count)).sum();
    let (mut squared, mut by_one) = (0.0, 0.0);
    for channel in 0..3 {
        let total: f64 = values.iter().map(|(mean, count)| f64::from(mean[channel]) * f64::from(*count)).sum();
        let mean = total / samples;
        let of_part = |(value, count): &([f32; 3], f32)| f64::from(*count) * (f64::from(value[channel]) - mean).powi(2);
        let scale = 1.0 / ((mean * mean + RELATIVE_EPSILON) * freedom * samples * 3.0);
        squared += scale * values.iter().map(of_part).sum::<f64>();
        by_one += scale * values.iter().map(of_part).fold(0.0, f64::max);
    }
    Some(PixelError { squared, by_one, freedom })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number between 0 and 1.
    fn uniform(index: u32) -> f32 {
        mix(index) as f32 / u32::MAX as f32
    }

    /// The values have a known error, in parts of equal and of different lengths.
    #[test]
    fn the_error_of_known_values_is_found() {
        // Samples are uniform in [0, 2]: the mean is 1, the variance 1/3.
        for lengths in [vec![16; 8], vec![4, 12, 16, 32, 64]] {
            let samples: u32 = lengths.iter().sum();
            let mut error = PartsError::new(4096, lengths.len());
            let mut first = 0;
            for (part, length) in lengths.iter().enumerate() {
                let value = |pixel: usize| {
                    let sample = |s: u32| 2.0 * uniform((pixel as u32 * samples + first + s) * 7 + part as u32);
                    ([(0..*length).map(sample).sum::<f32>() / *length as f32; 3], *length as f32)
                };
                error.add(0, value, 4096);
                first += length;
            }
            let estimate = error.estimate().expect("there are several parts");
            let truth = 1.0 / 3.0 / f64::from(samples);
            assert!((estimate.mean / truth - 1.0).abs() < 0.25, "{} instead of {truth}", estimate.mean);
            assert!(estimate.upper > estimate.mean);
        }
        let mut single = PartsError::new(16, 1);
        single.add(0, |_| ([1.0; 3], 4.0), 16);
        assert!(single.estimate().is_none(), "one part says nothing of its error");
    }

    /// A long part beside a short one whose only sample is dark in most pixels, as where light is rare: the error is that of the long part.
    #[test]
    fn a_short_dark_part_does_not_make_the_error_large() {
        let (long, short) = (255.0, 1.0);
        let mut error = PartsError::new(4096, 2);
        // One of 64 samples brings 64: the mean is 1, the variance 63.
        let sample = |index: u32| if mix(index).is_multiple_of(64) { 64.0_f32 } else { 0.0 };
        let mean_of_long = |pixel: usize| (0..255).map(|s| sample(pixel as u32 * 256 + s)).sum::<f32>() / 255.0;
        error.add(0, |pixel| ([mean_of_long(pixel); 3], long), 4096);
        error.add(0, |pixel| ([sample(pixel as u32 * 256 + 255); 3], short), 4096);
        let estimate = error.estimate().expect("there are two parts");
        let truth = 63.0 / 256.0;
        assert!((0.3..3.0).contains(&(estimate.mean / truth)), "{} instead of {truth}", estimate.mean);
        // Relative to the other part, the control, the long one's share alone would be far more.
        let relative_to_other = |pixel: usize| {
            let (a, b) = (f64::from(mean_of_long(pixel)), f64::from(sample(pixel as u32 * 256 + 255)));
            let mean = (255.0 * a + b) / 256.0;
            255.0 * (a - mean).powi(2) / (b * b + RELATIVE_EPSILON) / 256.0
        };
        let control = (0..4096).map(relative_to_other).sum::<f64>() / 4096.0;
        assert!(control > 0.0 && (estimate.mean - truth).abs() < (control - truth).abs(), "{control}");
    }
}
