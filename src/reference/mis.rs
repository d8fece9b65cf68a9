//! Multiple importance sampling: how two strategies that can make the same path share it (Veach 1997, chapter 9).
//!
//! Light arriving over a path that both next event estimation (density p_light) and BSDF sampling (density p_bsdf) can make is
//! counted by both, each time multiplied by a weight w with w_light + w_bsdf = 1, so that the sum is counted once. Both strategies
//! take one sample each. A path that only one strategy can make (through a delta lobe, from a point light) has weight 1 there.

use crate::scene::MisHeuristic;

/// The weight of a sample that was drawn with density `pdf`, where the other strategy has `other_pdf` (same measure).
///
/// 0 where the sample's own density is 0 (it cannot have been drawn), 1 where it is infinite.
#[inline]
pub fn weight(heuristic: MisHeuristic, pdf: f64, other_pdf: f64) -> f64 {
    match heuristic {
        MisHeuristic::Power => power(pdf, other_pdf),
        MisHeuristic::Balance => balance(pdf, other_pdf),
    }
}

/// Balance heuristic a / (a + b).
fn balance(a: f64, b: f64) -> f64 {
    from_ratio(a, b, |ratio| ratio)
}

/// Power heuristic with β = 2: a² / (a² + b²). Written over the ratio, large densities do not overflow.
fn power(a: f64, b: f64) -> f64 {
    from_ratio(a, b, |ratio| ratio * ratio)
}

/// 1 / (1 + g(b/a)), guarded where the ratio does not exist.
fn from_ratio(a: f64, b: f64, g: impl Fn(f64) -> f64) -> f64 {
    if a == 0.0 {
        0.0
    } else if a == f64::INFINITY {
        1.0
    } else {
        1.0 / (1.0 + g(b / a))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_of_the_two_strategies_sum_to_one() {
        for heuristic in [MisHeuristic::Power, MisHeuristic::Balance] {
            for (a, b) in [(1.0, 3.0), (1e-200, 1e200), (0.0, 2.0), (7.0, 7.0), (1e300, 1e300)] {
                let sum = weight(heuristic, a, b) + weight(heuristic, b, a);
                assert!((sum - 1.0).abs() < 1e-15, "{heuristic:?} {a} {b}: {sum}");
            }
            assert_eq!(weight(heuristic, 0.0, 0.0), 0.0);
            assert_eq!(weight(heuristic, 1.0, f64::INFINITY), 0.0);
            assert_eq!(weight(heuristic, f64::INFINITY, 1.0), 1.0);
        }
        assert!((power(1.0, 3.0) - 0.1).abs() < 1e-15);
        assert!((balance(1.0, 3.0) - 0.25).abs() < 1e-15);
    }
}
