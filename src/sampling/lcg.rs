//! A linear congruential generator (Lehmer 1949), x ← a·x + c mod 2³², for comparison with hashed numbers.
//!
//! Each path has a stream of its own, which starts at the path's key; its dimensions are the stream's successive numbers, reached by
//! jumps. Constants by Knuth and Lewis (Press et al. 1992, section 7.1). `shaders/core/lcg.wgsl` is the device's half.

const MULTIPLIER: u32 = 1_664_525;
const INCREMENT: u32 = 1_013_904_223;

/// Number `number`, from 0, of the stream that starts at `key`: one step more.
pub fn lcg_bits(key: u32, number: u32) -> u32 {
    step(jumped(key, number))
}

fn step(x: u32) -> u32 {
    MULTIPLIER.wrapping_mul(x).wrapping_add(INCREMENT)
}

/// The state after so many steps, by squaring the step (Brown 1994).
fn jumped(mut x: u32, mut steps: u32) -> u32 {
    let (mut multiplier, mut increment) = (MULTIPLIER, INCREMENT);
    while steps > 0 {
        if steps & 1 == 1 {
            x = multiplier.wrapping_mul(x).wrapping_add(increment);
        }
        increment = multiplier.wrapping_add(1).wrapping_mul(increment);
        multiplier = multiplier.wrapping_mul(multiplier);
        steps >>= 1;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first numbers from 0 on are printed in the book.
    #[test]
    fn first_numbers_are_those_of_the_literature() {
        let known = [0x3c6e_f35f, 0x4750_2932, 0xd1cc_f6e9, 0xaaf9_5334, 0x6252_e503, 0x9f2e_c686, 0x57fe_6c2d, 0xa3d9_5fa8];
        assert_eq!([0, 1, 2, 3, 4, 5, 6, 7].map(|number| lcg_bits(0, number)), known);
    }

    #[test]
    fn jumps_are_so_many_steps() {
        let mut x = 12_345;
        for number in 0..1000 {
            x = step(x);
            assert_eq!(lcg_bits(12_345, number), x, "{number}");
        }
        // The period is 2³².
        assert_eq!(step(lcg_bits(77, u32::MAX)), step(77));
    }
}
