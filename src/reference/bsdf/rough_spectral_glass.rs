//! Rough dielectrics whose channels are not refracted or reflected alike.

use glam::DVec3;

use super::channels::choose_channel;
use super::fresnel::refract;
use super::lookup::Lookup;
use super::microfacet::Facets;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::spectral_dielectric::SpectralDielectric;
use super::spectral_glass::SpectralGlass;
use super::view::View;
use crate::scene::material::{SMALLEST_BEND, iors};
use crate::scene::{MaterialKind, MicrofacetDistribution};
use crate::spectrum::Spectrum;

/// Every microfacet does what a smooth [`SpectralDielectric`] does, by the equations of [`super::rough_glass::RoughGlass`] for each channel. A direction on the far
/// side has another facet for each of them, and each may have drawn it: its density is the sum over the channels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoughSpectralGlass {
    pub dielectric: SpectralDielectric,
    pub facets: Facets,
}

impl RoughSpectralGlass {
    fn evaluate_reflection(&self, view: &View, wo: DVec3, wi: DVec3) -> Option<Evaluation> {
        let m = (wo + wi).normalize();
        let ways = self.dielectric.ways(view, wo.dot(m))?;
        let unshadowed = self.facets.distribution(m) / (4.0 * wo.z);
        let value = self.dielectric.reflectance * ways.reflected * (unshadowed * self.facets.shadowing_masking(wo, wi));
        Some(Evaluation { value, pdf: ways.reflection * unshadowed * self.facets.masking(wo) })
    }

    /// Light of one channel, and the density with which that channel draws it.
    fn evaluate_channel(&self, view: &View, channel: usize, wo: DVec3, wi: DVec3) -> Option<[f64; 2]> {
        let eta = self.dielectric.etas(view).to_rgb()[channel];
        let sum = (wo + wi * eta).try_normalize()?;
        let m = if sum.z < 0.0 { -sum } else { sum };
        let (cos_o, cos_i) = (wo.dot(m), wi.dot(m));
        if cos_o <= 0.0 || cos_i >= 0.0 {
            return None;
        }
        let ways = self.dielectric.ways(view, cos_o)?;
        let common = self.facets.distribution(m) * cos_o * -cos_i / (wo.z * (cos_o + eta * cos_i).powi(2));
        let passed = self.dielectric.transmittance.to_rgb()[channel] * (1.0 - ways.reflected.to_rgb()[channel]);
        let value = passed * common * self.facets.shadowing_masking(wo, wi);
        Some([value, ways.transmission[channel] * common * self.facets.masking(wo) * eta * eta])
    }
}

impl Scatter for RoughSpectralGlass {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::RoughGlass { ior, facets, reflectance, transmittance, film, dispersion, .. } = kind else {
            return None;
        };
        if facets.distribution == MicrofacetDistribution::Phong || film.is_none() && dispersion.is_none() {
            return None;
        }
        let dielectric = SpectralDielectric::new(iors(*ior, *dispersion), [reflectance, transmittance], film.as_ref(), lookup);
        Some(Self { dielectric, facets: Facets::of(facets, lookup) })
    }

    fn sampling_weight(&self) -> f64 {
        self.dielectric.sampling_weight()
    }

    /// The glass is smooth, or hardly bends light of any channel.
    fn is_delta(&self) -> bool {
        self.facets.are_smooth() || self.dielectric.iors.to_rgb().iter().all(|ior| (ior - 1.0).abs() < SMALLEST_BEND)
    }

    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        if self.is_delta() {
            return Evaluation::default();
        }
        let frame = view.facet_frame(self.facets.anisotropic);
        let (wo, local) = (frame.to_local(view.wo), frame.to_local(wi));
        if view.reflects(wi) {
            self.evaluate_reflection(view, wo, local).unwrap_or_default()
        } else if view.transmits(wi) {
            let channels = [0, 1, 2].map(|channel| self.evaluate_channel(view, channel, wo, local).unwrap_or_default());
            let value = Spectrum::from_rgb(channels.map(|[value, _]| value));
            Evaluation { value, pdf: channels.iter().map(|[_, pdf]| pdf).sum() }
        } else {
            Evaluation::default()
        }
    }

    fn sample(&self, view: &View, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        if self.is_delta() {
            return SpectralGlass::sample_delta(&self.dielectric, view, u_lobe);
        }
        let frame = view.facet_frame(self.facets.anisotropic);
        let wo = frame.to_local(view.wo);
        let m = self.facets.sample_visible(wo, u1, u2);
        let cosine = wo.dot(m);
        let ways = self.dielectric.ways(view, cosine)?;
        let reflects = u_lobe < ways.reflection;
        let (local, eta) = if reflects {
            (m * (2.0 * cosine) - wo, 1.0)
        } else {
            let eta = self.dielectric.etas(view).to_rgb()[choose_channel(ways.transmission, u_lobe - ways.reflection)?.0];
            (refract(wo, m, eta)?, eta)
        };
        let wi = frame.to_world(local).normalize();
        if !(if reflects { view.reflects(wi) } else { view.transmits(wi) }) {
            return None;
        }
        let Evaluation { value, pdf } = self.evaluate(view, wi);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value / pdf, density: Density::SolidAngle(pdf), eta, is_null: false })
    }
}
