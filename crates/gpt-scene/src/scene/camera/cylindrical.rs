//! An upright cylinder, unrolled.

use glam::{DVec2, DVec3, DVec4};

use super::model::{CameraModel, Eyes, ViewPlace};
use super::span::{check_azimuth, check_elevation};
use crate::scene::check::Check;

/// The picture on an upright cylinder around the camera: equal steps to the right are equal steps of the azimuth, equal steps down equal heights
/// on the cylinder, so that upright lines stay straight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cylindrical {
    /// At the left and the right edge, in degrees to the right of the viewing direction.
    pub azimuth_degrees: [f64; 2],
    /// At the lower and the upper edge, in degrees above the camera's horizon. None: as much to either side of it as makes pixels square there.
    pub elevation_degrees: Option<[f64; 2]>,
}

/// Elevations end here: the cylinder has no top.
const STEEPEST: f64 = 89.9;

impl Default for Cylindrical {
    fn default() -> Self {
        Self { azimuth_degrees: [-180.0, 180.0], elevation_degrees: None }
    }
}

impl Cylindrical {
    /// Heights of the lower and the upper edge on a cylinder of radius 1, in a picture of this size.
    fn heights(&self, size: DVec2) -> [f64; 2] {
        let [left, right] = self.azimuth_degrees;
        match self.elevation_degrees {
            Some(ends) => ends.map(|degrees| degrees.to_radians().tan()),
            None => {
                let half = 0.5 * (right - left).to_radians() * size.y / size.x;
                [-half, half]
            }
        }
    }
}

impl Cylindrical {
    /// Its azimuths are possible.
    pub(crate) fn has_right_azimuth(&self) -> bool {
        check_azimuth(self.azimuth_degrees).is_ok()
    }
}

impl CameraModel for Cylindrical {
    fn check(&self) -> Check {
        check_azimuth(self.azimuth_degrees)?;
        self.elevation_degrees.map_or(Ok(()), |range| check_elevation(range, STEEPEST))
    }

    fn direction(&self, place: &ViewPlace) -> Option<DVec3> {
        let share = place.at / place.size;
        let ([left, right], [bottom, top]) = (self.azimuth_degrees, self.heights(place.size));
        let (sine, cosine) = (left + (right - left) * share.x).to_radians().sin_cos();
        Some(DVec3::new(sine, top + (bottom - top) * share.y, -cosine))
    }

    /// Azimuth at the left edge, and that of a pixel, in turns; height at the upper edge, and that of a pixel.
    fn words(&self, size: DVec2) -> [DVec4; 4] {
        let ([left, right], [bottom, top]) = (self.azimuth_degrees.map(|degrees| degrees / 360.0), self.heights(size));
        let first = DVec4::new(left, (right - left) / size.x, top, (bottom - top) / size.y);
        [first, DVec4::ZERO, DVec4::ZERO, DVec4::ZERO]
    }

    fn eyes(&self) -> Eyes {
        Eyes::Turning
    }
}
