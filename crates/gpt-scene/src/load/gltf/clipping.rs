//! The planes before and behind which cameras of other renderers show nothing. Rays meet what lies there all the same, which is reported where it
//! shows.

use glam::DVec3;

use super::json::Camera;

/// The part of the world that a camera shows.
#[derive(Debug, Clone, Copy)]
pub struct Clipping {
    /// Its index in the file.
    pub camera: usize,
    pub position: DVec3,
    /// To the right, up, and forward.
    axes: [DVec3; 3],
    pub near: f64,
    pub far: f64,
    /// Half of the window: of a perspective camera at distance 1.
    half: [f64; 2],
    is_perspective: bool,
}

impl Clipping {
    /// The clipping of a camera at a position, which looks forward and has its upper side up.
    pub fn of(camera: &Camera, index: usize, (position, forward, up): (DVec3, DVec3, DVec3)) -> Self {
        let (half, near, far) = match (&camera.perspective, &camera.orthographic) {
            (Some(perspective), _) => {
                let height = (0.5 * perspective.yfov).tan();
                ([height * perspective.aspect_ratio.unwrap_or(1.0), height], perspective.znear, perspective.zfar)
            }
            (None, Some(window)) => ([window.xmag.abs(), window.ymag.abs()], window.znear, window.zfar),
            (None, None) => ([0.0; 2], None, None),
        };
        Self {
            camera: index,
            position,
            axes: [forward.cross(up).normalize_or_zero(), up, forward],
            near: near.unwrap_or(0.0),
            far: far.unwrap_or(f64::INFINITY),
            half,
            is_perspective: camera.perspective.is_some(),
        }
    }

    /// How far a point in the picture lies before the camera; None of one beside it or behind.
    pub fn depth_of(&self, point: DVec3) -> Option<f64> {
        let [across, upward, depth] = self.axes.map(|axis| axis.dot(point - self.position));
        let width = if self.is_perspective { depth } else { 1.0 };
        let is_shown = depth > 0.0 && across.abs() <= self.half[0] * width && upward.abs() <= self.half[1] * width;
        is_shown.then_some(depth)
    }
}
