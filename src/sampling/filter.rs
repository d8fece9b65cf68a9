//! Reconstruction filters as sample maps: the position of a sample is drawn from the filter itself, so that every sample has weight 1
//! (filter importance sampling, Ernst, Stamminger and Greiner 2006).
//!
//! Each coordinate is drawn on its own, as all filters are products of two. A box and a tent have inverse cumulative distributions
//! in closed form; those of the bells are tabulated as a monotone piecewise cubic.

use std::f64::consts::PI;

use crate::scene::{Filter, FilterKind};

/// Pieces of the curve that stands for a bell's inverse cumulative distribution.
pub const CURVE_PIECES: usize = 32;

/// Standard deviations of the gaussian that fit into its radius.
const GAUSSIAN_DEVIATIONS: f64 = 3.0;
/// The four-term window of Blackman and Harris (Harris 1978), around its centre.
const BLACKMAN_HARRIS: [f64; 4] = [0.35875, 0.48829, 0.14128, 0.01168];

/// Height of the filter at `x` radii from its centre, not normalised; 0 beyond the radius.
///
/// The gaussian has a standard deviation of a third of the radius and is lowered so that it is 0 there.
pub fn height(kind: FilterKind, x: f64) -> f64 {
    if x.abs() > 1.0 {
        return 0.0;
    }
    let gaussian = |x: f64| (-0.5 * (GAUSSIAN_DEVIATIONS * x).powi(2)).exp();
    match kind {
        FilterKind::Box => 1.0,
        FilterKind::Tent => 1.0 - x.abs(),
        FilterKind::Gaussian => gaussian(x) - gaussian(1.0),
        FilterKind::BlackmanHarris => (0..4).map(|k| BLACKMAN_HARRIS[k] * (PI * k as f64 * x).cos()).sum(),
    }
}

/// A filter ready to draw samples from.
#[derive(Debug, Clone, PartialEq)]
pub struct FilterSampler {
    kind: FilterKind,
    radius: f64,
    curve: Curve,
}

impl FilterSampler {
    pub fn new(filter: Filter) -> Self {
        let curve = match filter.kind {
            FilterKind::Box | FilterKind::Tent => [[0.0; 4]; CURVE_PIECES],
            FilterKind::Gaussian | FilterKind::BlackmanHarris => curve(filter.kind),
        };
        Self { kind: filter.kind, radius: filter.radius, curve }
    }

    /// Coordinate of a sample relative to the pixel's centre, in pixels, from a uniform number of [0, 1). One half gives exactly 0.
    pub fn offset(&self, u: f64) -> f64 {
        let signed = 2.0 * u - 1.0;
        let tail = 1.0 - signed.abs();
        let distance = match self.kind {
            FilterKind::Box => return self.radius * signed,
            FilterKind::Tent => 1.0 - tail.sqrt(),
            FilterKind::Gaussian | FilterKind::BlackmanHarris => evaluate(&self.curve, 1.0 - tail.sqrt().sqrt()),
        };
        self.radius * distance.copysign(signed)
    }

    /// Coefficients for the device; all 0 where there is a closed form.
    pub fn curve(&self) -> &Curve {
        &self.curve
    }
}

/// Coefficients of 1, s, s², s³ of each piece, s from 0 to 1 within it. In f32, so that every device has the same curve.
pub type Curve = [[f32; 4]; CURVE_PIECES];

/// The curve at `w` in [0, 1].
fn evaluate(curve: &Curve, w: f64) -> f64 {
    let scaled = w * CURVE_PIECES as f64;
    let piece = (scaled as usize).min(CURVE_PIECES - 1);
    let s = scaled - piece as f64;
    let [a, b, c, d] = curve[piece].map(f64::from);
    a + s * (b + s * (c + s * d))
}

/// Distance from the centre, in radii, as a function of w = 1 − t¼, where t is the share of the filter further out.
///
/// With the fourth root the curve is smooth up to the radius, where bells have almost no mass and the inverse distribution itself
/// is nearly vertical.
fn curve(kind: FilterKind) -> Curve {
    let tails = tails(kind);
    let mass = tails[0];
    let step = 1.0 / (tails.len() - 1) as f64;
    let distance = |tail: f64| {
        // Tails shrink outward.
        let outer = tails.partition_point(|&t| t >= tail * mass).min(tails.len() - 1);
        let inner = outer.saturating_sub(1);
        let span = tails[inner] - tails[outer];
        let share = if span > 0.0 { (tails[inner] - tail * mass) / span } else { 0.0 };
        (inner as f64 + share.clamp(0.0, 1.0)) * step
    };
    let knot = |k: usize| 1.0 - k as f64 / CURVE_PIECES as f64;
    let values: Vec<f64> = (0..=CURVE_PIECES).map(|k| distance(knot(k).powi(4))).collect();
    let secant = |k: usize| values[k + 1] - values[k];
    // Per piece: d(distance)/dw is 4 (1 − w)³ over the density; at most three times the secants, which keeps cubics monotone
    // (Fritsch and Carlson 1980).
    let slope = |k: usize| {
        let derivative = 4.0 * knot(k).powi(3) * mass / (height(kind, values[k]).max(1e-12) * CURVE_PIECES as f64);
        let before = if k > 0 { secant(k - 1) } else { f64::INFINITY };
        let after = if k < CURVE_PIECES { secant(k) } else { f64::INFINITY };
        derivative.min(3.0 * before.min(after))
    };
    std::array::from_fn(|k| {
        let (rise, from, to) = (secant(k), slope(k), slope(k + 1));
        [values[k], from, 3.0 * rise - 2.0 * from - to, from + to - 2.0 * rise].map(|coefficient| coefficient as f32)
    })
}

/// Integral of the filter from each of many equally spaced distances to the radius, by Simpson's rule.
fn tails(kind: FilterKind) -> Vec<f64> {
    let steps = 1 << 14;
    let step = 1.0 / f64::from(steps);
    let mut tails = vec![0.0; steps as usize + 1];
    for index in (0..steps as usize).rev() {
        let x = index as f64 * step;
        let area = (height(kind, x) + 4.0 * height(kind, x + 0.5 * step) + height(kind, x + step)) * step / 6.0;
        tails[index] = tails[index + 1] + area;
    }
    tails
}

#[cfg(test)]
mod tests;
