//! Where samples go: half of them everywhere alike, half in proportion to each pixel's noise.
//!
//! With nₚ samples in pixel p, the relative mean squared error is Σ vₚ / (nₚ (μₚ² + ε)), v the variance of a sample. For a given number of
//! samples it is least where nₚ is in proportion to √(vₚ / (μₚ² + ε)). That is, if v were known. Where few samples hold most of the
//! light, a pixel that has not met one yet looks calm, and with few samples it would suffer most from the first: hence the
//! half that goes everywhere, by which no pixel's error is more than twice what it would have been (BENCHMARKS.md).

use crate::compare::RELATIVE_EPSILON;
use crate::render::Allocation;

/// Variances of neighbours up to this far are averaged: a few samples tell little of their pixel alone.
const RADIUS: usize = 2;
/// The scale is between two to the power of this and its inverse, and found in so many steps.
const LARGEST_EXPONENT: f64 = 64.0;
const BISECTIONS: u32 = 40;

/// Distributes `share` samples per pixel on average, in powers of two, by a picture's mean radiance and mean squared luminance.
pub fn allocate(size: [u32; 2], mean: &[[f32; 3]], second_moment: &[f32], share: u32) -> Allocation {
    let luminances: Vec<f64> = mean.iter().map(|rgb| luminance(*rgb)).collect();
    let variances: Vec<f64> =
        luminances.iter().zip(second_moment).map(|(mean, square)| (f64::from(*square) - mean * mean).max(0.0)).collect();
    let [width, height] = size.map(|side| side as usize);
    let luminances = blurred(&luminances, width, height);
    let variances = blurred(&variances, width, height);
    let noises: Vec<f64> =
        variances.iter().zip(&luminances).map(|(variance, mean)| (variance / (mean * mean + RELATIVE_EPSILON)).sqrt()).collect();
    let everywhere = 0.5 * f64::from(share);
    let scale = scale_for(&noises, everywhere, f64::from(share));
    Allocation { levels: noises.iter().map(|noise| level(everywhere + scale * noise)).collect() }
}

/// The power of two next to a number of samples.
fn level(samples: f64) -> u8 {
    samples.log2().round().clamp(0.0, f64::from(Allocation::LEVELS - 1)) as u8
}

/// What noise is to be multiplied by so that `share` samples are spent on average, as nearly as powers of two can.
fn scale_for(noises: &[f64], everywhere: f64, share: f64) -> f64 {
    let average = |scale: f64| {
        let samples: u64 = noises.iter().map(|noise| 1_u64 << level(everywhere + scale * noise)).sum();
        samples as f64 / noises.len() as f64
    };
    let (mut low, mut high) = (-LARGEST_EXPONENT, LARGEST_EXPONENT);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if average(middle.exp2()) > share {
            high = middle;
        } else {
            low = middle;
        }
    }
    low.exp2()
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

    /// The relative deviation doubles every fourth column.
    fn ramp() -> Vec<u8> {
        let variance = |index: usize| 1e-4 * ((index % 64) as f32 / 2.0).exp2();
        let squares: Vec<f32> = (0..64 * 32).map(|index| 1.0 + variance(index)).collect();
        allocate([64, 32], &vec![[1.0; 3]; 64 * 32], &squares, 2).levels
    }

    #[test]
    fn samples_follow_the_relative_deviation() {
        let levels = ramp();
        assert_eq!(levels[0], 0, "half of what a pixel has on average");
        let row = &levels[64..128];
        assert!(row.windows(2).all(|pair| pair[0] <= pair[1]), "{row:?}");
        // Far above what goes everywhere, and away from the edge, twice the deviation is twice the samples.
        assert_eq!(row[60] - row[56], 1, "{row:?}");
        assert_eq!(row[60] - row[52], 2, "{row:?}");
        let average = levels.iter().map(|level| f64::from(1 << level)).sum::<f64>() / levels.len() as f64;
        assert!((1.8..=2.0).contains(&average), "{average}");
    }

    #[test]
    fn a_picture_without_noise_has_nothing_to_follow() {
        assert_eq!(allocate([4, 4], &[[0.5; 3]; 16], &[0.25; 16], 2).levels, [0; 16]);
        assert_eq!(allocate([4, 4], &[[0.0; 3]; 16], &[0.0; 16], 2).levels, [0; 16]);
    }
}
