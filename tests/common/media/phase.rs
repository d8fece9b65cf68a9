//! Phase functions: how much of what is scattered goes where, per steradian. A cosine is that between the directions in which light travels before
//! and after, so 1 is straight on, and a positive mean cosine g scatters forward.

use std::f64::consts::{PI, TAU};

/// A phase function about the direction of travel.
#[derive(Debug, Clone, PartialEq)]
pub enum Phase {
    Isotropic,
    /// Henyey and Greenstein (1941), by the mean cosine.
    HenyeyGreenstein(f64),
    /// Small dipoles in unpolarised light.
    Rayleigh,
    /// The first, and the second with this weight.
    Blend(Box<Phase>, Box<Phase>, f64),
}

impl Phase {
    pub fn blend(first: Phase, second: Phase, weight: f64) -> Self {
        Self::Blend(Box::new(first), Box::new(second), weight)
    }

    /// The phase function per steradian.
    pub fn value(&self, cosine: f64) -> f64 {
        match self {
            Self::Isotropic => 0.25 / PI,
            Self::HenyeyGreenstein(g) => 0.25 / PI * (1.0 - g * g) / (1.0 + g * g - 2.0 * g * cosine).powf(1.5),
            Self::Rayleigh => 3.0 / (16.0 * PI) * (1.0 + cosine * cosine),
            Self::Blend(first, second, weight) => (1.0 - weight) * first.value(cosine) + weight * second.value(cosine),
        }
    }

    /// The probability of a cosine of at most this.
    pub fn cumulative(&self, cosine: f64) -> f64 {
        match self {
            Self::HenyeyGreenstein(g) if g.abs() > 1e-6 => {
                (1.0 - g * g) / (2.0 * g) * (1.0 / (1.0 + g * g - 2.0 * g * cosine).sqrt() - 1.0 / (1.0 + g))
            }
            // To first order in g.
            Self::HenyeyGreenstein(g) => 0.5 * (1.0 + cosine) - 0.75 * g * (1.0 - cosine * cosine),
            Self::Isotropic => 0.5 * (1.0 + cosine),
            Self::Rayleigh => 0.5 + 0.375 * (cosine + cosine.powi(3) / 3.0),
            Self::Blend(first, second, weight) => (1.0 - weight) * first.cumulative(cosine) + weight * second.cumulative(cosine),
        }
    }

    /// The mean of the Legendre polynomial of this degree of the cosine: 1 for degree 0, the mean cosine for degree 1.
    pub fn moment(&self, degree: usize) -> f64 {
        match (self, degree) {
            (Self::Blend(first, second, weight), _) => (1.0 - weight) * first.moment(degree) + weight * second.moment(degree),
            (_, 0) => 1.0,
            (Self::HenyeyGreenstein(g), _) => g.powi(degree as i32),
            (Self::Rayleigh, 2) => 0.1,
            _ => 0.0,
        }
    }

    /// The mean cosine.
    pub fn mean_cosine(&self) -> f64 {
        self.moment(1)
    }

    /// A cosine by the inversion of [`Self::cumulative`], by bisection.
    pub fn invert(&self, probability: f64) -> f64 {
        let (mut low, mut high) = (-1.0, 1.0);
        for _ in 0..60 {
            let middle: f64 = 0.5 * (low + high);
            if self.cumulative(middle) < probability {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }
}

/// The probability of a direction whose cosine lies between two values and whose azimuth lies in a part of the whole turn.
pub fn probability(phase: &Phase, [from, to]: [f64; 2], turn: f64) -> f64 {
    (phase.cumulative(to) - phase.cumulative(from)) * turn / TAU
}
