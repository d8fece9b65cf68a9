//! Point lights.

use std::f64::consts::PI;

use glam::DVec3;

use super::delta::{Arriving, DeltaLight};
use crate::math::luminance;
use crate::sampling::LightStrength;
use crate::scene::PointLight;

pub fn new(light: &PointLight) -> PointLight {
    *light
}

impl DeltaLight for PointLight {
    fn strength(&self) -> LightStrength {
        LightStrength::Power(4.0 * PI * luminance(self.intensity))
    }

    fn arriving(&self, point: DVec3) -> Option<Arriving> {
        Arriving::from_position(self.position, point, |_| self.intensity)
    }
}
