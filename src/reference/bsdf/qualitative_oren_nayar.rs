//! Oren and Nayar's simpler model.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::lookup::Lookup;
use super::rough_diffuse::{Directions, evaluate, sample};
use super::scatter::{BsdfSample, Evaluation, Scatter};
use super::view::View;
use crate::scene::{MaterialKind, RoughDiffuseModel};
use crate::spectrum::Spectrum;

/// f = ρ/π·(A + B·max(0, cos Δφ)·sin α·tan β), A = 1 − σ²/(2(σ² + 0.33)), B = 0.45·σ²/(σ² + 0.09), α and β the larger and the smaller angle
/// (Oren and Nayar 1994, section 4.4).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QualitativeOrenNayar {
    pub reflectance: Spectrum,
    pub roughness: f64,
}

impl QualitativeOrenNayar {
    fn f(&self, directions: &Directions) -> Spectrum {
        let sigma2 = self.roughness * self.roughness;
        let a = 1.0 - 0.5 * sigma2 / (sigma2 + 0.33);
        let b = 0.45 * sigma2 / (sigma2 + 0.09);
        self.reflectance * (FRAC_1_PI * (a + b * directions.sine_times_tangent().max(0.0)))
    }
}

impl Scatter for QualitativeOrenNayar {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::OrenNayar { reflectance, roughness, model: RoughDiffuseModel::Qualitative } = kind else { return None };
        Some(Self { reflectance: lookup.color(reflectance), roughness: lookup.scalar(roughness) })
    }

    fn sampling_weight(&self) -> f64 {
        self.reflectance.max_component()
    }

    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        evaluate(view, wi, |directions| self.f(directions))
    }

    fn sample(&self, view: &View, _u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        sample(view, u1, u2, |directions| self.f(directions))
    }
}
