//! Fujii's form of Oren and Nayar's model, with the light given back that it loses.

use std::f64::consts::{FRAC_1_PI, PI};

use glam::DVec3;

use super::lookup::Lookup;
use super::rough_diffuse::{Directions, evaluate, sample};
use super::scatter::{BsdfSample, Evaluation, Scatter};
use super::view::View;
use crate::scene::{MaterialKind, RoughDiffuseModel};
use crate::spectrum::Spectrum;

/// The light that white facets lose, seen along the normal, over A·σ.
const LOST_AT_NORMAL: f64 = 0.5 - 2.0 / (3.0 * PI);
/// By how much less they lose on average over all directions.
const LESS_ON_AVERAGE: f64 = 2.0 / 3.0 - 28.0 / (15.0 * PI);

/// f = ρ/π·A·(1 + σ·s/t) and a part that scatters evenly what is lost (Portsmouth, Kutz and Hill 2025): with s = wo·wi − cos θo·cos θi,
/// t = max(cos θo, cos θi) where s is above 0 and else 1, and A = 1/(1 + (½ − 2/(3π))·σ).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyPreservingOrenNayar {
    pub reflectance: Spectrum,
    /// Fujii's σ, 0 to 1.
    pub roughness: f64,
}

/// The light that white facets lose, seen from an angle, over A·σ.
fn lost(cosine: f64) -> f64 {
    let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
    let angle = sine.atan2(cosine);
    // G of the paper, with (1 − sin³θ)/cos θ written without a difference.
    let gain = sine * (angle - sine * cosine) + (2.0 / 3.0) * sine * (cosine * (1.0 + sine + sine * sine) / (1.0 + sine) - 1.0);
    LOST_AT_NORMAL - gain * FRAC_1_PI
}

impl EnergyPreservingOrenNayar {
    fn f(&self, directions: &Directions) -> Spectrum {
        let sigma = self.roughness;
        let a = 1.0 / (1.0 + LOST_AT_NORMAL * sigma);
        let s = directions.side_by_side;
        let once = a * (1.0 + sigma * if s > 0.0 { directions.sine_times_tangent() } else { s });
        // Light that is lost on average, and comes back by the facets' colour.
        let lost_on_average = a * sigma * (LOST_AT_NORMAL - LESS_ON_AVERAGE);
        let again = self.reflectance * (1.0 - lost_on_average) / (Spectrum::WHITE - self.reflectance * lost_on_average);
        let both = lost(directions.cos_o) * lost(directions.cos_i) / (LOST_AT_NORMAL - LESS_ON_AVERAGE);
        self.reflectance * ((Spectrum::grey(once) + again * (a * sigma * both)) * FRAC_1_PI)
    }
}

impl Scatter for EnergyPreservingOrenNayar {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::OrenNayar { reflectance, roughness, model: RoughDiffuseModel::EnergyPreserving } = kind else {
            return None;
        };
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
