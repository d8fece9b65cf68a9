//! A sky: from the horizon up, `horizon` to `zenith` in proportion to the direction's height y; `ground` below.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::DVec3;

use super::outside::{Environment, EnvironmentSample, Outside};
use crate::sampling::sampler::uniform;
use crate::scene::Sky;
use crate::spectrum::Spectrum;

pub fn new(sky: &Sky) -> Outside {
    Outside::Varying(Arc::new(*sky))
}

impl Environment for Sky {
    fn radiance(&self, wi: DVec3) -> Spectrum {
        if wi.y >= 0.0 { self.horizon.lerp(self.zenith, wi.y) } else { self.ground }
    }

    /// In proportion to luminance: the half first, then, above, a height whose density is linear.
    fn sample(&self, bits_u: u32, bits_v: u32) -> Option<EnvironmentSample> {
        let (u1, u2) = (uniform(bits_u), uniform(bits_v));
        let [upper, lower] = halves(self);
        let share = upper / (upper + lower);
        let height = if u1 < share {
            let (h, z) = (self.horizon.luminance(), self.zenith.luminance());
            let xi = u1 / share;
            // The root of h·y + (z − h)·y²/2 = ξ·(h + z)/2 that does not cancel; a black horizon has ξ = 0 only where nothing comes
            // from.
            let denominator = h + (h * h + xi * (z * z - h * h)).max(0.0).sqrt();
            if denominator > 0.0 { (xi * (h + z) / denominator).min(1.0) } else { 0.0 }
        } else {
            (u1 - 1.0) / (1.0 - share)
        };
        let sine = ((1.0 - height) * (1.0 + height)).max(0.0).sqrt();
        let (sin_phi, cos_phi) = (TAU * u2).sin_cos();
        let wi = DVec3::new(sine * cos_phi, height, sine * sin_phi);
        let radiance = if u1 < share { self.horizon.lerp(self.zenith, height) } else { self.ground };
        let pdf = radiance.luminance() / (upper + lower);
        (pdf > 0.0).then_some(EnvironmentSample { wi, radiance, pdf })
    }

    fn pdf(&self, wi: DVec3) -> f64 {
        self.radiance(wi).luminance() / integral(self)
    }

    fn mean_luminance(&self) -> f64 {
        integral(self) / (4.0 * PI)
    }
}

/// Integral of luminance over the upper and the lower half.
fn halves(sky: &Sky) -> [f64; 2] {
    [PI * (sky.zenith.luminance() + sky.horizon.luminance()), TAU * sky.ground.luminance()]
}

fn integral(sky: &Sky) -> f64 {
    halves(sky).iter().sum()
}
