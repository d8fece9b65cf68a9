//! Angles along both sides of the picture.

use glam::{DVec2, DVec3, DVec4};

use super::model::{CameraModel, Eyes, ViewPlace};
use super::span::{check_azimuth, check_elevation};
use crate::scene::check::Check;

/// An equirectangular panorama, or a part of one: equal steps to the right are equal steps of the azimuth, equal steps down equal steps of the
/// elevation. Each range goes from one edge of the picture to the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equirectangular {
    /// At the left and the right edge, in degrees to the right of the viewing direction.
    pub azimuth_degrees: [f64; 2],
    /// At the lower and the upper edge, in degrees above the camera's horizon.
    pub elevation_degrees: [f64; 2],
}

impl Default for Equirectangular {
    fn default() -> Self {
        Self { azimuth_degrees: [-180.0, 180.0], elevation_degrees: [-90.0, 90.0] }
    }
}

impl Equirectangular {
    /// All directions are in the picture.
    pub fn is_full(&self) -> bool {
        *self == Self::default()
    }
}

impl Equirectangular {
    /// Its azimuths are possible.
    pub(crate) fn has_right_azimuth(&self) -> bool {
        check_azimuth(self.azimuth_degrees).is_ok()
    }
}

impl CameraModel for Equirectangular {
    fn check(&self) -> Check {
        check_azimuth(self.azimuth_degrees)?;
        check_elevation(self.elevation_degrees, 90.0)
    }

    fn direction(&self, place: &ViewPlace) -> Option<DVec3> {
        let share = place.at / place.size;
        let ([left, right], [bottom, top]) = (self.azimuth_degrees, self.elevation_degrees);
        let (sine, cosine) = (left + (right - left) * share.x).to_radians().sin_cos();
        let (height, level) = (top + (bottom - top) * share.y).to_radians().sin_cos();
        Some(DVec3::new(level * sine, height, -level * cosine))
    }

    /// In turns: azimuth at the left edge, and that of a pixel; elevation at the upper edge, and that of a pixel.
    fn words(&self, size: DVec2) -> [DVec4; 4] {
        let ([left, right], [bottom, top]) = (self.azimuth_degrees, self.elevation_degrees);
        let first = DVec4::new(left, (right - left) / size.x, top, (bottom - top) / size.y) / 360.0;
        [first, DVec4::ZERO, DVec4::ZERO, DVec4::ZERO]
    }

    fn eyes(&self) -> Eyes {
        Eyes::Turning
    }
}
