//! A thin plate of glass whose microfacets lie alike on both sides.

use glam::DVec3;

use super::dielectric::{Dielectric, Split};
use super::lookup::Lookup;
use super::microfacet::Facets;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::view::View;
use crate::scene::{MaterialKind, MicrofacetDistribution};

/// Every microfacet m is a thin plate ([`Dielectric::split_of_plate`] at wo·m). What it reflects goes where a metal's would; what it lets
/// through goes there too, but for the side: the direction is that of the reflection, mirrored in the surface. So is the transmission of
/// glTF's thin walls (KHR_materials_transmission). f·cosθi = T·D·G2/(4·cosθo) with m = (wo + wi') normalised, wi' being wi mirrored in the
/// surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoughThinGlass {
    pub dielectric: Dielectric,
    pub facets: Facets,
}

/// Mirrored in the surface.
fn across(local: DVec3) -> DVec3 {
    DVec3::new(local.x, local.y, -local.z)
}

impl Scatter for RoughThinGlass {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::RoughGlass { ior, facets, reflectance, transmittance, thin: true, film: None, dispersion: None } = kind
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

    fn is_delta(&self) -> bool {
        self.facets.are_smooth()
    }

    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        let reflects = view.reflects(wi);
        if self.is_delta() || !reflects && !view.transmits(wi) {
            return Evaluation::default();
        }
        let frame = view.facet_frame(self.facets.anisotropic);
        let (wo, local) = (frame.to_local(view.wo), frame.to_local(wi));
        let local = if reflects { local } else { across(local) };
        let m = (wo + local).normalize();
        let Some(Split { fresnel, choose_reflection }) = self.dielectric.split_of_plate(wo.dot(m)) else {
            return Evaluation::default();
        };
        let unshadowed = self.facets.distribution(m) / (4.0 * wo.z);
        let (share, probability) = if reflects {
            (self.dielectric.reflectance * fresnel, choose_reflection)
        } else {
            (self.dielectric.transmittance * (1.0 - fresnel), 1.0 - choose_reflection)
        };
        let value = share * (unshadowed * self.facets.shadowing_masking(wo, local));
        Evaluation { value, pdf: probability * unshadowed * self.facets.masking(wo) }
    }

    /// Value over density leaves the share over its probability, times G2/G1.
    fn sample(&self, view: &View, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        if self.is_delta() {
            return self.dielectric.sample_delta_plate(view, u_lobe);
        }
        let frame = view.facet_frame(self.facets.anisotropic);
        let wo = frame.to_local(view.wo);
        let m = self.facets.sample_visible(wo, u1, u2);
        let cosine = wo.dot(m);
        let Split { fresnel, choose_reflection } = self.dielectric.split_of_plate(cosine)?;
        let local = m * (2.0 * cosine) - wo;
        if local.z <= 0.0 {
            return None;
        }
        let shadowing = self.facets.shadowing_of_visible(wo, local);
        let facet_pdf = self.facets.visible_pdf(wo, m) / (4.0 * cosine);
        let (local, share, probability) = if u_lobe < choose_reflection {
            (local, self.dielectric.reflectance * fresnel, choose_reflection)
        } else {
            (across(local), self.dielectric.transmittance * (1.0 - fresnel), 1.0 - choose_reflection)
        };
        let wi = frame.to_world(local).normalize();
        let is_possible = if u_lobe < choose_reflection { view.reflects(wi) } else { view.transmits(wi) };
        let weight = share * (shadowing / probability);
        let density = Density::SolidAngle(probability * facet_pdf);
        is_possible.then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, density) })
    }
}
