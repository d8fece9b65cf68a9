//! Lambert's lobe.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::{BsdfSample, Density, Evaluation, View};
use crate::reference::warp;

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
        Evaluation { value: self.reflectance * (FRAC_1_PI * cos_theta), pdf: warp::cosine_hemisphere_pdf(cos_theta) }
    }

    /// (ρ/π)·cosθ over the density cosθ/π leaves ρ.
    pub fn sample(&self, view: &View, u1: f64, u2: f64) -> Option<BsdfSample> {
        let local = warp::cosine_hemisphere(u1, u2);
        let wi = view.frame.to_world(local);
        let density = Density::Smooth(warp::cosine_hemisphere_pdf(local.z));
        view.reflects(wi).then_some(BsdfSample { weight: self.reflectance, ..BsdfSample::reflected(wi, density) })
    }
}
