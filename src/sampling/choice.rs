//! The choice of a path that either samples a light or goes on, but does not do both.
//!
//! The number by which roulette ends a path makes it too: its first bit chooses, the others are left for roulette.

/// The two ways on from a place, each with a chance of one half.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// The path samples a light, and ends.
    Light,
    /// The path goes on in a direction of the material or the phase function.
    Path,
}

impl Choice {
    /// How many times as much counts what was chosen: one over the chance.
    pub const TIMES: f64 = 2.0;

    /// The choice by 32 uniform bits.
    pub fn of(bits: u32) -> Self {
        if bits >> 31 == 0 { Self::Light } else { Self::Path }
    }

    /// The bits that are left for roulette: they are uniform whatever was chosen.
    pub fn bits_left(bits: u32) -> u32 {
        bits << 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_choose_each_and_leave_uniform_bits() {
        let words: Vec<u32> = (0..1024).map(|i| i << 22).collect();
        for choice in [Choice::Light, Choice::Path] {
            let left: Vec<u32> =
                words.iter().filter(|&&bits| Choice::of(bits) == choice).map(|&bits| Choice::bits_left(bits)).collect();
            assert_eq!(left, (0..512).map(|i| i << 23).collect::<Vec<_>>());
        }
    }
}
