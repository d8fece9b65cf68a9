//! How far two pictures are apart at least, by the intervals that they state.

use serde::Serialize;

/// The intervals that a picture states.
#[derive(Debug, Clone)]
pub struct StatedIntervals {
    /// The low and the high end of the picture's mean.
    pub mean: [[f64; 3]; 2],
    /// The low and the high ends of all pixels.
    pub pixels: Option<[Vec<[f32; 3]>; 2]>,
    /// The probability that the first holds, and that all of the second do.
    pub confidence: f64,
}

impl StatedIntervals {
    /// The ends of a picture that is taken as the truth.
    pub fn exact(pixels: &[[f32; 3]]) -> Self {
        let count = pixels.len().max(1) as f64;
        let mean = std::array::from_fn(|channel| pixels.iter().map(|pixel| f64::from(pixel[channel])).sum::<f64>() / count);
        Self { mean: [mean; 2], pixels: Some([pixels.to_vec(), pixels.to_vec()]), confidence: 1.0 }
    }
}

/// The differences that are sure. What is said of the mean holds with the stated probability, and so does all that is said of the pixels.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SureDifference {
    pub confidence: f64,
    /// The least by which the means of the pictures differ, channel by channel: above 0 where the first is brighter, below 0 where it is darker.
    pub means: [f64; 3],
    /// The largest of them, as a share of the most that the second picture's mean can be.
    pub relative: f64,
    /// Pixels whose intervals have no value in common in some channel; None where a picture states none of pixels.
    pub pixels: Option<usize>,
    /// The pixel and channel in which the pictures are farthest apart, if there is any.
    pub largest: Option<LargestSure>,
}

/// The largest of all differences of pixels that are sure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LargestSure {
    pub x: u32,
    pub y: u32,
    pub channel: usize,
    /// The least by which the pictures differ there, above 0 where the first is brighter.
    pub at_least: f64,
}

/// The least by which values between these ends differ: above 0 where the first is more. 0 where they may be equal.
fn at_least(first: [f64; 2], second: [f64; 2]) -> f64 {
    let [more, less] = [first[0] - second[1], second[0] - first[1]];
    if more > 0.0 {
        more
    } else if less > 0.0 {
        -less
    } else {
        0.0
    }
}

/// Holds the intervals of two pictures of this width, and of one size, against each other.
pub fn sure_difference(width: u32, first: &StatedIntervals, second: &StatedIntervals) -> SureDifference {
    let ends = |mean: &[[f64; 3]; 2], channel: usize| [mean[0][channel], mean[1][channel]];
    let means: [f64; 3] = std::array::from_fn(|channel| at_least(ends(&first.mean, channel), ends(&second.mean, channel)));
    let relative = |channel: usize| if means[channel] == 0.0 { 0.0 } else { means[channel].abs() / second.mean[1][channel] };
    let (pixels, largest) = match (&first.pixels, &second.pixels) {
        (Some(first), Some(second)) => {
            let (count, largest) = sure_pixels(width, first, second);
            (Some(count), largest)
        }
        _ => (None, None),
    };
    let confidence = (first.confidence + second.confidence - 1.0).max(0.0);
    SureDifference { confidence, means, relative: (0..3).map(relative).fold(0.0, f64::max), pixels, largest }
}

fn sure_pixels(width: u32, first: &[Vec<[f32; 3]>; 2], second: &[Vec<[f32; 3]>; 2]) -> (usize, Option<LargestSure>) {
    let ends = |of: &[Vec<[f32; 3]>; 2], pixel: usize, channel: usize| [0, 1].map(|end| f64::from(of[end][pixel][channel]));
    let (mut count, mut largest): (usize, Option<LargestSure>) = (0, None);
    for pixel in 0..first[0].len() {
        let found = [0, 1, 2].map(|channel| at_least(ends(first, pixel, channel), ends(second, pixel, channel)));
        count += usize::from(found.iter().any(|found| *found != 0.0));
        for (channel, at_least) in found.into_iter().enumerate() {
            if at_least.abs() > largest.map_or(0.0, |largest| largest.at_least.abs()) {
                let [x, y] = [pixel as u32 % width, pixel as u32 / width];
                largest = Some(LargestSure { x, y, channel, at_least });
            }
        }
    }
    (count, largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_that_are_apart_differ_by_what_lies_between_them() {
        let of = |mean: [f64; 2], low: [[f32; 3]; 2], high: [[f32; 3]; 2], confidence: f64| StatedIntervals {
            mean: mean.map(|end| [end; 3]),
            pixels: Some([low.to_vec(), high.to_vec()]),
            confidence,
        };
        let first = of([1.5, 2.0], [[1.0; 3], [2.0; 3]], [[1.5; 3], [2.5; 3]], 0.99);
        let second = of([2.5, 4.0], [[1.25; 3], [3.0, 2.0, 1.0]], [[2.0; 3], [4.0, 2.25, 1.75]], 0.95);
        let found = sure_difference(2, &first, &second);
        assert_eq!((found.pixels, (found.confidence * 100.0).round()), (Some(1), 94.0));
        assert_eq!(found.largest, Some(LargestSure { x: 1, y: 0, channel: 0, at_least: -0.5 }));
        assert_eq!((found.means, found.relative), ([-0.5; 3], 0.125));
        let same = sure_difference(2, &first, &first.clone());
        assert_eq!((same.pixels, same.largest, same.means), (Some(0), None, [0.0; 3]));
        let truth = StatedIntervals::exact(&[[1.0; 3], [3.0; 3]]);
        let against_truth = sure_difference(2, &first, &truth);
        assert_eq!((against_truth.largest.map(|found| found.at_least), against_truth.means), (Some(-0.5), [0.0; 3]));
        let of_mean_alone = StatedIntervals { pixels: None, ..first };
        assert_eq!(sure_difference(2, &of_mean_alone, &second).pixels, None);
    }
}
