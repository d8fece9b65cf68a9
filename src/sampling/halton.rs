//! The scrambled Halton sequence (Halton 1960), its bases tied to named dimensions.
//!
//! The sequence is common to all pixels and each pixel shifts it, modulo 1, by a hash of its own (Cranley and Patterson 1976). So a
//! radical inverse depends on the sample index alone: it is computed once per sample on the host, in 32-bit fixed point, and a
//! device adds two words to get its number.

use super::dimension::{BOUNCE_DIMENSIONS, CAMERA_DIMENSIONS};
use super::hash::{dimension_bits, mix};

/// Bounces whose dimensions are drawn from the sequence; beyond them every device uses the hashed generator. Higher bases need more
/// samples than people take before they are evener than random numbers.
pub const HALTON_BOUNCES: u32 = 4;
/// Dimensions covered by the sequence, unused ones included.
pub const HALTON_DIMENSIONS: u32 = CAMERA_DIMENSIONS + HALTON_BOUNCES * BOUNCE_DIMENSIONS;

/// Base of each dimension. The pixel gets 2 and 3; then, bounce by bounce, what matters most gets the smallest primes left.
/// 0: the dimension is left to the hashed generator.
pub const BASES: [u32; HALTON_DIMENSIONS as usize] = [
    2, 3, 17, 19, 41, 0, 0, 0, // pixel x and y, lens u and v, time
    23, 5, 7, 29, 11, 13, 31, 37, // light choice, light u and v, lobe, bsdf u and v, roulette, blend
    67, 43, 47, 71, 53, 59, 73, 61, //
    101, 79, 83, 103, 89, 97, 107, 109, //
    139, 113, 127, 149, 131, 137, 151, 157, //
];

/// The radical inverse of `index` in the base of `dimension`, digits permuted, as a 32-bit fraction; 0 where the dimension has no base.
///
/// Digit k is permuted by a random permutation keyed by (seed, dimension, k) (random digit scrambling, Matoušek 1998). All digits
/// that a 32-bit fraction can hold are permuted, leading zeros of the index included.
pub fn radical_inverse_bits(seed: u32, dimension: u32, index: u32) -> u32 {
    let base = BASES.get(dimension as usize).copied().unwrap_or(0);
    if base == 0 {
        return 0;
    }
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

/// A permutation of 0..base by cycle walking on a keyed bijection of the next power of two (Kensler 2013).
fn permuted_digit(seed: u32, dimension: u32, digit_index: u32, digit: u32, base: u32) -> u32 {
    let key = dimension_bits(mix(seed ^ 0x51ed_270b), dimension.wrapping_mul(64).wrapping_add(digit_index));
    let mask = base.next_power_of_two() - 1;
    let mut value = digit;
    loop {
        value = keyed_bijection(value, mask, key);
        if value < base {
            return value;
        }
    }
}

/// A bijection of 0..=mask, mask one less than a power of two: every step is invertible modulo mask + 1.
fn keyed_bijection(mut value: u32, mask: u32, key: u32) -> u32 {
    let bits = mask.count_ones();
    for round in 0..3 {
        let round_key = mix(key.wrapping_add(round));
        value = value.wrapping_add(round_key) & mask;
        value = value.wrapping_mul(round_key | 1) & mask;
        value ^= value >> bits.div_ceil(2).max(1);
        value = (value ^ (round_key >> 16)) & mask;
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_permuted() {
        for (dimension, &base) in BASES.iter().enumerate().filter(|(_, base)| **base > 0) {
            for digit_index in 0..4 {
                let mut seen: Vec<u32> = (0..base).map(|d| permuted_digit(9, dimension as u32, digit_index, d, base)).collect();
                seen.sort_unstable();
                assert_eq!(seen, (0..base).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn bases_are_distinct_primes() {
        let mut bases: Vec<u32> = BASES.into_iter().filter(|&base| base > 0).collect();
        assert!(bases.iter().all(|&b| (2..b).all(|d| b % d != 0)));
        let count = bases.len();
        bases.sort_unstable();
        bases.dedup();
        assert_eq!(bases.len(), count);
    }

    /// Every aligned run of bᵏ indices puts exactly one point into each interval [j/bᵏ, (j+1)/bᵏ).
    #[test]
    fn elementary_intervals_hold_one_point_each() {
        for (dimension, &base) in BASES.iter().enumerate().filter(|(_, base)| **base > 0 && **base < 50) {
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
