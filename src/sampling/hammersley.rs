//! The scrambled Hammersley set (Hammersley 1960): points of Halton's sequence, as many as there are samples, beside their numbers.
//!
//! The number of a point, over that of all, takes the place of the dimension that matters most, the pixel's x; so every other one has
//! the next smaller base. The points are taken in a random order, so that the first of them are a fair part of the set.

use super::halton::{BASES, permuted_radical_inverse};
use super::hash::mix;
use super::permutation::permuted;

/// A coordinate of `sample` in a set of `samples` points, as a 32-bit fraction. The samples after those are another set, scrambled
/// anew. `samples` is at least 1 and at most 2³¹.
pub fn hammersley_bits(seed: u32, samples: u32, dimension: u32, sample: u32) -> u32 {
    let (round, index) = (sample / samples, sample % samples);
    let key = mix(seed ^ mix(round ^ 0x7a3d_19c5));
    let index = permuted(index, samples, key);
    match base(dimension) {
        Some(base) => permuted_radical_inverse(key, dimension, base, index),
        None => ((u64::from(index) << 32) / u64::from(samples)) as u32,
    }
}

/// The base of a dimension; none of the one that is the point's number.
fn base(dimension: u32) -> Option<u32> {
    let own = BASES[dimension as usize];
    BASES.into_iter().filter(|base| *base < own).max()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every elementary interval of a set of 2ᵏ points that is as large as one point's share holds one point, in every set.
    #[test]
    fn the_pixels_coordinates_fill_elementary_intervals() {
        let (k, samples) = (6, 64);
        for round in [0, 3] {
            for split in 0..=k {
                let mut counts = vec![0; samples as usize];
                for sample in round * samples..(round + 1) * samples {
                    let [x, y] = [0, 1].map(|d| u64::from(hammersley_bits(5, samples, d, sample)));
                    counts[((x >> (32 - split) << (k - split)) + (y >> (32 - (k - split)))) as usize] += 1;
                }
                assert!(counts.iter().all(|&count| count == 1), "round {round}, 2^{split}: {counts:?}");
            }
        }
    }

    #[test]
    fn bases_are_those_of_halton_but_the_largest() {
        let mut bases: Vec<u32> = (0..BASES.len() as u32).filter_map(base).collect();
        bases.sort_unstable();
        let mut halton = Vec::from(BASES);
        halton.sort_unstable();
        assert_eq!(bases, halton[..halton.len() - 1]);
        assert_eq!([0, 1].map(base), [None, Some(2)]);
    }
}
