//! The surface that is not there.

use glam::DVec3;

use super::lookup::Lookup;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::view::View;
use crate::scene::MaterialKind;
use crate::spectrum::Spectrum;

/// The ray goes on as if nothing were there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Null;

impl Scatter for Null {
    fn of(kind: &MaterialKind, _lookup: &Lookup) -> Option<Self> {
        matches!(kind, MaterialKind::Pass).then_some(Self)
    }

    fn sampling_weight(&self) -> f64 {
        1.0
    }

    fn is_delta(&self) -> bool {
        true
    }

    fn evaluate(&self, _view: &View, _wi: DVec3) -> Evaluation {
        Evaluation::default()
    }

    fn sample(&self, view: &View, _u_lobe: f64, _u1: f64, _u2: f64) -> Option<BsdfSample> {
        let sample = BsdfSample { is_null: true, ..BsdfSample::reflected(-view.wo, Density::Delta) };
        Some(BsdfSample { weight: Spectrum::WHITE, ..sample })
    }
}
