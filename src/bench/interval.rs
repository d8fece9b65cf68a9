//! The result of repeated measurements: an estimate, and how far chance alone could have moved it.

use serde::Serialize;
use statrs::distribution::{Binomial, ContinuousCDF, DiscreteCDF, StudentsT};

use crate::compare::Moments;

/// The confidence that intervals are made for. Intervals of few values may have less, and say so.
pub const CONFIDENCE: f64 = 0.95;

/// An estimate with a confidence interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Interval {
    pub estimate: f64,
    pub low: f64,
    pub high: f64,
    /// The share of such intervals that hold the truth.
    pub confidence: f64,
}

/// The position of an interval relative to a value, such as 1 for a ratio.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum IntervalVerdict {
    /// The whole interval lies below.
    Less,
    /// The whole interval lies above.
    More,
    /// The interval holds the value: chance explains the difference.
    InsideTheNoise,
    /// The interval's confidence is less than [`CONFIDENCE`]: nothing can be said.
    TooFewRuns,
}

impl IntervalVerdict {
    /// The verdict in words.
    pub fn label(self) -> &'static str {
        match self {
            Self::Less => "less",
            Self::More => "more",
            Self::InsideTheNoise => "inside the noise",
            Self::TooFewRuns => "too few runs to tell",
        }
    }
}

impl Interval {
    /// The mean of independent, about normally distributed values, by Student's t. Infinitely wide for fewer than two.
    pub fn of_mean(values: &[f64]) -> Self {
        let moments: Moments = values.iter().copied().collect();
        let half = match StudentsT::new(0.0, 1.0, (values.len() as f64 - 1.0).max(f64::MIN_POSITIVE)) {
            Ok(student) if values.len() > 1 => student.inverse_cdf(0.5 + CONFIDENCE / 2.0) * moments.standard_error(),
            _ => f64::INFINITY,
        };
        Self { estimate: moments.mean(), low: moments.mean() - half, high: moments.mean() + half, confidence: CONFIDENCE }
    }

    /// The median of independent values of any distribution: between two order statistics lies the true median unless too many values
    /// fell on one side of it, which is a matter of coin tosses (Conover, Practical Nonparametric Statistics, section 3.2). One slow run
    /// on a busy machine moves it little. With five values or fewer, least to largest has less than the wanted confidence.
    pub fn of_median(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len();
        if count == 0 {
            return Self { estimate: f64::NAN, low: f64::NEG_INFINITY, high: f64::INFINITY, confidence: 0.0 };
        }
        let (left_out, confidence) = left_out(count);
        Self { estimate: median(&sorted), low: sorted[left_out], high: sorted[count - 1 - left_out], confidence }
    }

    /// The position of the interval relative to `value`.
    pub fn verdict(&self, value: f64) -> IntervalVerdict {
        if self.confidence < CONFIDENCE {
            IntervalVerdict::TooFewRuns
        } else if self.high < value {
            IntervalVerdict::Less
        } else if self.low > value {
            IntervalVerdict::More
        } else {
            IntervalVerdict::InsideTheNoise
        }
    }

    /// The interval moved by `offset`, whose own standard error widens it.
    pub fn shifted(self, offset: f64, standard_error: f64) -> Self {
        let widen = |half: f64| half.hypot(1.96 * standard_error);
        let estimate = self.estimate + offset;
        Self {
            estimate,
            low: estimate - widen(self.estimate - self.low),
            high: estimate + widen(self.high - self.estimate),
            ..self
        }
    }

    pub fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }
}

/// How many values at either end the interval of the median can do without, and the confidence it then has.
fn left_out(count: usize) -> (usize, f64) {
    let Ok(tosses) = Binomial::new(0.5, count as u64) else { return (0, 0.0) };
    let confidence = |left_out: usize| 1.0 - 2.0 * tosses.cdf(left_out as u64);
    let fitting = (0..count.div_ceil(2)).take_while(|&left_out| confidence(left_out) >= CONFIDENCE).last().unwrap_or(0);
    (fitting, confidence(fitting).max(0.0))
}

/// The middle of sorted values.
fn median(sorted: &[f64]) -> f64 {
    let (below, above) = (sorted[(sorted.len() - 1) / 2], sorted[sorted.len() / 2]);
    below + (above - below) / 2.0
}

