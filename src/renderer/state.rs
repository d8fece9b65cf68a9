//! How far a batch is: what a renderer needs to go on from there, on this device or on another.

use std::ops::Range;
use std::sync::Arc;

use crate::film::{count_in, count_word};

/// Most samples per pixel of one iteration. An iteration that one device began, another ends.
pub const MOST_SAMPLES_PER_ITERATION: u32 = 64;

/// A batch that is not over. Rows above `rows` are finished and were handed over; rows below have no samples.
#[derive(Debug, Clone, PartialEq)]
pub struct BatchState {
    /// Rows of the picture that are in the making.
    pub rows: Range<u32>,
    /// Samples per pixel of the iterations that are over, of the batch's.
    pub done: u32,
    /// Samples per pixel of the iteration under way; 0 where none is.
    pub iteration: u32,
    /// So many pixels of these rows, from the first, whether they take part or not, have the samples of the iteration under way.
    pub reached: u32,
    /// The sums of these rows; empty where they have no samples.
    pub film: Arc<FilmState>,
    pub tally: Tally,
}

impl BatchState {
    /// The state of a batch that is between two bands, or not begun: these rows have no samples yet.
    pub fn before(rows: Range<u32>, tally: Tally) -> Self {
        Self { rows, done: 0, iteration: 0, reached: 0, film: Arc::new(FilmState::empty()), tally }
    }
}

/// Parts of the radiance that the setting `clamp` allows, in which luminance is counted that it takes.
pub const CLAMP_UNITS: f64 = 1024.0;
/// The most luminance that is counted of one pixel in one pass, in these parts.
pub const MOST_CLAMP_UNITS: f64 = 4e9;

/// Counts since the batch began.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    pub rays: u64,
    /// Finished samples, over all pixels.
    pub samples: u64,
    pub non_finite_samples: u64,
    /// Samples that were brighter than the setting `clamp` allows.
    pub clamped_samples: u64,
    /// The luminance that was taken from them, in [`CLAMP_UNITS`] of the radiance that is allowed.
    pub clamped_units: u64,
}

/// Sums over the samples of each pixel, row by row.
#[derive(Debug, Clone, PartialEq)]
pub enum FilmState {
    /// The sums of a graphics device: (radiance, [number of samples](crate::film::count_word)), and (what the radiance's rounding lost, squared luminance).
    Single { sums: Vec<[f32; 4]>, compensations: Vec<[f32; 4]> },
    /// The sums of the CPU reference: (radiance, squared luminance), and numbers of samples.
    Double { sums: Vec<[f64; 4]>, samples: Vec<u32> },
}

/// Sums of a pixel as a graphics device has them: its half of the film, and what its rounding lost.
pub type SinglePixel = ([f32; 4], [f32; 4]);

impl FilmState {
    /// The sums of rows without samples.
    pub fn empty() -> Self {
        Self::Double { sums: Vec::new(), samples: Vec::new() }
    }

    /// Pixels that it has sums of.
    pub fn len(&self) -> usize {
        match self {
            Self::Single { sums, .. } => sums.len(),
            Self::Double { sums, .. } => sums.len(),
        }
    }

    /// True if it has sums of no pixel.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A pixel's sums in single precision. Those of the CPU reference are rounded to 48 bits.
    pub fn single(&self, pixel: usize) -> SinglePixel {
        match self {
            Self::Single { sums, compensations } => (sums[pixel], compensations[pixel]),
            Self::Double { sums, samples } => {
                let [r, g, b, squares] = sums[pixel];
                let radiance = [r, g, b];
                let [high_r, high_g, high_b] = radiance.map(|sum| sum as f32);
                let [low_r, low_g, low_b] = radiance.map(|sum| (f64::from(sum as f32) - sum) as f32);
                ([high_r, high_g, high_b, count_word(samples[pixel])], [low_r, low_g, low_b, squares as f32])
            }
        }
    }

    /// A pixel's sums in double precision, and its number of samples.
    pub fn double(&self, pixel: usize) -> ([f64; 4], u32) {
        match self {
            Self::Double { sums, samples } => (sums[pixel], samples[pixel]),
            Self::Single { sums, compensations } => {
                let ([r, g, b, count], [lost_r, lost_g, lost_b, squares]) = (sums[pixel], compensations[pixel]);
                // The true sum is the stored one less what its compensation still owes.
                let sum = [(r, lost_r), (g, lost_g), (b, lost_b)].map(|(sum, lost)| f64::from(sum) - f64::from(lost));
                ([sum[0], sum[1], sum[2], f64::from(squares)], count_in(count))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_survive_a_change_of_device() {
        let sums = vec![[1.0 / 3.0, 1e-7, 12_345.678_901_234, 9.0]];
        let double = FilmState::Double { sums: sums.clone(), samples: vec![77] };
        let (sum, compensation) = double.single(0);
        let single = FilmState::Single { sums: vec![sum], compensations: vec![compensation] };
        let (back, samples) = single.double(0);
        assert_eq!(samples, 77);
        for (back, sum) in back.iter().zip(&sums[0]) {
            assert!((back / sum - 1.0).abs() < 1e-14, "{back} {sum}");
        }
        // The control: without what rounding lost, digits are missing.
        assert!((f64::from(sum[0]) * 3.0 - 1.0).abs() > 1e-9);
        assert_eq!(single.single(0), (sum, compensation));
        assert!(FilmState::empty().is_empty() && !single.is_empty());
    }
}
