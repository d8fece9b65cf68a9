//! The inner geometry of a calibrated camera.

use glam::{DVec2, DVec4};

use super::model::ViewPlace;
use super::window::Window;
use crate::scene::check::{Check, is_positive};

/// Focal lengths and the point on the axis, in pixels of the pictures that a camera was calibrated by. A picture of another size shows the
/// same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Intrinsics {
    /// Width and height of these pictures.
    pub image_size: [u32; 2],
    /// Across and down.
    pub focal: [f64; 2],
    /// From the upper left corner of the picture, not from the middle of its first pixel.
    pub principal_point: [f64; 2],
}

impl Intrinsics {
    pub(super) fn check(&self) -> Check {
        if self.image_size.contains(&0) {
            return Err("its calibration must be by pictures that have pixels".into());
        }
        if !self.focal.into_iter().all(is_positive) {
            return Err(format!("its focal lengths must be positive and are {:?}", self.focal));
        }
        if !self.principal_point.into_iter().all(f64::is_finite) {
            return Err("its principal point must be finite".into());
        }
        Ok(())
    }

    /// The place on a plane at distance 1: to the right, and down.
    pub(super) fn on_plane(&self, place: &ViewPlace) -> DVec2 {
        let in_image = place.at / place.size * DVec2::from(self.image_size.map(f64::from));
        (in_image - DVec2::from(self.principal_point)) / DVec2::from(self.focal)
    }

    /// The window of a lens that distorts nothing.
    pub(crate) fn window(&self) -> Window {
        let size = DVec2::from(self.image_size.map(f64::from));
        let beside = DVec2::from(self.principal_point) / size - 0.5;
        let half_extent = 0.5 * size / DVec2::from(self.focal);
        Window { half_extent, shift: DVec2::new(-beside.x, beside.y), is_parallel: false }
    }

    /// Factor and summand that make of pixels of a view places on the plane at distance 1.
    pub(super) fn words(&self, size: DVec2) -> DVec4 {
        let focal = DVec2::from(self.focal);
        let factor = DVec2::from(self.image_size.map(f64::from)) / (size * focal);
        let summand = -DVec2::from(self.principal_point) / focal;
        DVec4::new(factor.x, factor.y, summand.x, summand.y)
    }

    /// The principal point's place in a view of this size.
    pub(super) fn axis_in(&self, size: DVec2) -> DVec2 {
        DVec2::from(self.principal_point) * size / DVec2::from(self.image_size.map(f64::from))
    }
}
