//! The smooth dielectric: a reflected and a refracted direction.

use glam::DVec3;

use super::dielectric::Dielectric;
use super::lookup::Lookup;
use super::scatter::{BsdfSample, Evaluation, Scatter};
use super::view::View;
use crate::scene::MaterialKind;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Glass {
    pub dielectric: Dielectric,
}

impl Scatter for Glass {
    fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
        let MaterialKind::Glass { ior, reflectance, transmittance, thin: false, film: None, dispersion: None } = kind else {
            return None;
        };
        Some(Self { dielectric: Dielectric::new(*ior, reflectance, transmittance, lookup) })
    }

    fn sampling_weight(&self) -> f64 {
        self.dielectric.sampling_weight()
    }

    fn is_delta(&self) -> bool {
        true
    }

    fn evaluate(&self, _view: &View, _wi: DVec3) -> Evaluation {
        Evaluation::default()
    }

    fn sample(&self, view: &View, u_lobe: f64, _u1: f64, _u2: f64) -> Option<BsdfSample> {
        self.dielectric.sample_delta(view, u_lobe)
    }
}
