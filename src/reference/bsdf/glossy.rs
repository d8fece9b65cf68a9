//! A cosine-power lobe about the mirror direction.

use glam::DVec3;

use super::lookup::Lookup;
use super::phong_lobe::PhongLobe;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::view::View;
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
        let (value, pdf) = PhongLobe { exponent: self.exponent }.evaluate(view, wi);
        Evaluation { value: self.reflectance * value, pdf }
    }

    /// f·cosθ over the density leaves ρ·cosθ·(n+2)/(n+1). What falls below the horizon is lost.
    fn sample(&self, view: &View, _u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        let wi = PhongLobe { exponent: self.exponent }.sample(view, u1, u2);
        let Evaluation { value, pdf } = self.evaluate(view, wi);
        (pdf > 0.0).then_some(BsdfSample { weight: value / pdf, ..BsdfSample::reflected(wi, Density::SolidAngle(pdf)) })
    }
}
