//! Polynomials.

/// The value at `x`; coefficients of 1, x, x² and so on.
pub fn value(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient)
}

/// The coefficients of the product.
pub fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; a.len() + b.len() - 1];
    for (i, a) in a.iter().enumerate() {
        for (j, b) in b.iter().enumerate() {
            product[i + j] += a * b;
        }
    }
    product
}

/// The coefficients of the derivative.
pub fn derivative(coefficients: &[f64]) -> Vec<f64> {
    coefficients.iter().enumerate().skip(1).map(|(power, coefficient)| power as f64 * coefficient).collect()
}

/// The roots above 0 and up to `end` at which the sign changes, in order. Between two turning points, roots of the derivative, there is one at most.
pub fn sign_changes(coefficients: &[f64], end: f64) -> Vec<f64> {
    if coefficients.len() < 2 {
        return Vec::new();
    }
    let mut ends = vec![0.0];
    ends.extend(sign_changes(&derivative(coefficients), end));
    ends.push(end);
    let at = |x: f64| value(coefficients, x);
    let has_one = |pair: &&[f64]| (at(pair[0]) < 0.0) != (at(pair[1]) < 0.0);
    ends.windows(2).filter(has_one).map(|pair| bisect(&at, pair[0], pair[1])).collect()
}

/// The place between `low` and `high` where the sign changes.
fn bisect(at: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let is_negative = at(low) < 0.0;
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if (at(middle) < 0.0) == is_negative {
            low = middle;
        } else {
            high = middle;
        }
    }
}
