//! Metals, rough or smooth.

use glam::DVec3;

use super::fresnel::{conductor_reflectance, schlick_reflectance};
use super::lookup::Lookup;
use super::microfacet::Facets;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::thin_film::ThinFilm;
use super::view::View;
use crate::scene::{ConductorFresnel, MaterialKind};
use crate::spectrum::Spectrum;

/// Mirrors in all directions of the microfacets: f = F·D·G2/(4·cosθo·cosθi) (Walter et al. 2007). What is reflected from one
/// microfacet to another is lost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conductor {
    pub fresnel: Fresnel,
    /// Smooth ones are a perfect mirror.
    pub facets: Facets,
    /// Factor of what is reflected.
    pub tint: Spectrum,
    pub film: Option<ThinFilm>,
}

impl Conductor {
    /// Reflectance of a microfacet at an angle of the given cosine with its normal.
    fn reflectance(&self, cosine: f64) -> Spectrum {
        let reflected = match (self.film, self.fresnel) {
            (None, fresnel) => fresnel.at(cosine),
            (Some(film), Fresnel::Complex { eta, k }) => {
                let (eta, k) = (eta.to_rgb(), k.to_rgb());
                Spectrum::from_rgb([0, 1, 2].map(|channel| film.reflectance(channel, cosine, eta[channel], k[channel])))
            }
            (Some(film), Fresnel::Schlick(normal_incidence)) => film.reflectance_over(cosine, normal_incidence),
        };
        self.tint * reflected
    }
}

/// Reflectance of a metal, by angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fresnel {
    /// Complex index of refraction.
    Complex { eta: Spectrum, k: Spectrum },
    /// Reflectance at normal incidence.
    Schlick(Spectrum),
}

impl Fresnel {
    pub fn at(&self, cosine: f64) -> Spectrum {
        match *self {
            Self::Complex { eta, k } => conductor_reflectance(cosine, eta, k),
            Self::Schlick(normal_incidence) => schlick_reflectance(cosine, normal_incidence),
        }
    }
}

impl Scatter for Conductor {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::Conductor { fresnel, facets, specular_reflectance, film } = kind else { return None };
        let fresnel = match fresnel {
            ConductorFresnel::Complex { eta, k } => Fresnel::Complex { eta: *eta, k: *k },
            ConductorFresnel::Reflectance(reflectance) => Fresnel::Schlick(lookup.color(reflectance)),
        };
        let film = ThinFilm::of(film.as_ref(), lookup);
        Some(Self { fresnel, facets: Facets::of(facets, lookup), tint: lookup.color(specular_reflectance), film })
    }

    fn sampling_weight(&self) -> f64 {
        self.reflectance(1.0).max_component()
    }

    fn is_delta(&self) -> bool {
        self.facets.are_smooth()
    }

    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        if self.is_delta() || !view.reflects(wi) {
            return Evaluation::default();
        }
        let (facets, frame) = (self.facets, view.facet_frame(self.facets.anisotropic));
        let (wo, wi) = (frame.to_local(view.wo), frame.to_local(wi));
        let m = (wo + wi).normalize();
        let unshadowed = facets.distribution(m) / (4.0 * wo.z);
        let value = self.reflectance(wo.dot(m)) * (unshadowed * facets.shadowing_masking(wo, wi));
        Evaluation { value, pdf: unshadowed * facets.masking(wo) }
    }

    /// With the density of visible normals, G1·D·(wo·m)/cosθo, over the Jacobian 4·(wo·m) of the reflection, F·G2/G1 is left.
    fn sample(&self, view: &View, _u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        if self.is_delta() {
            let (wi, weight) = (view.mirrored(), self.reflectance(view.wo.dot(view.normal())));
            return view.reflects(wi).then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, Density::Delta) });
        }
        let (facets, frame) = (self.facets, view.facet_frame(self.facets.anisotropic));
        let wo = frame.to_local(view.wo);
        let m = facets.sample_visible(wo, u1, u2);
        let cosine = wo.dot(m);
        let local = m * (2.0 * cosine) - wo;
        let wi = frame.to_world(local).normalize();
        let weight = self.reflectance(cosine) * facets.shadowing_of_visible(wo, local);
        let density = Density::SolidAngle(facets.distribution(m) * facets.masking(wo) / (4.0 * wo.z));
        view.reflects(wi).then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, density) })
    }
}
