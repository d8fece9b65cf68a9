//! A cosine-power lobe about the mirror direction.

use std::f64::consts::TAU;

use glam::DVec3;

use super::mirror::reflect;
use super::{BsdfSample, Density, Evaluation, View};
use crate::math::Frame;
use crate::reference::warp;

/// f = ρ (n+2)/(2π) cosⁿα, α the angle with the mirror direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Glossy {
    pub reflectance: DVec3,
    /// Not negative.
    pub exponent: f64,
}

impl Glossy {
    pub fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        if !view.reflects(wi) {
            return Evaluation::default();
        }
        let cos_alpha = wi.dot(reflect(view));
        let f = self.reflectance * lobe_over_cosine(self.exponent, cos_alpha);
        Evaluation { value: f * wi.dot(view.normal()), pdf: warp::phong_lobe_pdf(self.exponent, cos_alpha) }
    }

    /// f·cosθ over the density leaves ρ·cosθ·(n+2)/(n+1). What falls below the horizon is lost.
    pub fn sample(&self, view: &View, u1: f64, u2: f64) -> Option<BsdfSample> {
        let (wi, pdf) = sample_about(reflect(view), self.exponent, u1, u2);
        let weight = self.reflectance * (wi.dot(view.normal()) * (self.exponent + 2.0) / (self.exponent + 1.0));
        view.reflects(wi).then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, Density::Smooth(pdf)) })
    }
}

/// (n+2)/(2π) cosⁿα, 0 past a right angle even where the exponent is 0: no direction there is ever drawn.
pub fn lobe_over_cosine(exponent: f64, cos_alpha: f64) -> f64 {
    if cos_alpha > 0.0 { (exponent + 2.0) / TAU * cos_alpha.powf(exponent) } else { 0.0 }
}

/// Draws a direction from the lobe cosⁿα about `axis`, and gives its density per steradian.
pub fn sample_about(axis: DVec3, exponent: f64, u1: f64, u2: f64) -> (DVec3, f64) {
    let local = warp::phong_lobe(exponent, u1, u2);
    (Frame::around(axis).to_world(local), warp::phong_lobe_pdf(exponent, local.z))
}
