//! The hashed generator: counters in, 32 uniform bits out.

/// A bijective mix of 32 bits with low bias (constants found by Wellons' hash-prospector, "lowbias32" improved by TheIronBorn).
pub fn mix(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x21f0_aaad);
    x ^= x >> 15;
    x = x.wrapping_mul(0xd35a_2d97);
    x ^ (x >> 15)
}

/// Odd constant near 2³²/φ: successive multiples are spread evenly over the 32-bit words.
pub const GOLDEN: u32 = 0x9e37_79b9;

/// Key of everything random in one pixel. `pixel` is the index y·width + x over the whole film.
pub fn pixel_key(seed: u32, pixel: u32) -> u32 {
    mix(mix(pixel.wrapping_mul(GOLDEN)).wrapping_add(mix(seed ^ 0x2545_f491)))
}

/// Key of one path: for a given pixel, different samples have different keys.
pub fn path_key(pixel_key: u32, sample: u32) -> u32 {
    mix(pixel_key ^ mix(sample.wrapping_add(0x6a09_e667)))
}

/// The bits of one dimension under a key.
pub fn dimension_bits(key: u32, dimension: u32) -> u32 {
    mix(key.wrapping_add(GOLDEN.wrapping_mul(dimension.wrapping_add(1))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mix_is_a_bijection_on_a_sample_of_words() {
        let mut images: Vec<u32> = (0..1 << 18).map(|i: u32| mix(i.wrapping_mul(16_411))).collect();
        images.sort_unstable();
        images.dedup();
        assert_eq!(images.len(), 1 << 18);
    }

    #[test]
    fn every_input_bit_flips_about_half_of_the_output_bits() {
        for bit in 0..32 {
            let flipped: u32 = (0..4096).map(|i| (dimension_bits(i, 3) ^ dimension_bits(i ^ (1 << bit), 3)).count_ones()).sum();
            let mean = f64::from(flipped) / 4096.0;
            // 4096 draws of a binomial(32, 1/2): standard error of the mean 0.044.
            assert!((mean - 16.0).abs() < 0.5, "bit {bit}: {mean}");
        }
    }

    #[test]
    fn known_values_hold_so_that_pictures_stay_the_same_between_versions() {
        assert_eq!([mix(0), mix(1), mix(2)], [0, 0x06d3_fa73, 0x0da7_f4e7]);
        assert_eq!([pixel_key(0, 0), pixel_key(1, 12345)], [0x361a_0c78, 0x7615_777d]);
        assert_eq!(path_key(pixel_key(1, 12345), 7), 0x5bd5_e54c);
        assert_ne!(pixel_key(0, 0), pixel_key(1, 0));
        assert_ne!(path_key(7, 0), path_key(7, 1));
    }
}
