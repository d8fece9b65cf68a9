//! Multiple importance sampling: how two strategies that can make the same path share it (Veach 1997, chapter 9).
//!
//! Light arriving over a path that both next event estimation (density p_light) and BSDF sampling (density p_bsdf) can make is
//! counted by both, each time multiplied by a weight w with w_light + w_bsdf = 1, so that the sum is counted once. Both strategies
//! take one sample each. A path that only one strategy can make (through a delta lobe, from a point light) has weight 1 there.

use crate::scene::{MisHeuristic, RenderSettings};

/// How two strategies are weighed against each other (Veach 1997, section 9.2.2 and 9.2.3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Heuristic {
    /// In proportion to the densities to the power of β, which is positive. β = 1 is the balance heuristic.
    Power(f64),
    /// In proportion to the densities, but nothing for one that is less than α of the other, α from 0 to 1. α = 1 is the maximum
    /// heuristic; it halves what has the same density both ways.
    Cutoff(f64),
}

impl From<&RenderSettings> for Heuristic {
    fn from(settings: &RenderSettings) -> Self {
        match settings.heuristic {
            MisHeuristic::Power => Self::Power(settings.heuristic_exponent),
            MisHeuristic::Balance => Self::Power(1.0),
            MisHeuristic::Maximum => Self::Cutoff(1.0),
            MisHeuristic::Cutoff => Self::Cutoff(settings.heuristic_cutoff),
        }
    }
}

impl Heuristic {
    /// The weight of a sample that was drawn with density `pdf`, where the other strategy has `other_pdf` (same measure).
    ///
    /// 0 where the sample's own density is 0 (it cannot have been drawn), 1 where it is infinite.
    #[inline]
    pub fn weight(self, pdf: f64, other_pdf: f64) -> f64 {
        if pdf == 0.0 {
            return 0.0;
        }
        if pdf == f64::INFINITY {
            return 1.0;
        }
        // Over the ratio, large densities do not overflow.
        let ratio = other_pdf / pdf;
        match self {
            Self::Power(1.0) => 1.0 / (1.0 + ratio),
            Self::Power(2.0) => 1.0 / (1.0 + ratio * ratio),
            Self::Power(beta) => 1.0 / (1.0 + ratio.powf(beta)),
            Self::Cutoff(alpha) if ratio * alpha > 1.0 => 0.0,
            Self::Cutoff(alpha) if ratio < alpha => 1.0,
            Self::Cutoff(_) => 1.0 / (1.0 + ratio),
        }
    }

    /// The least density of the other strategy with which a sample of density `pdf` has this weight, which is positive.
    pub fn least_other_pdf(self, pdf: f64, weight: f64) -> f64 {
        let odds = (1.0 / weight - 1.0).max(0.0);
        match self {
            Self::Power(beta) => pdf * odds.powf(1.0 / beta),
            Self::Cutoff(_) => pdf * odds,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heuristic(name: MisHeuristic) -> Heuristic {
        let settings =
            RenderSettings { heuristic: name, heuristic_exponent: 3.0, heuristic_cutoff: 0.2, ..RenderSettings::default() };
        Heuristic::from(&settings)
    }

    #[test]
    fn weights_of_the_two_strategies_sum_to_one() {
        let of_names = MisHeuristic::ALL.map(heuristic);
        for heuristic in of_names.into_iter().chain([0.1, 0.5, 2.0, 64.0].map(Heuristic::Power)) {
            for (a, b) in [(1.0, 3.0), (1.0, 10.0), (1e-200, 1e200), (0.0, 2.0), (7.0, 7.0), (1e300, 1e300)] {
                let sum = heuristic.weight(a, b) + heuristic.weight(b, a);
                assert!((sum - 1.0).abs() < 1e-15, "{heuristic:?} {a} {b}: {sum}");
            }
            assert_eq!(heuristic.weight(0.0, 0.0), 0.0);
            assert_eq!(heuristic.weight(1.0, 0.0), 1.0);
            assert_eq!(heuristic.weight(1.0, f64::INFINITY), 0.0);
            assert_eq!(heuristic.weight(f64::INFINITY, 1.0), 1.0);
        }
    }

    #[test]
    fn weights_tell_the_other_density() {
        for heuristic in MisHeuristic::ALL.map(heuristic) {
            for other in [0.3, 1.0, 3.0] {
                let weight = heuristic.weight(1.0, other);
                if weight > 0.0 {
                    assert!((heuristic.weight(1.0, heuristic.least_other_pdf(1.0, weight)) - weight).abs() < 1e-15);
                }
            }
        }
    }

    /// By hand.
    #[test]
    fn each_heuristic_has_its_own_weights() {
        let of = |name, other| heuristic(name).weight(1.0, other);
        assert!((of(MisHeuristic::Balance, 3.0) - 0.25).abs() < 1e-15);
        assert!((Heuristic::Power(2.0).weight(1.0, 3.0) - 0.1).abs() < 1e-15);
        assert!((of(MisHeuristic::Power, 3.0) - 1.0 / 28.0).abs() < 1e-15);
        assert_eq!([0.5, 1.0, 2.0].map(|other| of(MisHeuristic::Maximum, other)), [1.0, 0.5, 0.0]);
        // Densities from a fifth of each other on are balanced.
        assert_eq!([0.19, 5.1].map(|other| of(MisHeuristic::Cutoff, other)), [1.0, 0.0]);
        assert!((of(MisHeuristic::Cutoff, 4.0) - 0.2).abs() < 1e-15);
    }
}
