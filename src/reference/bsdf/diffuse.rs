//! Lambert's lobe.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::hemisphere::{hemisphere_pdf, hemisphere_weight, sample_hemisphere};
use super::lookup::Lookup;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::view::View;
use crate::scene::MaterialKind;
use crate::spectrum::Spectrum;

/// f = ρ/π.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Diffuse {
    pub reflectance: Spectrum,
}

impl Scatter for Diffuse {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::Diffuse { reflectance } = kind else { return None };
        Some(Self { reflectance: lookup.color(reflectance) })
    }

    fn sampling_weight(&self) -> f64 {
        self.reflectance.max_component()
    }

    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        if !view.reflects(wi) {
            return Evaluation::default();
        }
        let cos_theta = wi.dot(view.normal());
        Evaluation { value: self.reflectance * (FRAC_1_PI * cos_theta), pdf: hemisphere_pdf(view, cos_theta) }
    }

    fn sample(&self, view: &View, _u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        let local = sample_hemisphere(view, u1, u2);
        let wi = view.frame.to_world(local);
        let density = Density::SolidAngle(hemisphere_pdf(view, local.z));
        let weight = self.reflectance * hemisphere_weight(view, local.z);
        view.reflects(wi).then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, density) })
    }
}
