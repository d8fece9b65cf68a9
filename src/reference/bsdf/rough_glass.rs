//! Rough dielectrics (Walter et al. 2007).

use glam::DVec3;

use super::dielectric::{Dielectric, Split};
use super::fresnel::refract;
use super::lookup::Lookup;
use super::microfacet::Facets;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::view::View;
use crate::scene::material::SMALLEST_BEND;
use crate::scene::{MaterialKind, MicrofacetDistribution};

/// Every microfacet m reflects and refracts as smooth glass does. With η the index of refraction on wi's side over that on wo's,
/// and all directions in the frame of the shading normal on wo's side:
///
/// - reflected, m = (wo + wi) normalised: f·cosθi = F·D·G2/(4·cosθo), density P·D·G1/(4·cosθo);
/// - transmitted, m = −(wo + η·wi) normalised, on wo's side: the density of m times |∂m/∂wi| = η²·|wi·m|/(wo·m + η·wi·m)², times
///   1 − P; and f·cosθi = (1−F)·D·G2·(wo·m)·|wi·m|/(cosθo·(wo·m + η·wi·m)²). This is Walter's equation 21 for radiance seen from
///   wo: the factor η² of the solid angles' ratio and the 1/η² by which radiance scales cancel.
///
/// F and P, the probability of choosing reflection, are taken at wo·m. A side of wi belongs to one of the two alone, so the sums
/// that evaluation needs have one term.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoughGlass {
    pub dielectric: Dielectric,
    pub facets: Facets,
}

impl RoughGlass {
    fn evaluate_reflection(&self, wo: DVec3, wi: DVec3, eta: f64) -> Option<Evaluation> {
        let m = (wo + wi).normalize();
        let Split { fresnel, choose_reflection } = self.dielectric.split(wo.dot(m), eta)?;
        let unshadowed = self.facets.distribution(m) / (4.0 * wo.z);
        let value = self.dielectric.reflectance * (fresnel * unshadowed * self.facets.shadowing_masking(wo, wi));
        Some(Evaluation { value, pdf: choose_reflection * unshadowed * self.facets.masking(wo) })
    }

    fn evaluate_transmission(&self, wo: DVec3, wi: DVec3, eta: f64) -> Option<Evaluation> {
        let sum = (wo + wi * eta).try_normalize()?;
        // The facet's normal is on the side of the surface's, whichever side is the denser.
        let m = if sum.z < 0.0 { -sum } else { sum };
        let (cos_o, cos_i) = (wo.dot(m), wi.dot(m));
        if cos_o <= 0.0 || cos_i >= 0.0 {
            // The facet is seen from its back: no refraction takes wo to wi.
            return None;
        }
        let Split { fresnel, choose_reflection } = self.dielectric.split(cos_o, eta)?;
        let common = self.facets.distribution(m) * cos_o * -cos_i / (wo.z * (cos_o + eta * cos_i).powi(2));
        let value = self.dielectric.transmittance * ((1.0 - fresnel) * common * self.facets.shadowing_masking(wo, wi));
        Some(Evaluation { value, pdf: (1.0 - choose_reflection) * common * self.facets.masking(wo) * eta * eta })
    }
}

impl Scatter for RoughGlass {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::RoughGlass { ior, facets, reflectance, transmittance, thin: false, film: None, dispersion: None } =
            kind
        else {
            return None;
        };
        if facets.distribution == MicrofacetDistribution::Phong {
            return None;
        }
        let dielectric = Dielectric::new(*ior, reflectance, transmittance, lookup);
        Some(Self { dielectric, facets: Facets::of(facets, lookup) })
    }

    fn sampling_weight(&self) -> f64 {
        self.dielectric.sampling_weight()
    }

    /// The glass is smooth, or hardly bends light.
    fn is_delta(&self) -> bool {
        self.facets.are_smooth() || (self.dielectric.ior - 1.0).abs() < SMALLEST_BEND
    }

    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        if self.is_delta() {
            return Evaluation::default();
        }
        let frame = view.facet_frame(self.facets.anisotropic);
        let (wo, local) = (frame.to_local(view.wo), frame.to_local(wi));
        let eta = self.dielectric.eta(view);
        let evaluated = if view.reflects(wi) {
            self.evaluate_reflection(wo, local, eta)
        } else if view.transmits(wi) {
            self.evaluate_transmission(wo, local, eta)
        } else {
            None
        };
        evaluated.unwrap_or_default()
    }

    /// Value over density leaves F·ρ·G2/(G1·P) for the reflection and (1−F)·τ·G2/(G1·(1−P)·η²) for the transmission. What a facet
    /// sends to the wrong side of the surface is lost.
    fn sample(&self, view: &View, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        if self.is_delta() {
            return self.dielectric.sample_delta(view, u_lobe);
        }
        let frame = view.facet_frame(self.facets.anisotropic);
        let wo = frame.to_local(view.wo);
        let eta = self.dielectric.eta(view);
        let m = self.facets.sample_visible(wo, u1, u2);
        let cos_o = wo.dot(m);
        let Split { fresnel, choose_reflection } = self.dielectric.split(cos_o, eta)?;
        let shadowing = |wi: DVec3| self.facets.shadowing_of_visible(wo, wi);
        let facet_pdf = self.facets.visible_pdf(wo, m);
        if u_lobe < choose_reflection {
            let local = m * (2.0 * cos_o) - wo;
            let wi = frame.to_world(local).normalize();
            let weight = self.dielectric.reflectance * (fresnel / choose_reflection * shadowing(local));
            let density = Density::SolidAngle(choose_reflection * facet_pdf / (4.0 * cos_o));
            return view.reflects(wi).then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, density) });
        }
        let local = refract(wo, m, eta)?;
        let wi = frame.to_world(local).normalize();
        let cos_i = local.dot(m);
        let weight = (1.0 - fresnel) / (1.0 - choose_reflection) * shadowing(local) / (eta * eta);
        let jacobian = eta * eta * -cos_i / (cos_o + eta * cos_i).powi(2);
        let density = Density::SolidAngle((1.0 - choose_reflection) * facet_pdf * jacobian);
        let weight = self.dielectric.transmittance * weight;
        view.transmits(wi).then_some(BsdfSample { wi, weight, density, eta, is_null: false })
    }
}
