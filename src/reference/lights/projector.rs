//! Projectors.

use glam::DVec3;

use super::delta::{Arriving, DeltaLight};
use super::projected_picture::ProjectedPicture;
use crate::scene::{Projector, Scene};

#[derive(Debug)]
pub struct Thrower {
    light: Projector,
    picture: ProjectedPicture,
}

pub fn new(light: &Projector, scene: &Scene) -> Thrower {
    let picture = ProjectedPicture::new(light.direction, light.up, light.half_extent(), light.texture, scene);
    Thrower { light: *light, picture }
}

impl DeltaLight for Thrower {
    /// On the plane at distance 1 the light is 1 / cosine away and meets the plane at that cosine.
    fn arriving(&self, point: DVec3) -> Option<Arriving> {
        let direction = (point - self.light.position).try_normalize()?;
        let uv = self.picture.coordinates(direction)?;
        let is_inside = uv.min_element() >= 0.0 && uv.max_element() <= 1.0;
        let intensity =
            |direction: DVec3| self.light.irradiance * self.picture.color(uv) / direction.dot(self.light.direction).powi(3);
        Arriving::from_position(self.light.position, point, intensity).filter(|_| is_inside)
    }

    fn position(&self) -> Option<DVec3> {
        Some(self.light.position)
    }
}
