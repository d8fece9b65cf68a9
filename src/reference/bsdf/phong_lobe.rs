//! The cosine-power lobe about the mirror direction that `glossy` and `phong` have, as [`PhongStudy`](super::phong_study::PhongStudy) changes it.

use glam::DVec3;

use super::cosine_power::{lobe_over_cosine, sample_about};
use super::hemisphere::{hemisphere_pdf, sample_hemisphere};
use super::view::View;
use crate::reference::warp;
use crate::scene::{PhongCosine, PhongHorizon, PhongSampling};

/// f = (n+2)/(2π) cosⁿα, α the angle with the mirror direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhongLobe {
    /// Not negative.
    pub exponent: f64,
}

impl PhongLobe {
    /// f·cosθ, and the density per steradian of [`PhongLobe::sample`], for a direction above the surface.
    pub fn evaluate(self, view: &View, wi: DVec3) -> (f64, f64) {
        let (cos_theta, cos_alpha) = (wi.dot(view.normal()), wi.dot(view.mirrored()));
        let cos_alpha = match view.phong.horizon {
            PhongHorizon::Lost => cos_alpha,
            // The lobe below the surface, in the opposite direction, was turned up.
            PhongHorizon::Flipped => cos_alpha.abs(),
        };
        let f = lobe_over_cosine(self.exponent, cos_alpha);
        let value = match view.phong.cosine {
            PhongCosine::Kept => f * cos_theta,
            PhongCosine::Dropped => f,
        };
        let pdf = match view.phong.sampling {
            PhongSampling::Lobe => warp::phong_lobe_pdf(self.exponent, cos_alpha),
            PhongSampling::Hemisphere => hemisphere_pdf(view, cos_theta),
        };
        (value, pdf)
    }

    /// Draws a direction, which may be below the surface.
    pub fn sample(self, view: &View, u1: f64, u2: f64) -> DVec3 {
        if view.phong.sampling == PhongSampling::Hemisphere {
            return view.frame.to_world(sample_hemisphere(view, u1, u2));
        }
        let (wi, _) = sample_about(view.mirrored(), self.exponent, u1, u2);
        let is_flipped = view.phong.horizon == PhongHorizon::Flipped && wi.dot(view.normal()) < 0.0;
        if is_flipped { -wi } else { wi }
    }
}
