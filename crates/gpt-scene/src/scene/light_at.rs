//! A light at a frame.

use glam::{DAffine3, DMat3, DVec3};

use crate::spectrum::Spectrum;

/// The state of a light at a frame. Fields that are None stay as they are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightAt {
    pub position: Option<DVec3>,
    /// A direction of length 1.
    pub direction: Option<DVec3>,
    /// Intensity, irradiance or radiance.
    pub strength: Option<Spectrum>,
    pub rotation_degrees: Option<f64>,
    /// Takes the light along from where it then is.
    pub along: DAffine3,
}

impl LightAt {
    /// Moves a light that is at this position without a frame.
    pub(super) fn place(&self, position: &mut DVec3) {
        *position = self.along.transform_point3(self.position.unwrap_or(*position));
    }

    /// Turns a light that shines in this direction without a frame.
    pub(super) fn turn(&self, direction: &mut DVec3) {
        *direction = self.direction.unwrap_or(*direction);
        self.take_along(direction);
    }

    /// Turns a direction that belongs to the light.
    pub(super) fn take_along(&self, direction: &mut DVec3) {
        // Without a rotation, no last bit changes.
        if self.along.matrix3 != DMat3::IDENTITY {
            *direction = self.along.transform_vector3(*direction).normalize_or_zero();
        }
    }
}
