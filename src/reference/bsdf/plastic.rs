//! Plastic with a smooth surface.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::fresnel::{dielectric_reflectance, normal_incidence_reflectance};
use super::hemisphere::{hemisphere_pdf, sample_hemisphere};
use super::lookup::Lookup;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::view::View;
use crate::scene::MaterialKind;
use crate::spectrum::Spectrum;

/// A diffuse base of reflectance ρ below a boundary of index of refraction η. What the boundary lets in, 1 − F(θi), is reflected by the
/// base, and goes up and down until it gets out: of light from within the boundary sends the share R back. So
///
/// f = ρ / (π η²) · (1 − F(θi))·(1 − F(θo)) / (1 − R), or 1 − ρ·R below where `nonlinear`,
///
/// as Mitsuba's model has it. Above the base the boundary reflects as glass does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Base {
    pub reflectance: Spectrum,
    /// Factor of what the boundary reflects.
    pub specular: Spectrum,
    pub ior: f64,
    /// R
    pub internal_reflectance: f64,
    /// Each time that the base reflects, light takes on its colour once more.
    pub nonlinear: bool,
}

impl Base {
    pub fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::Plastic { interface, reflectance, specular_reflectance, nonlinear } = kind else { return None };
        Some(Self {
            reflectance: lookup.color(reflectance),
            specular: lookup.color(specular_reflectance),
            ior: interface.ior,
            internal_reflectance: interface.internal_reflectance(),
            nonlinear: *nonlinear,
        })
    }

    /// About what is reflected seen along the normal.
    pub fn sampling_weight(&self) -> f64 {
        let reflected = normal_incidence_reflectance(self.ior);
        (self.specular * reflected + self.reflectance * (1.0 - reflected)).max_component()
    }

    /// f of the base, given what the boundary lets through at either angle.
    pub fn value(&self, transmitted_o: f64, transmitted_i: f64) -> Spectrum {
        let kept =
            if self.nonlinear { self.reflectance * self.internal_reflectance } else { Spectrum::grey(self.internal_reflectance) };
        self.reflectance / (Spectrum::WHITE - kept) * (FRAC_1_PI * transmitted_o * transmitted_i / (self.ior * self.ior))
    }

    /// Probability of sampling the boundary's reflection, which reflects the share `reflected` of light towards wo.
    pub fn choose_specular(&self, reflected: f64) -> f64 {
        let specular = reflected * self.specular.sum();
        let diffuse = (1.0 - reflected) * self.reflectance.sum();
        if specular + diffuse > 0.0 { specular / (specular + diffuse) } else { 0.0 }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plastic {
    pub base: Base,
}

impl Scatter for Plastic {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::Plastic { interface, .. } = kind else { return None };
        if interface.is_rough() { None } else { Base::of(kind, lookup).map(|base| Self { base }) }
    }

    fn sampling_weight(&self) -> f64 {
        self.base.sampling_weight()
    }

    /// The base alone: the mirror direction is the boundary's.
    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        if !view.reflects(wi) {
            return Evaluation::default();
        }
        let (cos_o, cos_i) = (view.wo.dot(view.normal()), wi.dot(view.normal()));
        let [reflected_o, reflected_i] = [cos_o, cos_i].map(|cosine| dielectric_reflectance(cosine.min(1.0), self.base.ior));
        let value = self.base.value(1.0 - reflected_o, 1.0 - reflected_i) * cos_i;
        Evaluation { value, pdf: (1.0 - self.base.choose_specular(reflected_o)) * hemisphere_pdf(view, cos_i) }
    }

    fn sample(&self, view: &View, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        let reflected = dielectric_reflectance(view.wo.dot(view.normal()).min(1.0), self.base.ior);
        let probability = self.base.choose_specular(reflected);
        if u_lobe < probability {
            let (wi, weight) = (view.mirrored(), self.base.specular * (reflected / probability));
            return view.reflects(wi).then_some(BsdfSample { weight, ..BsdfSample::reflected(wi, Density::Delta) });
        }
        let wi = view.frame.to_world(sample_hemisphere(view, u1, u2));
        let Evaluation { value, pdf } = self.evaluate(view, wi);
        (pdf > 0.0).then(|| BsdfSample { weight: value / pdf, ..BsdfSample::reflected(wi, Density::SolidAngle(pdf)) })
    }
}
