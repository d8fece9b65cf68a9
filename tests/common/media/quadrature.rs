//! Numerical integration over an interval.

/// How often an interval may be halved.
const DEEPEST: u32 = 40;

/// Nodes and weights of the Gauss–Legendre rule on [from, to], ascending; exact for polynomials up to degree 2 `count` − 1.
pub fn gauss_legendre(count: usize, from: f64, to: f64) -> Vec<(f64, f64)> {
    let (degree, half) = (count as f64, 0.5 * (to - from));
    let node = |index: usize| {
        // The roots from −1 upward, by Newton's method from an estimate that is right to its basin.
        let mut x = -(std::f64::consts::PI * (index as f64 + 0.75) / (degree + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..12 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=count {
                let k = k as f64;
                (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            }
            slope = degree * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (from + half * (1.0 + x), half * 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(node).collect()
}

/// The integral of a function over [from, to]: Gauss–Legendre rules of 10 and of twice 10 points, and halves where the two differ by more than
/// the tolerance, which is absolute and shared out over the halves, and by more than rounding.
pub fn integrate(f: &dyn Fn(f64) -> f64, from: f64, to: f64, tolerance: f64) -> f64 {
    let rule = gauss_legendre(10, 0.0, 1.0);
    let over = |from: f64, to: f64| rule.iter().map(|&(x, weight)| weight * f(from + (to - from) * x)).sum::<f64>() * (to - from);
    refine(&over, [from, to], over(from, to), tolerance, DEEPEST)
}

fn refine(over: &dyn Fn(f64, f64) -> f64, [from, to]: [f64; 2], coarse: f64, tolerance: f64, depth_left: u32) -> f64 {
    let middle = 0.5 * (from + to);
    let [left, right] = [over(from, middle), over(middle, to)];
    let rounding = 4.0 * f64::EPSILON * (left.abs() + right.abs());
    if (left + right - coarse).abs() <= tolerance.max(rounding) || depth_left == 0 {
        return left + right;
    }
    let part = 0.5 * tolerance;
    refine(over, [from, middle], left, part, depth_left - 1) + refine(over, [middle, to], right, part, depth_left - 1)
}

/// The integral of a function over [from, ∞), where it decays at least like an exponential of the scale: by t = from + scale · u / (1 − u).
pub fn integrate_to_infinity(f: &dyn Fn(f64) -> f64, from: f64, scale: f64, tolerance: f64) -> f64 {
    let mapped = |u: f64| f(from + scale * u / (1.0 - u)) * scale / ((1.0 - u) * (1.0 - u));
    integrate(&mapped, 0.0, 1.0, tolerance)
}