/// Times or rates as they were met: the middle and the extremes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    pub median: f64,
    pub least: f64,
    pub largest: f64,
}

impl Spread {
    /// NaN of no values.
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        match (sorted.first(), sorted.last()) {
            (Some(&least), Some(&largest)) => Self { median: median(&sorted), least, largest },
            _ => Self { median: f64::NAN, least: f64::NAN, largest: f64::NAN },
        }
    }
}

impl Spread {
    /// In another unit.
    pub fn scaled(self, factor: f64) -> Self {
        Self { median: self.median * factor, least: self.least * factor, largest: self.largest * factor }
    }
}

/// A ratio of what two settings needed, run by run, and what that says.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Ratio {
    #[serde(flatten)]
    pub interval: Interval,
    pub verdict: IntervalVerdict,
}

impl Ratio {
    /// The median ratio of pairs measured next to each other; pairs that are not two positive numbers are left out.
    pub fn of_pairs(pairs: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let ratios: Vec<f64> = pairs
            .into_iter()
            .filter(|(over, under)| *over > 0.0 && *under > 0.0 && over.is_finite() && under.is_finite())
            .map(|(over, under)| over / under)
            .collect();
        let interval = Interval::of_median(&ratios);
        Self { interval, verdict: interval.verdict(1.0) }
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use crate::statistics::random::SplitMix64;

    #[test]
    fn intervals_of_known_values() {
        // Student's t with 4 degrees of freedom: 2.776; standard error √(2.5/5).
        let mean = Interval::of_mean(&[1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_relative_eq!(mean.high - 3.0, 2.776_445 * 0.5_f64.sqrt(), epsilon = 1e-5);
        // Coin tosses: 6 values leave out none (1 − 2/64), 9 leave out one at either end (1 − 2·10/512).
        let six = Interval::of_median(&[6.0, 1.0, 5.0, 2.0, 4.0, 3.0]);
        assert_eq!((six.estimate, six.low, six.high), (3.5, 1.0, 6.0));
        assert_relative_eq!(six.confidence, 1.0 - 2.0 / 64.0, epsilon = 1e-12);
        let nine = Interval::of_median(&[9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0]);
        assert_eq!((nine.estimate, nine.low, nine.high), (5.0, 2.0, 8.0));
        assert_relative_eq!(nine.confidence, 1.0 - 20.0 / 512.0, epsilon = 1e-12);
    }

    #[test]
    fn few_values_decide_nothing() {
        assert_eq!(Interval::of_median(&[2.0, 2.0, 2.0]).verdict(1.0), IntervalVerdict::TooFewRuns);
        assert_eq!(Interval::of_median(&[2.0; 6]).verdict(1.0), IntervalVerdict::More);
        assert_eq!(Interval::of_median(&[]).verdict(1.0), IntervalVerdict::TooFewRuns);
        assert_eq!(Interval::of_mean(&[2.0]).verdict(1.0), IntervalVerdict::InsideTheNoise);
    }

    /// About 95 % of intervals at 95 % hold the truth, whatever the distribution; the bound is four standard
    /// deviations of a binomial count.
    #[test]
    fn intervals_hold_the_truth_as_often_as_they_say() {
        let trials = 2000;
        let mut covered = [0.0, 0.0];
        let mut expected = 0.0;
        for seed in 0..trials {
            let mut random = SplitMix64::new(seed << 20);
            let normal: Vec<f64> = (0..9).map(|_| 5.0 + random.normal()).collect();
            let skewed: Vec<f64> = (0..9).map(|_| random.normal().exp()).collect();
            let median = Interval::of_median(&skewed);
            covered[0] += f64::from(u8::from(Interval::of_mean(&normal).contains(5.0)));
            covered[1] += f64::from(u8::from(median.contains(1.0)));
            expected = median.confidence;
        }
        let trials = trials as f64;
        for (covered, expected) in [(covered[0], CONFIDENCE), (covered[1], expected)] {
            assert!(
                (covered / trials - expected).abs() < 4.0 * (expected * (1.0 - expected) / trials).sqrt(),
                "{covered} of {trials}"
            );
        }
    }
}
