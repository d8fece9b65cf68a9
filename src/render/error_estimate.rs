//! The estimated error of a picture, and what the estimate is worth.

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, Normal};

/// Probability that a picture called good enough is not, over all looks together.
const DOUBT: f64 = 0.05;
/// Tails decide where one stream of each pixel has more than this of the estimate, or fewer pixels than these have it.
const MOST_BY_ONE: f64 = 0.7;
const FEWEST_PIXELS: f64 = 12.0;

/// An estimate of the relative mean squared error of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ErrorEstimate {
    /// Expected relative mean squared error.
    pub mean: f64,
    /// The estimate with a margin for chance: where errors of many pixels add up and light is not rare, the error is below this in 95 % of all renders,
    /// however often one looked.
    pub upper: f64,
    /// The share of the estimate that is, in each pixel, by the one stream or part that is farthest from the mean. Of 8 that vary as a normal distribution
    /// does it is about a half; where a single bright path in one of them makes it, nearly all.
    pub by_one: f64,
    /// The number of equal pixels whose estimate would vary as much as this one does: (Σe)²/Σe² over the pixels' squared errors e.
    pub effective_pixels: f64,
}

/// Sums over the pixels that were looked at.
#[derive(Debug, Clone, Copy, Default)]
pub struct PixelErrors {
    pub count: f64,
    /// The sum of their squared errors, of these squared, and of the part of each that is by the one stream or part that adds most.
    pub squared: f64,
    pub squares: f64,
    pub by_one: f64,
}

impl PixelErrors {
    pub fn add(&mut self, squared: f64, by_one: f64) {
        self.count += 1.0;
        self.squared += squared;
        self.squares += squared * squared;
        self.by_one += by_one;
    }

    /// The mean of the squared errors, with a margin for the `look`-th look at a picture of `total_pixels`; each pixel's error is estimated with so many
    /// degrees of freedom.
    ///
    /// A pixel's squared error is about e·χ²(1), with variance 2e², and its estimate e·χ²(f)/f with 2e²/f. Pixels are independent of each other, because
    /// each has random numbers of its own.
    pub fn estimate(&self, total_pixels: u64, freedom: f64, look: u32) -> ErrorEstimate {
        let Self { count, squared, squares, by_one } = *self;
        let (mean, mean_square) = (squared / count, squares / count);
        let of_error = 2.0 * mean_square / total_pixels as f64;
        let of_estimate = 2.0 * mean_square / (count * freedom);
        let unseen = 1.0 - count / total_pixels as f64;
        let of_choice = unseen * (mean_square - mean * mean).max(0.0) / count;
        let deviation = (of_error + of_estimate + of_choice).sqrt();
        let has_error = squared > 0.0;
        ErrorEstimate {
            mean,
            upper: mean + standard_deviations(look) * deviation,
            by_one: if has_error { by_one / squared } else { 0.0 },
            effective_pixels: if has_error { squared * squared / squares } else { count },
        }
    }
}

/// Standard deviations that make up for the doubt granted to a look: DOUBT / (k (k + 1)) to the k-th, which add up to DOUBT.
fn standard_deviations(look: u32) -> f64 {
    let look = f64::from(look);
    Normal::standard().inverse_cdf(1.0 - DOUBT / (look * (look + 1.0)))
}

impl ErrorEstimate {
    /// True where few bright paths, or few pixels, make most of the estimate. Then it varies by more than its bound allows for, and mostly it is too small.
    pub fn tails_decide(&self) -> bool {
        self.by_one > MOST_BY_ONE || self.effective_pixels < FEWEST_PIXELS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_share_the_doubt() {
        let doubt = |look| 1.0 - Normal::standard().cdf(standard_deviations(look));
        let total: f64 = (1..10_000).map(doubt).sum();
        assert!((total - DOUBT).abs() < 1e-4, "{total}");
    }
}
