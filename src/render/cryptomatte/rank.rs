//! From what each sample of a pixel met to what covers it, the largest share first.

/// Identifiers that are kept of a pixel.
pub(super) const RANKS: usize = 6;

/// Identifier and share of each rank, in pairs; 0 where there is nothing. `shares` are what stopped samples, of so many, and what part of a
/// sample it stopped.
pub(super) fn ranked(shares: impl Iterator<Item = (u32, f64)>, samples: u32) -> [f32; 2 * RANKS] {
    let mut sums: Vec<(u32, f64)> = Vec::new();
    for (id, share) in shares {
        match sums.iter_mut().find(|(known, _)| *known == id) {
            Some((_, sum)) => *sum += share,
            None => sums.push((id, share)),
        }
    }
    // Equal shares go by the smaller identifier, so that files do not depend on the order of samples.
    sums.sort_unstable_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let mut pairs = [0.0; 2 * RANKS];
    for (pair, (id, sum)) in pairs.chunks_exact_mut(2).zip(sums.into_iter().filter(|(_, sum)| *sum > 0.0)) {
        pair[0] = f32::from_bits(id);
        pair[1] = (sum / f64::from(samples)) as f32;
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_share_comes_first() {
        let [a, b, c] = [1.5f32, 2.5, 3.5].map(f32::to_bits);
        let pairs = ranked([b, a, c, c, b, c].map(|id| (id, 1.0)).into_iter(), 8);
        assert_eq!(pairs[..8], [3.5, 0.375, 2.5, 0.25, 1.5, 0.125, 0.0, 0.0]);
        assert_eq!(ranked([(b, 0.5), (a, 0.5)].into_iter(), 2), ranked([(a, 0.5), (b, 0.5)].into_iter(), 2));
        let many = ranked((1..=9).map(|number| ((number as f32).to_bits(), 1.0)), 9);
        assert!(many.iter().skip(1).step_by(2).all(|share| (share - 1.0 / 9.0).abs() < 1e-7));
    }
}
