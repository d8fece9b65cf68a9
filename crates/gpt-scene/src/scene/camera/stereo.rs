//! Two eyes.

use glam::DVec3;

use super::model::Eyes;
use crate::choice::choices;
use crate::scene::check::{Check, is_positive};

choices! {
    /// The places of two eyes' pictures.
    pub enum StereoLayout {
        /// The left eye's picture is the left half.
        SideBySide = "side_by_side",
        /// The left eye's picture is the upper half.
        TopBottom = "top_bottom",
    }
}

impl StereoLayout {
    /// Columns and rows of views.
    pub fn tiles(self) -> [u32; 2] {
        match self {
            Self::SideBySide => [2, 1],
            Self::TopBottom => [1, 2],
        }
    }
}

/// Two eyes, the camera's position in the middle between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stereo {
    pub layout: StereoLayout,
    /// From one eye to the other, in scene units.
    pub eye_distance: f64,
    /// Distance from the camera at which both eyes see a thing at the same place of their pictures; None: at infinity.
    pub convergence: Option<f64>,
}

impl Stereo {
    pub(super) fn check(&self) -> Check {
        if !is_positive(self.eye_distance) {
            return Err(format!("the distance of its eyes must be positive and is {}", self.eye_distance));
        }
        match self.convergence {
            Some(distance) if !is_positive(distance) => {
                Err(format!("the distance at which its eyes converge must be positive and is {distance}"))
            }
            _ => Ok(()),
        }
    }

    /// One over the distance at which the eyes converge.
    pub fn inverse_convergence(&self) -> f64 {
        self.convergence.map_or(0.0, f64::recip)
    }

    /// The place of the eye of a view that looks along a direction of a [model](super::model::CameraModel), from the camera's position; in
    /// its coordinates (right, up, backward). Eyes that turn stand still where the direction is upright.
    pub fn eye(&self, eyes: Eyes, direction: DVec3, tile: u32) -> DVec3 {
        let half = if tile == 0 { -0.5 * self.eye_distance } else { 0.5 * self.eye_distance };
        match eyes {
            Eyes::Turning => half * DVec3::new(-direction.z, 0.0, direction.x).normalize_or_zero(),
            Eyes::Pair | Eyes::One => DVec3::new(half, 0.0, 0.0),
        }
    }
}
