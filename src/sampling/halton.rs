//! The scrambled Halton sequence (Halton 1960), its bases tied to named dimensions.
//!
//! The sequence is common to all pixels and each pixel shifts it, modulo 1, by a hash of its own (Cranley and Patterson 1976). So a
//! radical inverse depends on the sample index alone: it is computed once per sample on the host, in 32-bit fixed point, and a
//! device adds two words to get its number.

use super::dimension::SEQUENCE_DIMENSIONS;
use super::hash::{dimension_bits, mix};
use super::permutation::permuted;

/// Base of each dimension. The pixel gets 2 and 3; then, vertex by vertex, what matters most gets the smallest primes left.
pub const BASES: [u32; SEQUENCE_DIMENSIONS as usize] = [
    2, 3, 17, 19, 41, 163, 167, 173, // pixel x and y, lens u and v, time, three that nothing uses
    23, 5, 7, 29, 11, 13, 31, 37, // light choice, light u and v, lobe, bsdf u and v, roulette, blend
    67, 43, 47, 71, 53, 59, 73, 61, //
    101, 79, 83, 103, 89, 97, 107, 109, //
    139, 113, 127, 149, 131, 137, 151, 157, //
];

/// The radical inverse of `index` in the base of `dimension`, digits permuted, as a 32-bit fraction. `dimension` is one that a
/// sequence covers.
pub fn radical_inverse_bits(seed: u32, dimension: u32, index: u32) -> u32 {
    permuted_radical_inverse(seed, dimension, BASES[dimension as usize], index)
}

/// The radical inverse of `index` in a base, digits permuted as those of this dimension, as a 32-bit fraction.
///
/// Digit k is permuted by a random permutation keyed by (seed, dimension, k) (random digit scrambling, Matoušek 1998). All digits
/// that a 32-bit fraction can hold are permuted, leading zeros of the index included.
pub fn permuted_radical_inverse(seed: u32, dimension: u32, base: u32, index: u32) -> u32 {
    let base = u64::from(base);
    let mut remaining = u64::from(index);
    let mut fraction: u64 = 0;
    let mut weight: u64 = 1 << 56;
    for digit_index in 0.. {
        weight /= base;
        if weight == 0 {
            break;
        }
        let digit = remaining % base;
        remaining /= base;
        fraction += u64::from(permuted_digit(seed, dimension, digit_index, digit as u32, base as u32)) * weight;
    }
    // 56 fractional bits leave 32 after rounding down.
    ((fraction >> 24) & 0xffff_ffff) as u32
}

fn permuted_digit(seed: u32, dimension: u32, digit_index: u32, digit: u32, base: u32) -> u32 {
    let key = dimension_bits(mix(seed ^ 0x51ed_270b), dimension.wrapping_mul(64).wrapping_add(digit_index));
    permuted(digit, base, key)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_permuted() {
        for (dimension, &base) in BASES.iter().enumerate() {
            for digit_index in 0..4 {
                let mut seen: Vec<u32> = (0..base).map(|d| permuted_digit(9, dimension as u32, digit_index, d, base)).collect();
                seen.sort_unstable();
                assert_eq!(seen, (0..base).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn bases_are_distinct_primes() {
        let mut bases: Vec<u32> = BASES.into();
        assert!(bases.iter().all(|&b| (2..b).all(|d| b % d != 0)));
        let count = bases.len();
        bases.sort_unstable();
        bases.dedup();
        assert_eq!(bases.len(), count);
    }

    /// Every aligned run of bᵏ indices puts exactly one point into each interval [j/bᵏ, (j+1)/bᵏ).
    #[test]
    fn elementary_intervals_hold_one_point_each() {
        for (dimension, &base) in BASES.iter().enumerate().filter(|(_, base)| **base < 50) {
            let count = if base < 8 { base.pow(4) } else { base };
            for first in [0, count * 3] {
                let mut hits = vec![0; count as usize];
                for index in first..first + count {
                    let bits = radical_inverse_bits(4, dimension as u32, index);
                    // The fraction is rounded down at 2⁻³²; half a step up keeps interval borders on their own side.
                    let cell = ((f64::from(bits) + 0.5) / 4_294_967_296.0 * f64::from(count)).floor();
                    hits[cell as usize] += 1;
                }
                assert!(hits.iter().all(|&h| h == 1), "base {base}, first {first}: {hits:?}");
            }
        }
    }
}
