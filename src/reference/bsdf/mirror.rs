//! The perfect mirror.

use glam::DVec3;

use super::lookup::Lookup;
use super::scatter::{BsdfSample, Density, Evaluation, Scatter};
use super::view::View;
use crate::scene::MaterialKind;
use crate::spectrum::Spectrum;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mirror {
    pub reflectance: Spectrum,
}

impl Scatter for Mirror {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::Mirror { reflectance } = kind else { return None };
        Some(Self { reflectance: lookup.color(reflectance) })
    }

    fn sampling_weight(&self) -> f64 {
        self.reflectance.max_component()
    }

    fn is_delta(&self) -> bool {
        true
    }

    fn evaluate(&self, _view: &View, _wi: DVec3) -> Evaluation {
        Evaluation::default()
    }

    fn sample(&self, view: &View, _u_lobe: f64, _u1: f64, _u2: f64) -> Option<BsdfSample> {
        let wi = view.mirrored();
        view.reflects(wi).then_some(BsdfSample { weight: self.reflectance, ..BsdfSample::reflected(wi, Density::Delta) })
    }
}
