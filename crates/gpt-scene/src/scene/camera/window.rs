//! A flat picture.

use glam::DVec2;

use super::{Camera, Projection};

/// The window of a camera whose rays go straight through it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Half its width and height, at distance 1 where rays meet in the camera; the width is below 0 where the picture is mirrored.
    pub half_extent: DVec2,
    /// How far its middle lies to the right of the axis and above it, in its own widths and heights.
    pub shift: DVec2,
    /// Rays are parallel.
    pub is_parallel: bool,
}

impl Camera {
    /// The window of a view of so many pixels; None where the picture is not flat. A calibrated lens that distorts nothing has one.
    pub fn window(&self, size: DVec2) -> Option<Window> {
        let of_height = |half_height: f64, is_parallel| {
            let half_extent = DVec2::new(half_height * size.x / size.y * self.stretch, half_height);
            Some(Window { half_extent, shift: DVec2::from(self.shift), is_parallel })
        };
        match self.projection {
            Projection::Perspective { vertical_fov_degrees } => of_height((0.5 * vertical_fov_degrees.to_radians()).tan(), false),
            Projection::Orthographic { height } => of_height(0.5 * height, true),
            Projection::BrownConrady(model) if model.is_undistorted() => Some(model.intrinsics.window()),
            _ => None,
        }
    }
}
