//! The estimated error of a picture, and what the estimate is worth.

use serde::{Deserialize, Serialize};

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

impl ErrorEstimate {
    /// Whether few bright paths, or few pixels, make most of the estimate. Then it varies by more than its bound allows for, and mostly it is too small.
    pub fn tails_decide(&self) -> bool {
        self.by_one > MOST_BY_ONE || self.effective_pixels < FEWEST_PIXELS
    }
}
