//! A sheet that Lambert's law holds for on both sides.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::hemisphere::{hemisphere_pdf, hemisphere_weight, sample_hemisphere};
use super::lookup::Lookup;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::view::View;
use crate::scene::MaterialKind;
use crate::spectrum::Spectrum;

/// f = ρ/π on wo's side and τ/π on the other one, ρ + τ at most 1. A side is sampled in proportion to its largest channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiffuseTransmission {
    pub reflectance: Spectrum,
    pub transmittance: Spectrum,
}

impl DiffuseTransmission {
    /// The probability of a direction on wo's side.
    fn choose_reflection(&self) -> f64 {
        let (reflected, transmitted) = (self.reflectance.max_component(), self.transmittance.max_component());
        reflected / (reflected + transmitted)
    }
}

impl Scatter for DiffuseTransmission {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::DiffuseTransmission { reflectance, transmittance } = kind else { return None };
        let (reflectance, transmittance) = (lookup.color(reflectance), lookup.color(transmittance));
        let sum = (reflectance + transmittance).max(Spectrum::WHITE);
        Some(Self { reflectance: reflectance / sum, transmittance: transmittance / sum })
    }

    fn sampling_weight(&self) -> f64 {
        (self.reflectance + self.transmittance).max_component()
    }

    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        let choose_reflection = self.choose_reflection();
        let (color, probability) = if view.reflects(wi) {
            (self.reflectance, choose_reflection)
        } else if view.transmits(wi) {
            (self.transmittance, 1.0 - choose_reflection)
        } else {
            return Evaluation::default();
        };
        let cos_theta = wi.dot(view.normal()).abs();
        Evaluation { value: color * (FRAC_1_PI * cos_theta), pdf: probability * hemisphere_pdf(view, cos_theta) }
    }

    fn sample(&self, view: &View, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        let choose_reflection = self.choose_reflection();
        let local = sample_hemisphere(view, u1, u2);
        let (wi, color, probability, is_possible) = if u_lobe < choose_reflection {
            let wi = view.frame.to_world(local);
            (wi, self.reflectance, choose_reflection, view.reflects(wi))
        } else {
            let wi = view.frame.to_world(local.with_z(-local.z));
            (wi, self.transmittance, 1.0 - choose_reflection, view.transmits(wi))
        };
        let weight = color * (hemisphere_weight(view, local.z) / probability);
        let density = Density::SolidAngle(probability * hemisphere_pdf(view, local.z));
        is_possible.then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, density) })
    }
}
