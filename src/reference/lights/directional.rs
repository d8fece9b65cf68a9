//! Directional lights.

use glam::DVec3;

use super::delta::{Arriving, DeltaLight};
use crate::math::luminance;
use crate::sampling::LightStrength;
use crate::scene::DirectionalLight;

pub fn new(light: &DirectionalLight) -> DirectionalLight {
    *light
}

impl DeltaLight for DirectionalLight {
    fn strength(&self) -> LightStrength {
        LightStrength::Irradiance(luminance(self.irradiance))
    }

    fn arriving(&self, _: DVec3) -> Option<Arriving> {
        Some(Arriving { wi: -self.direction, distance: f64::INFINITY, irradiance: self.irradiance })
    }
}
