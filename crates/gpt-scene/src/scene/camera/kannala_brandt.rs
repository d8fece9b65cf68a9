//! A fisheye lens by a polynomial.

use std::f64::consts::PI;

use glam::{DVec2, DVec3, DVec4};

use super::intrinsics::Intrinsics;
use super::model::{CameraModel, Eyes, ViewPlace};
use super::polynomial;
use super::rising::Rising;
use crate::scene::check::Check;

/// A fisheye by OpenCV's formula (calib3d, "Fisheye camera model"): what lies at the angle θ from the axis is shown θ(1 + k₁θ² + k₂θ⁴ + k₃θ⁶ + k₄θ⁸)
/// from the principal point, on the plane at distance 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KannalaBrandt {
    pub(crate) intrinsics: Intrinsics,
    /// k₁ to k₄.
    pub(crate) radial: [f64; 4],
    /// Things farther than half of it from the axis are not seen.
    pub(crate) fov_degrees: f64,
    /// How far the polynomial rises.
    rising: Rising,
}

impl KannalaBrandt {
    /// A camera with coefficients k₁ to k₄ that sees what lies within half of a field of view from its axis.
    pub fn new(intrinsics: Intrinsics, radial: [f64; 4], fov_degrees: f64) -> Self {
        let mut camera = Self { intrinsics, radial, fov_degrees, rising: Rising::default() };
        camera.rising = camera.find_rising();
        camera
    }

    /// The polynomial and its derivative by θ.
    fn radial(&self, theta: f64) -> (f64, f64) {
        let [k1, k2, k3, k4] = self.radial;
        let s = theta * theta;
        let value = theta * (1.0 + s * (k1 + s * (k2 + s * (k3 + s * k4))));
        (value, 1.0 + s * (3.0 * k1 + s * (5.0 * k2 + s * (7.0 * k3 + s * 9.0 * k4))))
    }

    /// How far the polynomial rises: up to the first angle where it turns back, or half the field of view.
    fn find_rising(&self) -> Rising {
        let [k1, k2, k3, k4] = self.radial;
        let most = (0.5 * self.fov_degrees.to_radians()).min(PI);
        let turns = polynomial::sign_changes(&[1.0, 3.0 * k1, 5.0 * k2, 7.0 * k3, 9.0 * k4], most * most);
        let end = turns.first().map_or(most, |square| square.sqrt());
        Rising { end, most: self.radial(end).0 }
    }
}

impl CameraModel for KannalaBrandt {
    fn check(&self) -> Check {
        self.intrinsics.check()?;
        if !self.radial.iter().all(|coefficient| coefficient.is_finite()) {
            return Err("the coefficients of its distortion must be finite".into());
        }
        if !(self.fov_degrees > 0.0 && self.fov_degrees <= 360.0) {
            return Err(format!("the field of view must be above 0 and at most 360 degrees and is {}", self.fov_degrees));
        }
        Ok(())
    }

    fn check_view(&self, size: DVec2) -> Check {
        super::blind::sees_something(self, size, self.intrinsics.axis_in(size))
    }

    fn direction(&self, place: &ViewPlace) -> Option<DVec3> {
        let shown = self.intrinsics.on_plane(place);
        let distance = shown.length();
        let theta = self.rising.inverse(distance, |theta| self.radial(theta))?;
        let towards = if distance > 0.0 { shown / distance } else { DVec2::ZERO };
        let (sine, cosine) = theta.sin_cos();
        Some(DVec3::new(towards.x * sine, -towards.y * sine, -cosine))
    }

    /// Factor and summand of places; k₁ to k₄; nothing; up to where the polynomial rises, and its value there.
    fn words(&self, size: DVec2) -> [DVec4; 4] {
        let Rising { end, most } = self.rising;
        [self.intrinsics.words(size), DVec4::from_array(self.radial), DVec4::ZERO, DVec4::new(end, most, 0.0, 0.0)]
    }

    fn eyes(&self) -> Eyes {
        Eyes::Pair
    }
}
