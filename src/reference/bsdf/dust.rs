//! A thin layer of dust.

use std::f64::consts::{FRAC_1_PI, PI};

use glam::DVec3;

use super::lookup::Lookup;
use super::rough_diffuse::{Directions, evaluate, sample};
use super::scatter::{BsdfSample, Evaluation, Scatter};
use super::view::View;
use crate::scene::MaterialKind;
use crate::spectrum::Spectrum;

/// f = w·p(wo, wi)·(1 − e^(−τm))/(cos θo + cos θi) + e^(−τm)·ρ/π, m = 1/cos θo + 1/cos θi: particles of albedo w that scatter light once, with the
/// phase function p of Henyey and Greenstein, in a layer of optical thickness τ (Blinn 1982, sections 3 and 4). The Lambert surface below, of reflectance ρ,
/// is seen and lit through it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dust {
    pub albedo: Spectrum,
    pub thickness: f64,
    pub anisotropy: f64,
    pub base: Spectrum,
}

impl Dust {
    fn f(&self, directions: &Directions) -> Spectrum {
        let &Directions { cos_o, cos_i, side_by_side } = directions;
        // The sine of the angle by which light is turned stands in the denominator by its cosine, −wo·wi.
        let g = self.anisotropy;
        let squared = (1.0 - g.abs()).powi(2) + 2.0 * g.abs() * (1.0 + g.signum() * (side_by_side + cos_o * cos_i));
        let phase = (1.0 - g * g) / (4.0 * PI * squared * squared.sqrt());
        let through = (-self.thickness * (1.0 / cos_o + 1.0 / cos_i)).exp();
        self.albedo * (phase * (1.0 - through) / (cos_o + cos_i)) + self.base * (FRAC_1_PI * through)
    }
}

impl Scatter for Dust {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::Dust { albedo, thickness, anisotropy, base } = kind else { return None };
        let thickness = lookup.scalar(thickness).max(0.0);
        Some(Self { albedo: lookup.color(albedo), thickness, anisotropy: *anisotropy, base: lookup.color(base) })
    }

    /// About what is seen along the normal.
    fn sampling_weight(&self) -> f64 {
        let through = (-2.0 * self.thickness).exp();
        (self.albedo * (0.5 * (1.0 - through)) + self.base * through).max_component()
    }

    fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
        evaluate(view, wi, |directions| self.f(directions))
    }

    fn sample(&self, view: &View, _u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
        sample(view, u1, u2, |directions| self.f(directions))
    }
}
