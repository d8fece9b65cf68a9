//! Numbers of samples as a device's film keeps them.

/// A number of samples, below 2³¹, as a float of the same information: a film's fourth channel is a float, and single precision itself counts to
/// 2²⁴. The bits are moved so that the float is neither denormal nor infinite nor NaN, which devices may change on the way.
/// `shaders/stages/film.wgsl` does the same.
pub fn count_word(count: u32) -> f32 {
    f32::from_bits(((count & 0x0080_0000) << 8) | (((count >> 24) + 1) << 23) | (count & 0x007f_ffff))
}

/// The number that a word of [`count_word`] holds. A zero holds 0 as well.
pub fn count_in(word: f32) -> u32 {
    let bits = word.to_bits();
    let high = ((bits >> 23) & 255).max(1) - 1;
    (high << 24) | ((bits >> 8) & 0x0080_0000) | (bits & 0x007f_ffff)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_come_back_and_are_normal_floats() {
        let edges = [0_u32, 1, 23, 24, 30, 31].map(|power| if power == 0 { 0 } else { (1_u64 << power) as u32 });
        for count in edges.into_iter().flat_map(|edge| [edge.saturating_sub(1), edge, edge + 1]).filter(|count| *count < 1 << 31)
        {
            let word = count_word(count);
            assert!(word.is_normal(), "{count}: {word}");
            assert_eq!(count_in(word), count);
        }
        assert_eq!(count_in(0.0), 0);
        // The control: as floats, the largest of them are not all there.
        assert_ne!(((1_u32 << 24) + 1) as f32 as u32, (1 << 24) + 1);
    }
}
