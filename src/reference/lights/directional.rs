//! Directional lights.

use glam::DVec3;

use super::delta::{Arriving, DeltaLight};
use crate::scene::{DirectionalLight, Scene};

pub fn new(light: &DirectionalLight, _: &Scene) -> DirectionalLight {
    *light
}

impl DeltaLight for DirectionalLight {
    fn arriving(&self, _: DVec3) -> Option<Arriving> {
        Some(Arriving { wi: -self.direction, distance: f64::INFINITY, irradiance: self.irradiance })
    }

    fn position(&self) -> Option<DVec3> {
        None
    }
}
