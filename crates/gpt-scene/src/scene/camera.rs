//! The camera.

use glam::DVec3;

/// Stretches of the exposure in each of which a camera that moves does so evenly: its rays' origins and directions go straight from one end of
/// a stretch to the other. In an exposure that turns it by an eighth of a circle, rays are off by less than a hundredth of a degree.
pub const EXPOSURE_STRETCHES: usize = 16;

/// A camera in world space. It looks along `look_at - position`; `up` is made orthogonal to that.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    pub position: DVec3,
    pub look_at: DVec3,
    pub up: DVec3,
    pub projection: Projection,
    /// How far the window lies to the right of the camera's axis and above it, in its own widths and heights: rays stay parallel to what they
    /// were, so that upright edges stay upright.
    pub shift: [f64; 2],
    /// How many times as wide the window is as the picture's pixels say, were they square; below 0 the picture is mirrored.
    pub stretch: f64,
    /// None: a pinhole.
    pub aperture: Option<Aperture>,
    /// Distance along the viewing direction of the plane in focus; used with an aperture.
    pub focus_distance: f64,
    /// Times at which the shutter opens and closes.
    pub shutter: [f64; 2],
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            position: DVec3::new(0.0, 0.0, 1.0),
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Perspective { vertical_fov_degrees: 40.0 },
            shift: [0.0; 2],
            stretch: 1.0,
            aperture: None,
            focus_distance: 1.0,
            shutter: [0.0, 1.0],
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    Perspective {
        vertical_fov_degrees: f64,
    },
    /// Parallel rays over a window `height` scene units high.
    Orthographic {
        height: f64,
    },
}

/// The lens opening of a thin-lens camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aperture {
    pub shape: ApertureShape,
    /// Radius of the opening's circumscribed circle (disk, polygon) or half its side (square).
    pub radius: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ApertureShape {
    Disk,
    Square,
    Polygon { blades: u32, rotation_degrees: f64 },
}

impl Camera {
    /// Orthonormal camera frame: right, up, backward (the camera looks along -backward).
    pub fn frame(&self) -> [DVec3; 3] {
        let backward = (self.position - self.look_at).normalize();
        let right = self.up.cross(backward).normalize();
        [right, backward.cross(right), backward]
    }
}
