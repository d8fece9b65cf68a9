//! Numerical integration over rectangles.

/// Points of the Gauss–Legendre rule along each axis; it is exact for polynomials up to degree 15.
const POINTS: usize = 8;
/// A rectangle is first cut into this many parts along each axis, so that a narrow peak is not overlooked.
const FIRST_CUTS: usize = 2;
/// How often each of those parts may be quartered.
const DEEPEST: u32 = 8;

/// An integral and an estimate of its error.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Integral {
    pub value: f64,
    /// Sum over the parts of what the last refinement still changed. Where the integrand jumps, that is too cautious by far.
    pub error: f64,
}

impl std::ops::AddAssign for Integral {
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        self.error += other.error;
    }
}

/// Roots and weights of the Legendre polynomial of degree [`POINTS`] on [−1, 1] (Newton's method on the three-term recurrence).
fn gauss_legendre() -> [(f64, f64); POINTS] {
    let degree = POINTS as f64;
    std::array::from_fn(|i| {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (degree + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..20 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=POINTS {
                let k = k as f64;
                (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            }
            slope = degree * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    })
}

/// Integrates `f` over `[x0, x1] × [y0, y1]`: Gauss–Legendre, quartering wherever that changes a part by more than its share of
/// `tolerance`.
pub fn integrate_rectangle(f: impl Fn(f64, f64) -> f64, x: [f64; 2], y: [f64; 2], tolerance: f64) -> Integral {
    let rule = Rule { f, nodes: gauss_legendre() };
    let mut total = Integral::default();
    let parts = (FIRST_CUTS * FIRST_CUTS) as f64;
    for i in 0..FIRST_CUTS {
        for j in 0..FIRST_CUTS {
            let part = [part_of(x, i, FIRST_CUTS), part_of(y, j, FIRST_CUTS)];
            total += rule.refine(part, rule.estimate(part), tolerance / parts, DEEPEST);
        }
    }
    total
}

fn part_of([start, end]: [f64; 2], index: usize, parts: usize) -> [f64; 2] {
    let at = |i: usize| start + (end - start) * i as f64 / parts as f64;
    [at(index), at(index + 1)]
}

struct Rule<F> {
    f: F,
    nodes: [(f64, f64); POINTS],
}

impl<F: Fn(f64, f64) -> f64> Rule<F> {
    fn estimate(&self, [[x0, x1], [y0, y1]]: [[f64; 2]; 2]) -> f64 {
        let (half_width, half_height) = (0.5 * (x1 - x0), 0.5 * (y1 - y0));
        let mut sum = 0.0;
        for (x, x_weight) in self.nodes {
            for (y, y_weight) in self.nodes {
                sum += x_weight * y_weight * (self.f)(x0 + half_width * (1.0 + x), y0 + half_height * (1.0 + y));
            }
        }
        sum * half_width * half_height
    }

    fn refine(&self, part: [[f64; 2]; 2], coarse: f64, tolerance: f64, depth_left: u32) -> Integral {
        let quarters = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| [part_of(part[0], i, 2), part_of(part[1], j, 2)]);
        let estimates = quarters.map(|quarter| self.estimate(quarter));
        let value: f64 = estimates.iter().sum();
        let error = (value - coarse).abs();
        if error <= tolerance || depth_left == 0 {
            return Integral { value, error };
        }
        let mut total = Integral::default();
        for (quarter, estimate) in quarters.into_iter().zip(estimates) {
            // Half, not a quarter: the error concentrates along peaks and edges.
            total += self.refine(quarter, estimate, 0.5 * tolerance, depth_left - 1);
        }
        total
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_exact() {
        let got = integrate_rectangle(|x, y| x.powi(7) * y.powi(3) + 1.0, [0.0, 1.0], [-1.0, 2.0], 1e-9);
        assert!((got.value - (15.0 / 32.0 + 3.0)).abs() < 1e-13, "{got:?}");
        assert!(got.error < 1e-12);
    }

    /// ∬ exp(−(x² + y²)/2σ²) = 2πσ² for a peak far narrower than the first parts.
    #[test]
    fn narrow_peaks_are_resolved() {
        let sigma = 0.02;
        let peak = |x: f64, y: f64| (-((x - 0.3).powi(2) + (y - 0.6).powi(2)) / (2.0 * sigma * sigma)).exp();
        let got = integrate_rectangle(peak, [0.0, 1.0], [0.0, 1.0], 1e-9);
        assert!((got.value - std::f64::consts::TAU * sigma * sigma).abs() < 1e-9, "{got:?}");
    }

    /// The area of a quarter disk: the error estimate must cover what the jump leaves.
    #[test]
    fn jumps_are_covered_by_the_error() {
        let got = integrate_rectangle(|x, y| f64::from(x * x + y * y < 1.0), [0.0, 1.0], [0.0, 1.0], 1e-9);
        let off = (got.value - std::f64::consts::FRAC_PI_4).abs();
        assert!(off < 2e-5 && off < got.error && got.error < 2e-3, "{got:?}, off by {off}");
    }
}
