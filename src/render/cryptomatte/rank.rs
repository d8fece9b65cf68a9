//! From what each sample of a pixel met to what covers it, the largest share first.

/// What is kept of a pixel.
pub(super) const RANKS: usize = 6;

/// Identifier and share of each rank, in pairs; 0 where there is nothing. `ids` are those of the samples that met something, of so many.
pub(super) fn ranked(ids: impl Iterator<Item = u32>, samples: u32) -> [f32; 2 * RANKS] {
    let mut counts: Vec<(u32, u32)> = Vec::new();
    for id in ids {
        match counts.iter_mut().find(|(known, _)| *known == id) {
            Some((_, count)) => *count += 1,
            None => counts.push((id, 1)),
        }
    }
    // Of equal shares, the smaller identifier, so that files do not depend on the order of samples.
    counts.sort_unstable_by_key(|(id, count)| (std::cmp::Reverse(*count), *id));
    let mut pairs = [0.0; 2 * RANKS];
    for (pair, (id, count)) in pairs.chunks_exact_mut(2).zip(counts) {
        pair[0] = f32::from_bits(id);
        pair[1] = count as f32 / samples as f32;
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_share_comes_first() {
        let [a, b, c] = [1.5f32, 2.5, 3.5].map(f32::to_bits);
        let pairs = ranked([b, a, c, c, b, c].into_iter(), 8);
        assert_eq!(pairs[..8], [3.5, 0.375, 2.5, 0.25, 1.5, 0.125, 0.0, 0.0]);
        assert_eq!(ranked([b, a].into_iter(), 2), ranked([a, b].into_iter(), 2));
        let many = ranked((1..=9).map(|number| (number as f32).to_bits()), 9);
        assert!(many.iter().skip(1).step_by(2).all(|share| (share - 1.0 / 9.0).abs() < 1e-7));
    }
}
