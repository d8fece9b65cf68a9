//! Where samples go: in proportion to each pixel's noise.
//!
//! With nₚ samples in pixel p, the relative mean squared error is Σ vₚ / (nₚ (μₚ² + ε)), v the variance of a sample. For a given number of
//! samples it is least where nₚ is in proportion to √(vₚ / (μₚ² + ε)).

use crate::compare::RELATIVE_EPSILON;
use crate::render::Allocation;

/// Variances of neighbours up to this far are averaged: a few samples tell little of their pixel alone.
const RADIUS: usize = 2;
/// Steps in which the scale is found; the noise spans less than 2⁶⁴.
const BISECTIONS: u32 = 40;

/// Distributes `share` samples per pixel on average, in powers of two, by a picture's mean radiance and mean squared luminance.
pub fn allocate(size: [u32; 2], mean: &[[f32; 3]], second_moment: &[f32], share: u32) -> Allocation {
    let luminances: Vec<f64> = mean.iter().map(|rgb| luminance(*rgb)).collect();
    let variances: Vec<f64> =
        luminances.iter().zip(second_moment).map(|(mean, square)| (f64::from(*square) - mean * mean).max(0.0)).collect();
    let [width, height] = size.map(|side| side as usize);
    let luminances = blurred(&luminances, width, height);
    let variances = blurred(&variances, width, height);
    // Binary logarithm of the wish; minus infinity where nothing is noisy.
    let wishes: Vec<f64> = variances
        .iter()
        .zip(&luminances)
        .map(|(variance, mean)| 0.5 * (variance / (mean * mean + RELATIVE_EPSILON)).log2())
        .collect();
    let scale = scale_for(&wishes, f64::from(share));
    Allocation { levels: wishes.iter().map(|wish| level(wish + scale)).collect() }
}

fn level(wish: f64) -> u8 {
    // A wish of minus infinity, or none at all, is level 0.
    wish.round().clamp(0.0, f64::from(Allocation::LEVELS - 1)) as u8
}

/// What is to be added to all wishes so that levels bring `share` samples on average, as nearly as powers of two can.
fn scale_for(wishes: &[f64], share: f64) -> f64 {
    let average = |scale: f64| {
        let samples: u64 = wishes.iter().map(|wish| 1_u64 << level(wish + scale)).sum();
        samples as f64 / wishes.len() as f64
    };
    let (mut low, mut high) = (-64.0, 64.0);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if average(middle) > share {
            high = middle;
        } else {
            low = middle;
        }
    }
    low
}

fn luminance([r, g, b]: [f32; 3]) -> f64 {
    0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
}

/// Means over squares of pixels, cut off at the picture's edges.
fn blurred(values: &[f64], width: usize, height: usize) -> Vec<f64> {
    let window = |at: usize, end: usize| at.saturating_sub(RADIUS)..(at + RADIUS + 1).min(end);
    let along_rows: Vec<f64> = (0..values.len())
        .map(|index| {
            let (x, row) = (index % width, index / width * width);
            let near = &values[row + window(x, width).start..row + window(x, width).end];
            near.iter().sum::<f64>() / near.len() as f64
        })
        .collect();
    let in_column = |index: usize| {
        let (x, rows) = (index % width, window(index / width, height));
        let count = rows.len() as f64;
        rows.map(|y| along_rows[y * width + x]).sum::<f64>() / count
    };
    (0..values.len()).map(in_column).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Left half calm, right half with 16 times the relative deviation.
    fn halves() -> Allocation {
        let pixel = |index: usize| if index % 32 < 16 { (1.0, 1.0 + 0.01) } else { (1.0, 1.0 + 2.56) };
        let mean: Vec<[f32; 3]> = (0..1024).map(|index| [pixel(index).0; 3]).collect();
        let squares: Vec<f32> = (0..1024).map(|index| pixel(index).1).collect();
        allocate([32, 32], &mean, &squares, 9)
    }

    #[test]
    fn samples_follow_the_relative_deviation() {
        let levels = halves().levels;
        assert_eq!(levels[0], 0);
        assert_eq!(levels[31] - levels[0], 4, "sixteen times the deviation, sixteen times the samples");
        let average = levels.iter().map(|level| f64::from(1 << level)).sum::<f64>() / 1024.0;
        assert!(average <= 9.0 && average > 7.0, "{average}");
    }

    #[test]
    fn a_picture_without_noise_takes_the_least() {
        let levels = allocate([4, 4], &[[0.5; 3]; 16], &[0.25; 16], 8).levels;
        assert!(levels.iter().all(|level| *level <= 3), "{levels:?}");
        let dark = allocate([4, 4], &[[0.0; 3]; 16], &[0.0; 16], 8).levels;
        assert_eq!(dark, [0; 16]);
    }
}
