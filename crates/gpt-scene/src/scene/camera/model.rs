//! The contract of a camera's model, and the table of models.

use glam::{DVec2, DVec3, DVec4};

use crate::scene::check::Check;

/// The table of camera models: a row for each projection whose rays are no straight lines through a flat window. From these rows the kinds of
/// [`Projection`](super::Projection) are made, the switches of shaders, and what chooses among their files, so a model is a row here, a file
/// of its module's name beside this one, which is its meaning in f64, and one in `shaders/core/camera`; its keys stand in `load/file/syntax/camera`.
///
/// A row: variant of `Projection`, which is also the name of its data's type; module, which scene files call it by; the name of the switch that
/// compiles its shader; then other switches that it needs.
#[doc(hidden)]
#[macro_export]
macro_rules! camera_table {
    ($what:ident) => {
        $what! {
            /// Angles along both sides of the picture.
            Equirectangular equirectangular EQUIRECTANGULAR,
            /// Angles along the picture's width, and the height on an upright cylinder along its height.
            Cylindrical cylindrical CYLINDRICAL,
            /// A circle in which the distance from the middle says the angle from the axis.
            Fisheye fisheye FISHEYE BLIND_PIXELS,
            /// The six sides of a cube.
            CubeMap cube_map CUBE_MAP CAMERA_TILES,
            /// A perspective that a lens distorts (Brown 1966; Conrady 1919), as OpenCV calibrates it.
            BrownConrady brown_conrady BROWN_CONRADY BLIND_PIXELS,
            /// A fisheye lens by a polynomial of the angle (Kannala and Brandt 2006), as OpenCV calibrates it.
            KannalaBrandt kannala_brandt KANNALA_BRANDT BLIND_PIXELS,
        }
    };
}
#[doc(hidden)]
pub use camera_table;

/// A place in a view: a picture consists of one, of one for either eye, or of the sides of a cube.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewPlace {
    /// Number of the view, counted along the rows of the picture.
    pub tile: u32,
    /// Pixels to the right of the view's upper left corner, and below it.
    pub at: DVec2,
    /// Width and height of the view in pixels.
    pub size: DVec2,
}

/// How two eyes stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Eyes {
    /// Side by side at rest, for all directions.
    Pair,
    /// Each on a circle, where the other is beside it for who looks that way: omnidirectional stereo.
    Turning,
    /// There is one alone.
    One,
}

/// A map from places of a view to directions.
pub trait CameraModel {
    /// Checks its numbers.
    fn check(&self) -> Check;

    /// Checks that a view of so many pixels can be taken, of a camera whose numbers are checked.
    fn check_view(&self, _size: DVec2) -> Check {
        Ok(())
    }

    /// The direction that a place of a view sees, in coordinates (right, up, backward) of the camera; None where it sees nothing. Its length
    /// is 1, but for a cylinder, where that of its level part is, and for models [with an axis](Self::has_plane), whose plane at distance 1 it ends on.
    fn direction(&self, place: &ViewPlace) -> Option<DVec3>;

    /// The words that its shader reads, for views of so many pixels.
    fn words(&self, size: DVec2) -> [DVec4; 4];

    /// How two eyes would stand.
    fn eyes(&self) -> Eyes;

    /// The camera sees what lies before a plane across its axis: depth is measured along the axis, and a lens may focus.
    fn has_plane(&self) -> bool {
        false
    }

    /// Columns and rows of views in a picture of one eye.
    fn tiles(&self) -> [u32; 2] {
        [1, 1]
    }
}
