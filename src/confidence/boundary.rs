//! How far a sum of random numbers strays from its expectation, at any time, but for a stated probability.

use std::f64::consts::LN_2;

/// Rates of the mixture: the first, and how many there are, each half the one before.
const LARGEST_RATE: f64 = 0.75;
const RATES: usize = 24;
/// Newton's steps stop where they move the boundary by less than this share.
const ENOUGH: f64 = 1e-9;
const MOST_STEPS: u32 = 60;

/// A boundary for numbers that lie no farther than a known distance on one side of what was predicted for them.
///
/// Let cᵢ be a prediction of Xᵢ from what came before, Xᵢ − cᵢ ≥ −1, S = Σ(Xᵢ − E Xᵢ) and V = Σ(Xᵢ − cᵢ)². For each rate λ of [0, 1),
/// exp(λS − ψ(λ)V) with ψ(λ) = −ln(1 − λ) − λ is a supermartingale from 1 on (Fan, Grama and Liu 2015, "Exponential inequalities for martingales with
/// applications", lemma 4.1; Howard et al. 2021, theorem 4). So is their mean over several rates, and by Ville's inequality it ever reaches 1/α with
/// probability α at most. The boundary is the S at which it does.
#[derive(Debug, Clone)]
pub struct BernsteinBoundary {
    /// ln(1/α), and that with the number of rates over which the mean is taken.
    threshold: f64,
    summed_threshold: f64,
    /// Each rate λ with ψ(λ).
    rates: [(f64, f64); RATES],
}

impl BernsteinBoundary {
    /// The boundary that S crosses with probability `alpha` at most.
    pub fn new(alpha: f64) -> Self {
        let threshold = -alpha.ln();
        let rates = std::array::from_fn(|number| {
            let rate = LARGEST_RATE * (-LN_2 * number as f64).exp();
            (rate, -(-rate).ln_1p() - rate)
        });
        Self { threshold, summed_threshold: threshold + (RATES as f64).ln(), rates }
    }

    /// The S that is not crossed, for the sum V of squared deviations from the predictions.
    pub fn deviation(&self, squares: f64) -> f64 {
        // One rate alone reaches the threshold here; from above, Newton's method on a convex function goes straight down.
        let alone = |&(rate, psi): &(f64, f64)| (self.summed_threshold + psi * squares) / rate;
        let mut sum = self.rates.iter().map(alone).fold(f64::INFINITY, f64::min);
        for _ in 0..MOST_STEPS {
            let (mut total, mut slope) = (0.0, 0.0);
            for (rate, psi) in self.rates {
                let term = (rate * sum - psi * squares - self.summed_threshold).exp();
                total += term;
                slope += rate * term;
            }
            let step = total.ln() * total / slope;
            sum -= step;
            if step.abs() <= ENOUGH * sum {
                break;
            }
        }
        sum.max(self.threshold)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::random::SplitMix64;

    /// By bisection of the definition.
    #[test]
    fn the_boundary_is_where_the_mixture_reaches_its_threshold() {
        for alpha in [0.05, 1e-3, 1e-9] {
            let boundary = BernsteinBoundary::new(alpha);
            for squares in [0.0, 1e-3, 1.0, 50.0, 1e4, 1e9] {
                let mixture = |sum: f64| {
                    let rates = (0..RATES).map(|number| LARGEST_RATE * 0.5_f64.powi(number as i32));
                    let terms = rates.map(|rate: f64| (rate * sum + ((1.0 - rate).ln() + rate) * squares + alpha.ln()).exp());
                    terms.sum::<f64>() / RATES as f64
                };
                let found = boundary.deviation(squares);
                assert!(mixture(found * (1.0 + 1e-6)) >= 1.0, "{alpha} {squares}: {found}");
                assert!(mixture(found * (1.0 - 1e-6)) <= 1.0, "{alpha} {squares}: {found}");
            }
        }
    }

    /// The boundary is within a small factor of what a normal distribution would need at a single look, √(2V·ln(1/α)).
    #[test]
    fn looking_always_costs_a_small_factor() {
        let (alpha, squares): (f64, f64) = (1e-3, 1e4);
        let ratio = BernsteinBoundary::new(alpha).deviation(squares) / (-2.0 * squares * alpha.ln()).sqrt();
        assert!((1.0..1.45).contains(&ratio), "{ratio}");
    }

    /// Rare events of height 1, which have not been seen in most of these runs: the boundary of what lies above the mean is crossed by no more
    /// runs than it may. What a normal distribution would need at each look, the control, is crossed by nearly all.
    #[test]
    fn rare_light_is_within_the_boundary_and_not_within_the_normal_one() {
        let (alpha, chance, runs): (f64, f64, u64) = (0.05, 2e-3, 400);
        let boundary = BernsteinBoundary::new(alpha);
        let mut crossed = [0_u32; 2];
        for run in 0..runs {
            let mut random = SplitMix64::new(run << 20);
            let (mut sum, mut squares, mut crosses) = (0.0, 0.0, [false; 2]);
            for count in 1..=1024_u32 {
                let prediction = sum / f64::from(count);
                let seen = f64::from(u8::from(random.uniform() < chance));
                sum += seen;
                squares += (seen - prediction).powi(2);
                if count.is_power_of_two() {
                    // The sum lies below its expectation: what is predicted less what is seen is above −1.
                    let lacking = chance * f64::from(count) - sum;
                    crosses[0] |= lacking > boundary.deviation(squares);
                    crosses[1] |= lacking > (-2.0 * squares * alpha.ln()).sqrt();
                }
            }
            (0..2).for_each(|which| crossed[which] += u32::from(crosses[which]));
        }
        let expected = alpha * runs as f64;
        assert!(f64::from(crossed[0]) < expected + 4.0 * expected.sqrt(), "{crossed:?}");
        assert!(f64::from(crossed[1]) > 0.8 * runs as f64, "the control is crossed in {crossed:?} of {runs} runs");
    }
}
