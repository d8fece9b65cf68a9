//! Plastic with a rough surface.

use glam::DVec3;

use super::fresnel::dielectric_reflectance;
use super::hemisphere::{hemisphere_pdf, sample_hemisphere};
use super::lookup::Lookup;
use super::microfacet::Facets;
use super::plastic::Base;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::view::View;
use crate::scene::MaterialKind;
use crate::scene::material::TRANSMITTANCE_NODES;

/// A base as that of smooth plastic below a boundary of microfacets, f = F·D·G2/(4·cosθo·cosθi). What goes in, and out, is what those let
/// through at that angle, T(θ), the share that rough glass transmits; it stands in a table. So is Mitsuba's model.
///
/// Rough plastic. Light that one microfacet sends to another is lost, as everywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoughPlastic {
    pub base: Base,
    pub facets: Facets,
    /// T at cosines from 0 to 1 in even steps.
    pub transmittance: [f32; TRANSMITTANCE_NODES],
}

impl RoughPlastic {
    /// T, linear between the entries of the table.
    fn transmitted(&self, cosine: f64) -> f64 {
        let last = TRANSMITTANCE_NODES - 1;
        let place = cosine.clamp(0.0, 1.0) * last as f64;
        let below = (place as usize).min(last - 1);
        let [low, high] = [self.transmittance[below], self.transmittance[below + 1]].map(f64::from);
        low + (high - low) * (place - below as f64)
    }
}

impl Scatter for RoughPlastic {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::Plastic { interface, .. } = kind else { return None };
        let transmittance = *interface.transmittance_table()?;
        Some(Self { base: Base::of(kind, lookup)?, facets: Facets::of_plastic(interface), transmittance })
    }

    fn sampling_weight(&self) -> f64 {
        self.base.sampling_weight()
    }

    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        if !view.reflects(wi) {
            return Evaluation::default();
        }
        let (wo, wi) = (view.frame.to_local(view.wo), view.frame.to_local(wi));
        let m = (wo + wi).normalize();
        let unshadowed = self.facets.distribution(m) / (4.0 * wo.z);
        let reflected = dielectric_reflectance(wo.dot(m).min(1.0), self.base.ior);
        let specular = self.base.specular * (reflected * unshadowed * self.facets.shadowing_masking(wo, wi));
        let transmitted = self.transmitted(wo.z);
        let diffuse = self.base.value(transmitted, self.transmitted(wi.z)) * wi.z;
        let probability = self.base.choose_specular(1.0 - transmitted);
        let pdf = probability * unshadowed * self.facets.masking(wo) + (1.0 - probability) * hemisphere_pdf(view, wi.z);
        Evaluation { value: specular + diffuse, pdf }
    }

    fn sample(&self, view: &View, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        let wo = view.frame.to_local(view.wo);
        let local = if u_lobe < self.base.choose_specular(1.0 - self.transmitted(wo.z)) {
            let m = self.facets.sample_visible(wo, u1, u2);
            m * (2.0 * wo.dot(m)) - wo
        } else {
            sample_hemisphere(view, u1, u2)
        };
        let wi = view.frame.to_world(local).normalize();
        let Evaluation { value, pdf } = self.evaluate(view, wi);
        (pdf > 0.0).then(|| BsdfSample { weight: value / pdf, ..BsdfSample::reflected(wi, Density::SolidAngle(pdf)) })
    }
}
