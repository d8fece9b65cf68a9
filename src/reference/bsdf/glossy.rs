//! A cosine-power lobe about the mirror direction.

use glam::DVec3;

use super::cosine_power::{lobe_over_cosine, sample_about};
use super::lookup::Lookup;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::view::View;
use crate::reference::warp;
use crate::scene::MaterialKind;
use crate::spectrum::Spectrum;

/// f = ρ (n+2)/(2π) cosⁿα, α the angle with the mirror direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Glossy {
    pub reflectance: Spectrum,
    /// Not negative.
    pub exponent: f64,
}

impl Scatter for Glossy {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::Glossy { reflectance, exponent } = kind else { return None };
        Some(Self { reflectance: lookup.color(reflectance), exponent: lookup.exponent(exponent) })
    }

    fn sampling_weight(&self) -> f64 {
        self.reflectance.max_component()
    }

    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        if !view.reflects(wi) {
            return Evaluation::default();
        }
        let cos_alpha = wi.dot(view.mirrored());
        let f = self.reflectance * lobe_over_cosine(self.exponent, cos_alpha);
        Evaluation { value: f * wi.dot(view.normal()), pdf: warp::phong_lobe_pdf(self.exponent, cos_alpha) }
    }

    /// f·cosθ over the density leaves ρ·cosθ·(n+2)/(n+1). What falls below the horizon is lost.
    fn sample(&self, view: &View, _u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        let (wi, pdf) = sample_about(view.mirrored(), self.exponent, u1, u2);
        let weight = self.reflectance * (wi.dot(view.normal()) * (self.exponent + 2.0) / (self.exponent + 1.0));
        view.reflects(wi).then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, Density::SolidAngle(pdf)) })
    }
}
