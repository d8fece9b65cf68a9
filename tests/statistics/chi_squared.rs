//! Pearson's χ² test: do counts in bins follow the expected counts?

use statrs::distribution::{ChiSquared as Distribution, ContinuousCDF};

/// Below this expected count the χ² distribution is a poor approximation, and bins are pooled (Cochran 1954).
pub const SMALLEST_EXPECTATION: f64 = 5.0;

/// The outcome of a χ² test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChiSquared {
    pub statistic: f64,
    pub degrees_of_freedom: usize,
    /// Probability of a statistic at least as large, were the expectations right.
    pub p_value: f64,
    /// How many bins were put together because too little was expected in each.
    pub pooled_bins: usize,
}

impl ChiSquared {
    /// A count where none is possible, or a number that is none: no chance explains it.
    fn impossible() -> Self {
        Self { statistic: f64::INFINITY, degrees_of_freedom: 0, p_value: 0.0, pooled_bins: 0 }
    }
}

/// Pearson's test of `observed` against `expected` counts, bin by bin. Bins that expect fewer than [`SMALLEST_EXPECTATION`] are
/// pooled, smallest first; a pool that stays below it joins the smallest other bin. The expected counts are taken to sum to the
/// number of observations: one degree of freedom is spent on that. With a single bin left there is nothing to test and p is 1.
///
/// Slices of different length, negative or non-finite expectations, and counts where exactly 0 was expected in all, give p = 0.
pub fn chi_squared_test(observed: &[u64], expected: &[f64]) -> ChiSquared {
    if observed.len() != expected.len() || !expected.iter().all(|&count| count.is_finite() && count >= 0.0) {
        return ChiSquared::impossible();
    }
    let (cells, pooled_bins) = pooled(observed, expected);
    if cells.iter().any(|&(count, expectation)| expectation == 0.0 && count > 0.0) {
        return ChiSquared::impossible();
    }
    let statistic = cells
        .iter()
        .filter(|(_, expectation)| *expectation > 0.0)
        .map(|(count, expectation)| (count - expectation).powi(2) / expectation)
        .sum();
    let degrees_of_freedom = cells.len().saturating_sub(1);
    let p_value = match Distribution::new(degrees_of_freedom as f64) {
        Ok(distribution) => distribution.sf(statistic),
        Err(_) => 1.0,
    };
    ChiSquared { statistic, degrees_of_freedom, p_value, pooled_bins }
}

/// Pairs of observed and expected counts, none expecting too little unless all together do; and how many bins are in the pool.
fn pooled(observed: &[u64], expected: &[f64]) -> (Vec<(f64, f64)>, usize) {
    let mut bins: Vec<(f64, f64)> =
        observed.iter().zip(expected).map(|(&count, &expectation)| (count as f64, expectation)).collect();
    bins.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut small = bins.partition_point(|bin| bin.1 < SMALLEST_EXPECTATION);
    if small == 0 {
        return (bins, 0);
    }
    let sum = |bins: &[(f64, f64)]| bins.iter().fold((0.0, 0.0), |total, bin| (total.0 + bin.0, total.1 + bin.1));
    if sum(&bins[..small]).1 < SMALLEST_EXPECTATION && small < bins.len() {
        small += 1;
    }
    let pool = sum(&bins[..small]);
    let mut cells = bins.split_off(small);
    cells.push(pool);
    (cells, small)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::random::SplitMix64;

    /// Mendel's (1866) peas, round or wrinkled and yellow or green, against 9 : 3 : 3 : 1.
    #[test]
    fn mendel_1866() {
        let result = chi_squared_test(&[315, 101, 108, 32], &[312.75, 104.25, 104.25, 34.75]);
        assert!((result.statistic - 0.470024).abs() < 1e-6, "{result:?}");
        assert_eq!((result.degrees_of_freedom, result.pooled_bins), (3, 0));
        assert!((result.p_value - 0.9254).abs() < 5e-5, "{result:?}");
    }

    /// With two degrees of freedom P(χ² ≥ x) = exp(−x/2).
    #[test]
    fn two_degrees_in_closed_form() {
        let result = chi_squared_test(&[110, 100, 90], &[100.0, 100.0, 100.0]);
        assert_eq!((result.statistic, result.degrees_of_freedom), (2.0, 2));
        assert!((result.p_value - (-1.0f64).exp()).abs() < 1e-12, "{result:?}");
    }

    #[test]
    fn small_bins_are_pooled() {
        let result = chi_squared_test(&[50, 3, 40, 4, 1], &[50.0, 3.0, 40.0, 4.0, 1.0]);
        assert_eq!((result.degrees_of_freedom, result.pooled_bins), (2, 3));
        // A pool of 3.5 takes in the next bin; a lone small bin does likewise.
        let result = chi_squared_test(&[50, 3, 40, 1], &[50.0, 3.0, 40.0, 0.5]);
        assert_eq!((result.degrees_of_freedom, result.pooled_bins), (1, 3));
        assert_eq!(chi_squared_test(&[1, 1], &[1.0, 1.0]).p_value, 1.0);
    }

    #[test]
    fn the_impossible_fails() {
        assert_eq!(chi_squared_test(&[1], &[0.0]).p_value, 0.0);
        assert_eq!(chi_squared_test(&[10, 10], &[10.0]).p_value, 0.0);
        assert_eq!(chi_squared_test(&[10, 10], &[10.0, f64::NAN]).p_value, 0.0);
        // Pooled with an ordinary bin, a count where none is possible still weighs in.
        assert!(chi_squared_test(&[100, 100, 50], &[100.0, 100.0, 0.0]).p_value < 1e-4);
    }

    /// Counts of `draws` uniform numbers in `bins` bins, the first `excess` times more likely than it should be.
    fn histogram(seed: u64, draws: u64, bins: usize, excess: f64) -> Vec<u64> {
        let mut random = SplitMix64::new(seed << 32);
        let mut counts = vec![0; bins];
        for _ in 0..draws {
            let value = random.uniform() * (bins as f64 - 1.0 + excess) - (excess - 1.0);
            counts[value.max(0.0) as usize] += 1;
        }
        counts
    }

    #[test]
    fn level_and_power() {
        let (draws, bins, repetitions, alpha) = (20_000u64, 50usize, 1000u64, 0.05);
        let expected = vec![draws as f64 / bins as f64; bins];
        let rate = |excess| {
            let rejected = (0..repetitions)
                .filter(|&seed| chi_squared_test(&histogram(seed, draws, bins, excess), &expected).p_value < alpha);
            rejected.count() as f64 / repetitions as f64
        };
        let allowed = 4.0 * (alpha * (1.0 - alpha) / repetitions as f64).sqrt();
        let truth = rate(1.0);
        assert!((truth - alpha).abs() < allowed, "{truth} rejected at level {alpha}");
        assert!(rate(1.5) > 0.99, "half as much again in one of fifty bins is not found");
    }
}
