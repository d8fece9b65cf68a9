//! Metals, rough or smooth.

use glam::DVec3;

use super::fresnel::{conductor_reflectance, schlick_reflectance};
use super::lookup::Lookup;
use super::microfacet::Ggx;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::view::View;
use crate::scene::material::DELTA_ALPHA;
use crate::scene::{ConductorFresnel, MaterialKind};

/// Mirrors in all directions of the GGX distribution: f = F·D·G2/(4·cosθo·cosθi) (Walter et al. 2007). What is reflected from one
/// microfacet to another is lost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conductor {
    pub fresnel: Fresnel,
    /// Width of the distribution; below [`DELTA_ALPHA`] a perfect mirror.
    pub alpha: f64,
}

/// What a metal reflects by angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fresnel {
    /// Complex index of refraction.
    Complex { eta: DVec3, k: DVec3 },
    /// Reflectance at normal incidence.
    Schlick(DVec3),
}

impl Fresnel {
    pub fn at(&self, cosine: f64) -> DVec3 {
        match *self {
            Self::Complex { eta, k } => conductor_reflectance(cosine, eta, k),
            Self::Schlick(normal_incidence) => schlick_reflectance(cosine, normal_incidence),
        }
    }
}

impl Scatter for Conductor {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::Conductor { fresnel, alpha } = kind else { return None };
        let fresnel = match fresnel {
            ConductorFresnel::Complex { eta, k } => Fresnel::Complex { eta: *eta, k: *k },
            ConductorFresnel::Reflectance(reflectance) => Fresnel::Schlick(lookup.color(reflectance)),
        };
        Some(Self { fresnel, alpha: lookup.scalar(alpha) })
    }

    fn sampling_weight(&self) -> f64 {
        self.fresnel.at(1.0).max_element()
    }

    fn is_delta(&self) -> bool {
        self.alpha < DELTA_ALPHA
    }

    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        if self.is_delta() || !view.reflects(wi) {
            return Evaluation::default();
        }
        let ggx = Ggx { alpha: self.alpha };
        let (wo, wi) = (view.frame.to_local(view.wo), view.frame.to_local(wi));
        let m = (wo + wi).normalize();
        let unshadowed = ggx.distribution(m) / (4.0 * wo.z);
        let value = self.fresnel.at(wo.dot(m)) * (unshadowed * ggx.shadowing_masking(wo, wi));
        Evaluation { value, pdf: unshadowed * ggx.masking(wo) }
    }

    /// With the density of visible normals, G1·D·(wo·m)/cosθo, over the Jacobian 4·(wo·m) of the reflection, F·G2/G1 is left.
    fn sample(&self, view: &View, _u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        if self.is_delta() {
            let (wi, weight) = (view.mirrored(), self.fresnel.at(view.wo.dot(view.normal())));
            return view.reflects(wi).then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, Density::Delta) });
        }
        let ggx = Ggx { alpha: self.alpha };
        let wo = view.frame.to_local(view.wo);
        let m = ggx.sample_visible(wo, u1, u2);
        let cosine = wo.dot(m);
        let local = m * (2.0 * cosine) - wo;
        let wi = view.frame.to_world(local).normalize();
        let weight = self.fresnel.at(cosine) * (ggx.shadowing_masking(wo, local) / ggx.masking(wo));
        let density = Density::SolidAngle(ggx.distribution(m) * ggx.masking(wo) / (4.0 * wo.z));
        view.reflects(wi).then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, density) })
    }
}
