//! Tests of means: is what was measured explained by chance?

use statrs::distribution::{ContinuousCDF, StudentsT};
use statrs::function::erf::erfc;

use super::moments::Moments;

/// The outcome of one two-sided test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TestResult {
    /// How many standard errors the estimate is from the hypothesis.
    pub statistic: f64,
    /// Infinite where the variance is known (z-test).
    pub degrees_of_freedom: f64,
    /// Probability of a statistic at least as far out, were the hypothesis true.
    pub p_value: f64,
}

impl TestResult {
    /// Judges a deviation from the hypothesis by its standard error. A standard error of zero leaves no room for chance: a
    /// deviation then has p = 0, and no deviation has p = 1. Whatever is not a number has p = 0, so that it never passes.
    pub fn from_deviation(deviation: f64, standard_error: f64, degrees_of_freedom: f64) -> Self {
        let judged = |statistic: f64, p_value| Self { statistic, degrees_of_freedom, p_value };
        if deviation == 0.0 && !standard_error.is_nan() {
            return judged(0.0, 1.0);
        }
        let statistic = deviation / standard_error;
        if statistic.is_nan() {
            return judged(statistic, 0.0);
        }
        judged(statistic, two_sided_p(statistic, degrees_of_freedom))
    }

    /// A test like [`Self::from_deviation`] of the hypothesis that the deviation is at most `margin`: only
    /// what goes beyond it counts. It allows for rounding, which is no chance: two ways to compute the same
    /// number differ in the last digits every time. At the margin the test keeps its level, inside it rejects
    /// more rarely.
    pub fn beyond_margin(deviation: f64, margin: f64, standard_error: f64, degrees_of_freedom: f64) -> Self {
        // Written so that NaN stays NaN; f64::max would make it 0.
        let excess = if deviation.abs() <= margin { 0.0 } else { deviation - margin.copysign(deviation) };
        Self::from_deviation(excess, standard_error, degrees_of_freedom)
    }
}

/// P(|T| ≥ |statistic|) for Student's t, or for the normal distribution where the degrees of freedom are infinite.
fn two_sided_p(statistic: f64, degrees_of_freedom: f64) -> f64 {
    let distance = statistic.abs();
    if distance.is_infinite() {
        return 0.0;
    }
    if degrees_of_freedom.is_infinite() {
        return erfc(distance * std::f64::consts::FRAC_1_SQRT_2);
    }
    match StudentsT::new(0.0, 1.0, degrees_of_freedom) {
        Ok(distribution) => (2.0 * distribution.sf(distance)).min(1.0),
        // Less than one observation to spare: nothing can be said, and nothing unsaid may pass.
        Err(_) => 0.0,
    }
}

/// z-test: the deviation of an estimate whose standard error is known, or comes from so many samples that it is as good as known.
pub fn z_test(deviation: f64, standard_error: f64) -> TestResult {
    TestResult::from_deviation(deviation, standard_error, f64::INFINITY)
}

/// Student's t-test (1908) that independent, about normally distributed observations have the mean `expected`.
pub fn one_sample_t_test(observations: &Moments, expected: f64) -> TestResult {
    one_sample_t_test_beyond(observations, expected, 0.0)
}

/// Student's t-test that the mean of the observations is within `margin` of `expected`; see [`TestResult::beyond_margin`]. It is the
/// one for closed forms, which some estimators hit without any noise, up to rounding.
pub fn one_sample_t_test_beyond(observations: &Moments, expected: f64, margin: f64) -> TestResult {
    TestResult::beyond_margin(
        observations.mean() - expected,
        margin,
        observations.standard_error(),
        observations.count().saturating_sub(1) as f64,
    )
}

/// Student's t-test on the differences of pairs: for observations that belong together, such as two renderers' values for the same
/// random numbers. `None` where the slices' lengths differ.
pub fn paired_t_test(first: &[f64], second: &[f64]) -> Option<TestResult> {
    (first.len() == second.len()).then(|| {
        let differences: Moments = first.iter().zip(second).map(|(a, b)| a - b).collect();
        one_sample_t_test(&differences, 0.0)
    })
}

/// Welch's t-test (1947) that two independent samples, whose variances may differ, have the same mean.
pub fn welch_t_test(first: &Moments, second: &Moments) -> TestResult {
    let [a, b] = [first, second].map(|moments| moments.variance() / moments.count() as f64);
    let spread = |part: f64, moments: &Moments| part * part / moments.count().saturating_sub(1) as f64;
    // Two samples without any scatter: the number of degrees is 0/0, and no test needs it.
    let degrees = if a + b == 0.0 { f64::INFINITY } else { (a + b) * (a + b) / (spread(a, first) + spread(b, second)) };
    TestResult::from_deviation(first.mean() - second.mean(), (a + b).sqrt(), degrees)
}

