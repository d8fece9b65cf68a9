//! Lambert's lobe.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::{BsdfSample, Density, Evaluation, View};
use crate::reference::warp;
use crate::scene::HemisphereSampling;

/// f = ρ/π.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Diffuse {
    pub reflectance: DVec3,
}

impl Diffuse {
    pub fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        if !view.reflects(wi) {
            return Evaluation::default();
        }
        let cos_theta = wi.dot(view.normal());
        Evaluation { value: self.reflectance * (FRAC_1_PI * cos_theta), pdf: hemisphere_pdf(view, cos_theta) }
    }

    /// (ρ/π)·cosθ over the density cosθ/π leaves ρ; over the uniform 1/2π, 2ρ·cosθ.
    pub fn sample(&self, view: &View, u1: f64, u2: f64) -> Option<BsdfSample> {
        let local = sample_hemisphere(view, u1, u2);
        let wi = view.frame.to_world(local);
        let density = Density::Smooth(hemisphere_pdf(view, local.z));
        let weight = match view.hemisphere {
            HemisphereSampling::Cosine => self.reflectance,
            HemisphereSampling::Uniform => self.reflectance * (2.0 * local.z),
        };
        view.reflects(wi).then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, density) })
    }
}

/// A direction about z, in proportion to its cosine or uniform.
pub fn sample_hemisphere(view: &View, u1: f64, u2: f64) -> DVec3 {
    match view.hemisphere {
        HemisphereSampling::Cosine => warp::cosine_hemisphere(u1, u2),
        HemisphereSampling::Uniform => warp::uniform_hemisphere(u1, u2),
    }
}

/// Density of [`sample_hemisphere`] per steradian.
pub fn hemisphere_pdf(view: &View, cos_theta: f64) -> f64 {
    match view.hemisphere {
        HemisphereSampling::Cosine => warp::cosine_hemisphere_pdf(cos_theta),
        HemisphereSampling::Uniform => warp::UNIFORM_HEMISPHERE_PDF,
    }
}
