//! The camera: where it stands, and which ray each place of its picture is.
//!
//! `projection` lists the ways in which it sees; each [model](model::camera_table) is a file here that maps places to directions in f64.
//! `window` is a flat picture, `stereo` a second eye, `aperture` a lens. What depends on the picture's size is checked for that size.

mod aperture;
mod blind;
mod brown_conrady;
mod check;
mod cube_map;
mod cylindrical;
mod equirectangular;
mod fisheye;
mod intrinsics;
mod kannala_brandt;
pub mod model;
mod polynomial;
mod preset;
mod projection;
mod rising;
mod span;
mod stereo;
mod window;

use glam::{DVec2, DVec3};

pub use aperture::{Aperture, ApertureShape, BLADES};
pub use brown_conrady::BrownConrady;
pub use cube_map::{CubeLayout, CubeMap};
pub use cylindrical::Cylindrical;
pub use equirectangular::Equirectangular;
pub use fisheye::{Fisheye, FisheyeFit, FisheyeMapping};
pub use intrinsics::Intrinsics;
pub use kannala_brandt::KannalaBrandt;
pub use model::{Eyes, ViewPlace};
pub use preset::CameraPreset;
pub use projection::Projection;
pub use stereo::{Stereo, StereoLayout};
pub use window::Window;

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
    /// How far the window of a perspective or parallel camera lies to the right of the camera's axis and above it, in its own widths and heights:
    /// rays stay parallel to what they were, so that upright edges stay upright.
    pub shift: [f64; 2],
    /// How many times as wide that window is as the picture's pixels say, were they square; below 0 the picture is mirrored.
    pub stretch: f64,
    /// None: a pinhole.
    pub aperture: Option<Aperture>,
    /// Distance along the viewing direction of the plane in focus; used with an aperture.
    pub focus_distance: f64,
    /// Two eyes, each with its own picture; None: one.
    pub stereo: Option<Stereo>,
    /// Times at which the shutter opens and closes.
    pub shutter: [f64; 2],
    /// Share of the time between for which each row of the picture is exposed, one after the other from the top: the first as the shutter opens, the
    /// last until it closes. 1: all at once.
    pub rolling_shutter: f64,
    /// How far from its position rays start, to come back to it from where they would have gone; 0: they go out from the position. Meters on spheres
    /// see so; scene files have no key for it.
    pub inward_from: f64,
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
            stereo: None,
            shutter: [0.0, 1.0],
            rolling_shutter: 1.0,
            inward_from: 0.0,
        }
    }
}

impl Camera {
    /// When a row of a picture of so many rows is seen: 0 as the shutter opens, 1 as it closes. `u` is the share of the row's own exposure.
    pub fn time_of_row(&self, row: u32, rows: u32, u: f64) -> f64 {
        let start = f64::from(row) / f64::from(rows.max(2) - 1);
        (1.0 - self.rolling_shutter) * start + self.rolling_shutter * u
    }

    /// Orthonormal camera frame: right, up, backward (the camera looks along -backward).
    pub fn frame(&self) -> [DVec3; 3] {
        let backward = (self.position - self.look_at).normalize();
        let right = self.up.cross(backward).normalize();
        [right, backward.cross(right), backward]
    }

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

    /// Columns and rows of views that its picture consists of: of two eyes, or the sides of a cube.
    pub fn tiles(&self) -> [u32; 2] {
        match (self.stereo, self.projection.model()) {
            (Some(stereo), _) => stereo.layout.tiles(),
            (None, Some(model)) => model.tiles(),
            (None, None) => [1, 1],
        }
    }

    /// Pixels of each view of a picture of so many, which is checked to be divisible.
    pub fn view_size(&self, film: [u32; 2]) -> [u32; 2] {
        let [columns, rows] = self.tiles();
        [film[0] / columns, film[1] / rows]
    }

    /// Kernels that are made for one of both cameras are right for the other: they have the same projection, and views.
    pub fn has_kernels_of(&self, other: &Self) -> bool {
        let mapping = |camera: &Self| match camera.projection {
            Projection::Fisheye(model) => Some(model.mapping),
            _ => None,
        };
        let kind =
            |camera: &Self| (std::mem::discriminant(&camera.projection), mapping(camera), camera.window(DVec2::ONE).is_some());
        let is_inward = |camera: &Camera| camera.inward_from > 0.0;
        kind(self) == kind(other)
            && is_inward(self) == is_inward(other)
            && self.tiles() == other.tiles()
            && self.stereo.is_some() == other.stereo.is_some()
    }

    /// The layer of depth is measured along the viewing direction; else from the camera's position.
    pub fn measures_depth_along_axis(&self) -> bool {
        self.projection.model().is_none_or(|model| model.has_plane())
    }
}

#[cfg(test)]
mod tests;
