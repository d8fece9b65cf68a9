//! Point lights.

use glam::DVec3;

use super::delta::{Arriving, DeltaLight};
use crate::scene::{PointLight, Scene};

pub fn new(light: &PointLight, _: &Scene) -> PointLight {
    light.clone()
}

impl DeltaLight for PointLight {
    fn arriving(&self, point: DVec3) -> Option<Arriving> {
        let candela = |direction: DVec3| self.profile.as_ref().map_or(1.0, |aimed| aimed.candela(direction));
        Arriving::from_position(self.position, point, |direction| self.intensity * candela(direction))
    }

    fn position(&self) -> Option<DVec3> {
        Some(self.position)
    }
}
