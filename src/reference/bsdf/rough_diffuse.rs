//! The common part of lobes that scatter broadly and whose directions are drawn as Lambert's are.

use glam::DVec3;

use super::hemisphere::{hemisphere_pdf, sample_hemisphere};
use super::scatter::{BsdfSample, Density, Evaluation};
use super::view::View;
use crate::spectrum::Spectrum;

/// Two directions above a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Directions {
    /// Their cosines with the normal, above 0.
    pub cos_o: f64,
    pub cos_i: f64,
    /// sin θo · sin θi · cos Δφ, Δφ the angle between them around the normal.
    pub side_by_side: f64,
}

impl Directions {
    /// sin θo · cos Δφ · tan θi where wi is the steeper one, and with both exchanged where wo is.
    pub fn sine_times_tangent(&self) -> f64 {
        self.side_by_side / self.cos_o.max(self.cos_i)
    }
}

/// f·cos θi with the density of Lambert's directions.
pub fn evaluate(view: &View, wi: DVec3, f: impl Fn(&Directions) -> Spectrum) -> Evaluation {
    if !view.reflects(wi) {
        return Evaluation::default();
    }
    let (cos_o, cos_i) = (view.wo.dot(view.normal()), wi.dot(view.normal()));
    let directions = Directions { cos_o, cos_i, side_by_side: view.wo.dot(wi) - cos_o * cos_i };
    Evaluation { value: f(&directions) * cos_i, pdf: hemisphere_pdf(view, cos_i) }
}

/// One of Lambert's directions, weighted by f.
pub fn sample(view: &View, u1: f64, u2: f64, f: impl Fn(&Directions) -> Spectrum) -> Option<BsdfSample> {
    let wi = view.frame.to_world(sample_hemisphere(view, u1, u2));
    let Evaluation { value, pdf } = evaluate(view, wi, f);
    (pdf > 0.0).then_some(BsdfSample { weight: value / pdf, ..BsdfSample::reflected(wi, Density::SolidAngle(pdf)) })
}
