//! Mean and variance of a stream of numbers.

/// Count, mean and sum of squared deviations, updated one number at a time without cancellation (Welford 1962) and mergeable
/// (Chan, Golub and LeVeque 1979).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Moments {
    count: u64,
    mean: f64,
    squared_deviations: f64,
}

impl Moments {
    /// Takes in one number.
    pub fn push(&mut self, value: f64) {
        self.count += 1;
        let deviation = value - self.mean;
        self.mean += deviation / self.count as f64;
        self.squared_deviations += deviation * (value - self.mean);
    }

    /// The moments of both streams together.
    pub fn merged(self, other: Self) -> Self {
        if self.count == 0 || other.count == 0 {
            return if self.count == 0 { other } else { self };
        }
        let count = self.count + other.count;
        let (own, others) = (self.count as f64, other.count as f64);
        let distance = other.mean - self.mean;
        Self {
            count,
            mean: self.mean + distance * others / count as f64,
            squared_deviations: self.squared_deviations
                + other.squared_deviations
                + distance * distance * own * others / count as f64,
        }
    }

    /// How many numbers were taken in.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Their mean; 0 while there are none.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Unbiased estimate of the variance of the numbers; NaN with fewer than two, which say nothing about it.
    pub fn variance(&self) -> f64 {
        if self.count < 2 { f64::NAN } else { self.squared_deviations / (self.count - 1) as f64 }
    }

    /// Estimated standard deviation of the mean, for independent numbers; NaN with fewer than two.
    pub fn standard_error(&self) -> f64 {
        (self.variance() / self.count as f64).sqrt()
    }
}

impl FromIterator<f64> for Moments {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut moments = Self::default();
        for value in values {
            moments.push(value);
        }
        moments
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_to_five() {
        let moments: Moments = (1..=5).map(f64::from).collect();
        assert_eq!((moments.count(), moments.mean(), moments.variance()), (5, 3.0, 2.5));
        assert_eq!(moments.standard_error(), 0.5f64.sqrt());
    }

    /// NIST StRD "NumAcc3": 1000000.2 followed by 1000 alternations of 1000000.1 and 1000000.3; standard deviation 0.1 certified.
    /// The textbook formula E[x²] − E[x]² loses most digits here.
    #[test]
    fn nist_numacc3() {
        let values = std::iter::once(1000000.2).chain((0..1000).map(|i| if i % 2 == 0 { 1000000.1 } else { 1000000.3 }));
        let moments: Moments = values.collect();
        assert!((moments.mean() - 1000000.2).abs() < 1e-9, "{moments:?}");
        assert!((moments.variance().sqrt() - 0.1).abs() < 1e-9, "{moments:?}");
    }

    #[test]
    fn merging_equals_taking_all() {
        let values: Vec<f64> = (0..100).map(|i| f64::from(i * i % 37) + 1e4).collect();
        let all: Moments = values.iter().copied().collect();
        for split in [0, 1, 40, 100] {
            let (left, right) = values.split_at(split);
            let merged = left.iter().copied().collect::<Moments>().merged(right.iter().copied().collect());
            assert_eq!(merged.count(), all.count());
            assert!((merged.mean() - all.mean()).abs() < 1e-9);
            assert!((merged.variance() - all.variance()).abs() < 1e-9);
        }
    }

    #[test]
    fn one_number_has_no_variance() {
        assert!(Moments::from_iter([3.0]).variance().is_nan());
        assert!(Moments::default().standard_error().is_nan());
    }
}
