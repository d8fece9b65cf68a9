//! The boundary of a dielectric: what smooth and rough glass share.

use super::fresnel::{dielectric_reflectance, refract};
use super::lookup::Lookup;
use super::scatter::{BsdfSample, Density};
use super::view::View;
use crate::scene::ColorInput;
use crate::spectrum::Spectrum;

/// A dielectric's boundary, smooth or not, and how it is tinted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dielectric {
    /// Index of refraction inside over outside.
    pub ior: f64,
    pub reflectance: Spectrum,
    pub transmittance: Spectrum,
}

/// How light divides at a dielectric boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Split {
    /// Reflected share, before tints.
    pub fresnel: f64,
    /// Probability of sampling the reflection.
    pub choose_reflection: f64,
}

impl Dielectric {
    pub fn new(ior: f64, reflectance: &ColorInput, transmittance: &ColorInput, lookup: &Lookup) -> Self {
        Self { ior, reflectance: lookup.color(reflectance), transmittance: lookup.color(transmittance) }
    }

    /// The larger of what it reflects and what it transmits.
    pub fn sampling_weight(&self) -> f64 {
        self.reflectance.max(self.transmittance).max_component()
    }

    /// Index of refraction on the far side over that on wo's side.
    pub fn eta(&self, view: &View) -> f64 {
        if view.front { self.ior } else { 1.0 / self.ior }
    }

    /// Chooses reflection with a probability P in proportion to the light each direction carries, Fresnel's F for equal tints:
    /// P = F·max ρ / (F·max ρ + (1−F)·max τ). None where neither carries any. `cosine` is that of wo with the facet's normal.
    pub fn split(&self, cosine: f64, eta: f64) -> Option<Split> {
        self.split_by(dielectric_reflectance(cosine, eta))
    }

    /// Shares of light at a plate with two boundaries. Light that goes to and fro between them adds up to R = F + (1−F)²F/(1−F²) = 2F/(1+F); the
    /// rest goes through. From either side the plate is denser than what it stands in.
    pub fn split_of_plate(&self, cosine: f64) -> Option<Split> {
        let fresnel = dielectric_reflectance(cosine.clamp(0.0, 1.0), self.ior);
        self.split_by(2.0 * fresnel / (1.0 + fresnel))
    }

    fn split_by(&self, fresnel: f64) -> Option<Split> {
        let reflected = fresnel * self.reflectance.max_component();
        let transmitted = (1.0 - fresnel) * self.transmittance.max_component();
        let sum = reflected + transmitted;
        (sum > 0.0).then(|| Split { fresnel, choose_reflection: reflected / sum })
    }

    /// A direction reflected or refracted by a smooth boundary. Reflection has weight Fρ/P; refraction (1−F)τ/(1−P), over eta² because
    /// light that enters the denser side is squeezed into a smaller cone (Veach 1997, section 5.2).
    pub fn sample_delta(&self, view: &View, u_lobe: f64) -> Option<BsdfSample> {
        let eta = self.eta(view);
        let Split { fresnel, choose_reflection } = self.split(view.wo.dot(view.normal()), eta)?;
        if u_lobe < choose_reflection {
            let wi = view.mirrored();
            let weight = self.reflectance * (fresnel / choose_reflection);
            return view.reflects(wi).then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, Density::Delta) });
        }
        let wi = refract(view.wo, view.normal(), eta)?;
        let weight = self.transmittance * ((1.0 - fresnel) / (1.0 - choose_reflection) / (eta * eta));
        // An interpolated normal may refract to the side the light came from, where there is nothing to enter.
        view.transmits(wi).then_some(BsdfSample { wi, weight, density: Density::Delta, eta, is_null: false })
    }

    /// A direction reflected by a smooth plate, or the one straight on.
    pub fn sample_delta_plate(&self, view: &View, u_lobe: f64) -> Option<BsdfSample> {
        let Split { fresnel, choose_reflection } = self.split_of_plate(view.wo.dot(view.normal()))?;
        if u_lobe < choose_reflection {
            let wi = view.mirrored();
            let weight = self.reflectance * (fresnel / choose_reflection);
            return view.reflects(wi).then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, Density::Delta) });
        }
        let weight = self.transmittance * ((1.0 - fresnel) / (1.0 - choose_reflection));
        Some(BsdfSample { weight, ..BsdfSample::reflected(-view.wo, Density::Delta) })
    }
}
