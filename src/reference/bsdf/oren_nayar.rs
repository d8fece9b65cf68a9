//! Oren and Nayar's whole model.

use std::f64::consts::{FRAC_1_PI, FRAC_2_PI};

use glam::DVec3;

use super::lookup::Lookup;
use super::rough_diffuse::{Directions, evaluate, sample};
use super::scatter::{BsdfSample, Evaluation, Scatter};
use super::view::View;
use crate::scene::{MaterialKind, RoughDiffuseModel};
use crate::spectrum::Spectrum;

/// V-shaped grooves of Lambert facets, whose angles have the standard deviation σ: equations 30 to 32 of Oren and Nayar 1994, with the light that
/// goes from one facet to another, once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrenNayar {
    pub reflectance: Spectrum,
    pub roughness: f64,
}

impl OrenNayar {
    fn f(&self, directions: &Directions) -> Spectrum {
        let &Directions { cos_o, cos_i, side_by_side } = directions;
        let sigma2 = self.roughness * self.roughness;
        // α and β, the larger and the smaller of both angles.
        let (cos_a, cos_b) = (cos_o.min(cos_i), cos_o.max(cos_i));
        let [sin_a, sin_b] = [cos_a, cos_b].map(|cosine| ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt());
        let product = sin_a * sin_b;
        let cos_phi = if product > 0.0 { (side_by_side / product).clamp(-1.0, 1.0) } else { 0.0 };
        let [alpha, beta] = [sin_a.atan2(cos_a), sin_b.atan2(cos_b)].map(|angle| FRAC_2_PI * angle);
        let away = if cos_phi < 0.0 { beta * beta * beta } else { 0.0 };
        let spread = sigma2 / (sigma2 + 0.09);
        let c1 = 1.0 - 0.5 * sigma2 / (sigma2 + 0.33);
        let c2 = 0.45 * spread * (sin_a - away);
        let c3 = 0.125 * spread * (alpha * beta).powi(2);
        let half = (sin_a + sin_b) / (cos_a + cos_b);
        let once = c1 + cos_phi * c2 * sin_b / cos_b + (1.0 - cos_phi.abs()) * c3 * half;
        let twice = 0.17 * sigma2 / (sigma2 + 0.13) * (1.0 - cos_phi * beta * beta);
        self.reflectance * ((Spectrum::grey(once) + self.reflectance * twice) * FRAC_1_PI)
    }
}

impl Scatter for OrenNayar {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::OrenNayar { reflectance, roughness, model: RoughDiffuseModel::Full } = kind else { return None };
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
