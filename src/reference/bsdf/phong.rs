//! The modified Phong model.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::hemisphere::{hemisphere_pdf, sample_hemisphere};
use super::lookup::Lookup;
use super::phong_lobe::PhongLobe;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::view::View;
use crate::scene::MaterialKind;
use crate::spectrum::Spectrum;

/// f = kd/π + ks (n+2)/(2π) cosⁿα, α the angle with the mirror direction (Lafortune and Willems 1994).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phong {
    pub diffuse: Spectrum,
    pub specular: Spectrum,
    /// Not negative.
    pub exponent: f64,
}

impl Phong {
    /// Probability of sampling the specular lobe: Σks / (Σkd + Σks).
    fn specular_share(&self) -> f64 {
        let (diffuse, specular) = (self.diffuse.sum(), self.specular.sum());
        specular / (diffuse + specular)
    }
}

impl Scatter for Phong {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::Phong { diffuse, specular, exponent } = kind else { return None };
        Some(Self { diffuse: lookup.color(diffuse), specular: lookup.color(specular), exponent: lookup.exponent(exponent) })
    }

    fn sampling_weight(&self) -> f64 {
        (self.diffuse + self.specular).max_component()
    }

    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        if !view.reflects(wi) {
            return Evaluation::default();
        }
        let cos_theta = wi.dot(view.normal());
        let (specular, specular_pdf) = PhongLobe { exponent: self.exponent }.evaluate(view, wi);
        let share = self.specular_share();
        let pdf = share * specular_pdf + (1.0 - share) * hemisphere_pdf(view, cos_theta);
        Evaluation { value: self.diffuse * (FRAC_1_PI * cos_theta) + self.specular * specular, pdf }
    }

    fn sample(&self, view: &View, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        let wi = if u_lobe < self.specular_share() {
            PhongLobe { exponent: self.exponent }.sample(view, u1, u2)
        } else {
            view.frame.to_world(sample_hemisphere(view, u1, u2))
        };
        let Evaluation { value, pdf } = self.evaluate(view, wi);
        (pdf > 0.0).then_some(BsdfSample { weight: value / pdf, ..BsdfSample::reflected(wi, Density::SolidAngle(pdf)) })
    }
}
