//! Rough dielectrics with cosine-power lobes.

use glam::DVec3;

use super::cosine_power::sample_about;
use super::dielectric::{Dielectric, Split};
use super::fresnel::refract;
use super::lookup::Lookup;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::view::View;
use crate::reference::warp;
use crate::scene::{MaterialKind, MicrofacetDistribution};

/// The directions of smooth glass, each widened to a lobe (n+1)/(2π)·cosⁿα about it (Honsdorf 2013, section 5.3). Fresnel's F is
/// taken at the shading normal: f·cosθi = F·ρ·lobe above the surface and (1−F)·τ/η²·lobe below it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhongGlass {
    pub dielectric: Dielectric,
    /// Not negative.
    pub exponent: f64,
}

impl PhongGlass {
    fn evaluate_side(&self, view: &View, wi: DVec3) -> Option<Evaluation> {
        let eta = self.dielectric.eta(view);
        let Split { fresnel, choose_reflection } = self.dielectric.split(view.wo.dot(view.normal()), eta)?;
        let lobe = |axis: DVec3| warp::phong_lobe_pdf(self.exponent, wi.dot(axis));
        if view.reflects(wi) {
            let lobe = lobe(view.mirrored());
            Some(Evaluation { value: self.dielectric.reflectance * (fresnel * lobe), pdf: choose_reflection * lobe })
        } else if view.transmits(wi) {
            let lobe = lobe(refract(view.wo, view.normal(), eta)?);
            let value = self.dielectric.transmittance * ((1.0 - fresnel) / (eta * eta) * lobe);
            Some(Evaluation { value, pdf: (1.0 - choose_reflection) * lobe })
        } else {
            None
        }
    }
}

impl Scatter for PhongGlass {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::RoughGlass { ior, facets, reflectance, transmittance, thin: _, film: None, dispersion: None } = kind
        else {
            return None;
        };
        if facets.distribution != MicrofacetDistribution::Phong {
            return None;
        }
        let dielectric = Dielectric::new(*ior, reflectance, transmittance, lookup);
        Some(Self { dielectric, exponent: lookup.exponent(&facets.alpha) })
    }

    fn sampling_weight(&self) -> f64 {
        self.dielectric.sampling_weight()
    }

    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        self.evaluate_side(view, wi).unwrap_or_default()
    }

    /// The weights are those of smooth glass. What falls on the wrong side of the surface is lost.
    fn sample(&self, view: &View, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        let eta = self.dielectric.eta(view);
        let Split { fresnel, choose_reflection } = self.dielectric.split(view.wo.dot(view.normal()), eta)?;
        if u_lobe < choose_reflection {
            let (wi, pdf) = sample_about(view.mirrored(), self.exponent, u1, u2);
            let weight = self.dielectric.reflectance * (fresnel / choose_reflection);
            let density = Density::SolidAngle(choose_reflection * pdf);
            return view.reflects(wi).then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, density) });
        }
        let (wi, pdf) = sample_about(refract(view.wo, view.normal(), eta)?, self.exponent, u1, u2);
        let weight = self.dielectric.transmittance * ((1.0 - fresnel) / (1.0 - choose_reflection) / (eta * eta));
        let density = Density::SolidAngle((1.0 - choose_reflection) * pdf);
        view.transmits(wi).then_some(BsdfSample { wi, weight, density, eta, is_null: false })
    }
}
