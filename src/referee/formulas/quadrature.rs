//! Integrals by Gauss and Legendre's rule.

use std::f64::consts::PI;

/// Nodes within (0, 1) and weights, which add up to 1, of the rule that is exact for polynomials of degree 2n − 1. The nodes are found by Newton's
/// method from Tricomi's first guess.
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (1..=n)
        .map(|i| {
            let mut x = (PI * (i as f64 - 0.25) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..100 {
                let (mut before, mut value) = (1.0, x);
                for k in 2..=n {
                    let k = k as f64;
                    (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
                }
                slope = n as f64 * (x * value - before) / (x * x - 1.0);
                let step = value / slope;
                x -= step;
                if step.abs() < 1e-15 {
                    break;
                }
            }
            (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// ∫ f over [from, to], cut into `pieces` equal ones with 16 nodes each.
pub fn integrate(from: f64, to: f64, pieces: usize, f: impl Fn(f64) -> f64) -> f64 {
    let rule = gauss_legendre(16);
    let width = (to - from) / pieces as f64;
    let of_piece = |piece: usize| -> f64 {
        let start = from + piece as f64 * width;
        rule.iter().map(|&(x, weight)| weight * f(start + x * width)).sum()
    };
    width * (0..pieces).map(of_piece).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_exact_for_polynomials_of_their_degree() {
        for n in [1, 2, 5, 16] {
            let rule = gauss_legendre(n);
            for degree in 0..2 * n {
                let sum: f64 = rule.iter().map(|&(x, weight)| weight * x.powi(degree as i32)).sum();
                assert!((sum - 1.0 / (degree as f64 + 1.0)).abs() < 1e-13, "{n} nodes, degree {degree}: {sum}");
            }
            // The control: the next degree is not met.
            let sum: f64 = rule.iter().map(|&(x, weight)| weight * x.powi(2 * n as i32)).sum();
            assert!(n > 5 || (sum - 1.0 / (2.0 * n as f64 + 1.0)).abs() > 1e-9, "{n} nodes: {sum}");
        }
        assert!((integrate(0.0, PI, 3, f64::sin) - 2.0).abs() < 1e-13);
    }
}
