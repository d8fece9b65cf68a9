//! Permutations as pure functions of a key: no table, any element at any time.

use super::hash::{dimension_bits, mix};

/// The place to which a permutation of 0..`length` takes `value`: cycle walking on a keyed bijection of the
/// next power of two (Kensler 2013).
/// `value` is below `length`, and `length` at most 2³¹.
pub fn permuted(value: u32, length: u32, key: u32) -> u32 {
    let mask = length.next_power_of_two() - 1;
    let mut walked = value;
    loop {
        walked = keyed_bijection(walked, mask, key);
        if walked < length {
            return walked;
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

/// Owen's (1995) nested scrambling of binary digits: a digit is flipped by a random bit that depends on all digits above it.
/// So numbers that share their upper n digits still do, and every 2ᵏ numbers that differ in their lower k digits alone trade places.
pub fn nested_scramble(value: u32, key: u32) -> u32 {
    let mut flips = 0;
    for bit in 0..u32::BITS {
        // The digits above, behind a one that tells how many they are.
        let prefix = (1 << bit) | value.checked_shr(u32::BITS - bit).unwrap_or(0);
        flips = flips << 1 | dimension_bits(key, prefix) >> 31;
    }
    value ^ flips
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_length_is_permuted() {
        for length in [1, 2, 3, 5, 16, 37, 100, 1000] {
            for key in 0..8 {
                let mut images: Vec<u32> = (0..length).map(|value| permuted(value, length, key)).collect();
                images.sort_unstable();
                assert_eq!(images, (0..length).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn nested_scrambling_keeps_what_numbers_share() {
        for (a, b) in [(0x1234_5678_u32, 0x1234_0000_u32), (0, 1), (u32::MAX, 0x7fff_ffff), (0xff00_0000, 0xff80_0000)] {
            for key in 0..50 {
                let shared = (a ^ b).leading_zeros();
                assert_eq!((nested_scramble(a, key) ^ nested_scramble(b, key)).leading_zeros(), shared);
            }
        }
    }
}
