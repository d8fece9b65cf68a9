//! Point lights.

use glam::DVec3;

use super::delta::{Arriving, DeltaLight};
use crate::scene::{PointLight, Scene};

pub fn new(light: &PointLight, _: &Scene) -> PointLight {
    *light
}

impl DeltaLight for PointLight {
    fn arriving(&self, point: DVec3) -> Option<Arriving> {
        Arriving::from_position(self.position, point, |_| self.intensity)
    }

    fn position(&self) -> Option<DVec3> {
        Some(self.position)
    }
}
