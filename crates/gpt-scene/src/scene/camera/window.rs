//! A flat picture.

use glam::DVec2;

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