/// The level for each of `tests` independent tests so that all together reject a true hypothesis with probability `alpha`
/// (Šidák 1967): 1 − (1 − α)^(1/m).
pub fn sidak(alpha: f64, tests: usize) -> f64 {
    // Through logarithms near 1: for many tests, 1 − α^(1/m) itself has no digits left.
    -((-alpha).ln_1p() / tests.max(1) as f64).exp_m1()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::random::SplitMix64;

    /// Student's (1908) sleep data, as R ships it (`datasets::sleep`): extra hours of sleep under two drugs.
    const DRUG_1: [f64; 10] = [0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0];
    const DRUG_2: [f64; 10] = [1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4];

    fn close(got: f64, expected: f64, digits: i32) {
        let tolerance = 0.5 * 10f64.powi(-digits);
        assert!((got - expected).abs() <= tolerance, "got {got}, expected {expected}");
    }

    #[test]
    fn student_1908() {
        let one = one_sample_t_test(&DRUG_1.into_iter().collect(), 0.0);
        close(one.statistic, 1.3257, 4);
        close(one.p_value, 0.2176, 4);
        let paired = paired_t_test(&DRUG_1, &DRUG_2).unwrap();
        close(paired.statistic, -4.0621, 4);
        assert_eq!(paired.degrees_of_freedom, 9.0);
        close(paired.p_value, 0.002833, 6);
        let welch = welch_t_test(&DRUG_1.into_iter().collect(), &DRUG_2.into_iter().collect());
        close(welch.statistic, -1.8608, 4);
        close(welch.degrees_of_freedom, 17.776, 3);
        close(welch.p_value, 0.07939, 5);
    }

    /// Quantiles of the standard normal distribution, and of Cauchy's, which is Student's with one degree: P(|T| ≥ 1) = ½.
    #[test]
    fn tabulated_quantiles() {
        close(z_test(1.959963984540054, 1.0).p_value, 0.05, 10);
        close(z_test(-2.5758293035489004, 1.0).p_value, 0.01, 10);
        close(z_test(6.0, 1.0).p_value * 1e9, 1.973175290075396, 6);
        close(TestResult::from_deviation(3.0, 3.0, 1.0).p_value, 0.5, 12);
        close(TestResult::from_deviation(2.262157162740992, 1.0, 9.0).p_value, 0.05, 10);
    }

    #[test]
    fn nothing_undefined_passes() {
        assert_eq!(z_test(0.0, 0.0).p_value, 1.0);
        assert_eq!(z_test(1e-9, 0.0).p_value, 0.0);
        assert_eq!(z_test(f64::NAN, 1.0).p_value, 0.0);
        assert_eq!(z_test(f64::INFINITY, f64::INFINITY).p_value, 0.0);
        assert_eq!(one_sample_t_test(&Moments::from_iter([1.0]), 1.0).p_value, 0.0);
        assert_eq!(welch_t_test(&Moments::default(), &Moments::default()).p_value, 0.0);
        assert_eq!(paired_t_test(&[1.0], &[]), None);
    }

    #[test]
    fn the_margin_is_subtracted() {
        let beyond = |deviation| TestResult::beyond_margin(deviation, 0.5, 0.25, 9.0);
        assert_eq!(beyond(0.5).p_value, 1.0);
        assert_eq!(beyond(-1.0), TestResult::from_deviation(-0.5, 0.25, 9.0));
        assert_eq!(beyond(f64::NAN).p_value, 0.0);
        let noiseless: Moments = [2.000_000_1; 4].into_iter().collect();
        assert_eq!(one_sample_t_test(&noiseless, 2.0).p_value, 0.0);
        assert_eq!(one_sample_t_test_beyond(&noiseless, 2.0, 1e-5).p_value, 1.0);
        assert_eq!(one_sample_t_test_beyond(&noiseless, 1.98, 1e-5).p_value, 0.0);
    }

    #[test]
    fn sidak_in_closed_form() {
        close(sidak(0.05, 1), 0.05, 12);
        close(sidak(0.05, 10), 1.0 - 0.95f64.powf(0.1), 12);
        close(sidak(0.05, 10), 0.005116, 6);
        // For many tests it tends to −ln(1 − α)/m.
        close(sidak(0.01, 1_000_000_000) * 1e9, 0.01005033585, 9);
    }

    /// How often `test` rejects at level `alpha` over seeded repetitions.
    fn rejections(repetitions: u64, alpha: f64, mut test: impl FnMut(&mut SplitMix64) -> TestResult) -> f64 {
        let rejected = (0..repetitions).filter(|&seed| test(&mut SplitMix64::new(seed << 32)).p_value < alpha).count();
        rejected as f64 / repetitions as f64
    }

    fn draws(random: &mut SplitMix64, count: usize, mean: f64, deviation: f64) -> Moments {
        (0..count).map(|_| mean + deviation * random.normal()).collect()
    }

    /// A test at level α rejects the truth in a share α of all cases, within four standard deviations of a binomial count.
    #[test]
    fn false_positives_come_at_the_stated_rate() {
        let (repetitions, alpha) = (4000, 0.05);
        let allowed = 4.0 * (alpha * (1.0 - alpha) / repetitions as f64).sqrt();
        let one = rejections(repetitions, alpha, |random| one_sample_t_test(&draws(random, 6, 2.0, 0.3), 2.0));
        let welch =
            rejections(repetitions, alpha, |random| welch_t_test(&draws(random, 12, 1.0, 0.1), &draws(random, 12, 1.0, 0.4)));
        let z = rejections(repetitions, alpha, |random| z_test(0.7 * random.normal(), 0.7));
        for (name, rate) in [("t", one), ("Welch", welch), ("z", z)] {
            assert!((rate - alpha).abs() < allowed, "{name}: {rate} rejected at level {alpha}");
        }
    }

    /// One per cent too much, with a noise of one per cent on each of 100 observations, is ten standard errors for one sample, seven for two.
    #[test]
    fn one_per_cent_is_found() {
        let one = rejections(200, 0.001, |random| one_sample_t_test(&draws(random, 100, 1.01, 0.01), 1.0));
        let welch =
            rejections(200, 0.001, |random| welch_t_test(&draws(random, 100, 1.01, 0.01), &draws(random, 100, 1.0, 0.01)));
        assert!(one > 0.99 && welch > 0.99, "power {one} (t), {welch} (Welch)");
    }
}
