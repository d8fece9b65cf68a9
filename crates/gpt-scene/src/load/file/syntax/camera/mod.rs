//! `[camera]` as it is written.

mod projection_name;
mod rules;

use std::num::NonZeroU32;

use schemars::JsonSchema;
use serde::Deserialize;

use crate::load::file::keyframes::{CameraKeyEntry, InterpolationName};
use crate::load::file::syntax::choice_name::ChoiceName;
use crate::load::file::value::{
    Azimuth, Checked, Elevation, Exactly, FieldOfView, Fraction, Located, NonNegative, Number, Positive, Vector, WholeAngle,
};
use crate::load::place::Place;
use crate::scene::{CubeLayout, FisheyeFit, FisheyeMapping, StereoLayout};

pub use projection_name::ProjectionName;
use rules::{CALIBRATED, RULES, needed};

/// The camera, from which the picture is taken.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(extend("dependentRequired" = {
    "aperture": ["focus_distance"], "interpolation": ["keyframes"], "calibration_id": ["calibration"]
}), transform = rules::add)]
pub struct CameraTable {
    pub position: Vector,
    /// The camera looks along `look_at - position`.
    pub look_at: Located<Vector>,
    /// [0, 1, 0] when left out.
    pub up: Option<Located<Vector>>,
    /// Vertical field of view in degrees; with `projection = "perspective"`.
    pub vfov: Option<Located<Checked<FieldOfView>>>,
    /// How the camera sees (docs/cameras.md); "perspective" when left out, or what a `calibration` is of.
    pub projection: Option<Located<ProjectionName>>,
    /// Height of the window in scene units; with `projection = "orthographic"`.
    pub height: Option<Located<Checked<Positive>>>,
    /// Degrees to the right of the viewing direction at the picture's left and right edge, [-180, 180] when left out; with `equirectangular` and
    /// `cylindrical`.
    pub azimuth: Option<Located<Exactly<Checked<Azimuth>, 2>>>,
    /// Degrees above the camera's horizon at the picture's lower and upper edge; with `equirectangular`, where it is [-90, 90] when left out, and
    /// `cylindrical`, where pixels are square then.
    pub elevation: Option<Located<Exactly<Checked<Elevation>, 2>>>,
    /// Field of view in degrees, from rim to rim across the axis; with `fisheye`, and `kannala_brandt`, where it is 360 when left out.
    pub fov: Option<Located<Checked<WholeAngle>>>,
    /// How far from the middle a `fisheye` shows what lies off its axis; "equidistant" when left out.
    pub mapping: Option<Located<ChoiceName<FisheyeMapping>>>,
    /// How large the circle of a `fisheye` is in the picture; "inside" when left out.
    pub fit: Option<Located<ChoiceName<FisheyeFit>>>,
    /// How the sides of a `cube_map` lie in the picture; "row" when left out.
    pub layout: Option<Located<ChoiceName<CubeLayout>>>,
    /// Focal lengths across and down, in pixels of `image_size`; with `brown_conrady` and `kannala_brandt`.
    pub focal: Option<Located<Exactly<Checked<Positive>, 2>>>,
    /// The point on the axis, in pixels of `image_size` from the picture's upper left corner; its middle when left out; with `focal`.
    pub principal_point: Option<Located<Exactly<Number, 2>>>,
    /// Width and height of the pictures by which the camera was calibrated; those of `film.size` when left out; with `focal`.
    #[schemars(extend("items" = { "type": "integer", "minimum": 1 }))]
    pub image_size: Option<Located<Exactly<NonZeroU32, 2>>>,
    /// Coefficients of radial distortion: k1 to k6 of `brown_conrady`, k1 to k4 of `kannala_brandt`, both OpenCV's; those that are left out are 0.
    #[schemars(extend("maxItems" = 6))]
    pub radial: Option<Located<Vec<Number>>>,
    /// Coefficients p1 and p2 of tangential distortion, OpenCV's; with `brown_conrady`.
    pub tangential: Option<Located<Exactly<Number, 2>>>,
    /// A file that states `projection`, `focal` and what belongs to it: a calibration by OpenCV (.yml, .yaml, .json), or COLMAP's cameras.txt.
    pub calibration: Option<Located<String>>,
    /// The number of the camera in a file of several.
    pub calibration_id: Option<Located<u32>>,
    /// Two eyes, each with a picture of its own.
    pub stereo: Option<Located<StereoEntry>>,
    /// How far the picture's middle lies to the right of the camera's axis and above it, in widths and heights of the picture; [0, 0] when left
    /// out; with `perspective` and `orthographic`.
    pub shift: Option<Located<Exactly<Number, 2>>>,
    /// Factor of what the picture shows from side to side, 1 when left out: at 2 all is half as wide as it should be. Below 0, left and right are
    /// exchanged, so that -1 is a mirror's picture; with `perspective` and `orthographic`.
    pub stretch: Option<Located<Number>>,
    /// The lens opening; a pinhole when left out; with `perspective`, `orthographic` and `brown_conrady`.
    pub aperture: Option<Located<ApertureEntry>>,
    /// Distance along the viewing direction of the plane in focus; needed with an aperture.
    pub focus_distance: Option<Checked<Positive>>,
    /// Times at which the shutter opens and closes, [0, 1] when left out. Where there are keyframes they count in frames from the frame itself: 1 is
    /// the next frame.
    pub shutter: Option<Located<Exactly<Number, 2>>>,
    /// Share of that time for which each row of the picture is exposed, one after the other from the top: the first as the shutter opens, the last
    /// until it closes; 1, all at once, when left out.
    pub rolling_shutter: Option<Checked<Fraction>>,
    /// The camera at frames (`--frame`, `--frames`, `--time`); without one it is what the other keys say.
    #[schemars(extend("minItems" = 1))]
    pub keyframes: Option<Located<Vec<Located<CameraKeyEntry>>>>,
    /// How keyframes lead from one to the next; "linear" when left out.
    pub interpolation: Option<Located<InterpolationName>>,
    /// A `[[node]]` that takes the camera along at frames.
    pub node: Option<Located<String>>,
    /// A `[[medium]]` that the camera is within; where no surface with that `interior` is around the camera, it is everywhere.
    pub medium: Option<Located<String>>,
}

/// The places of keys by their names, of those that belong to some projections alone.
macro_rules! places {
    ($table:ident, $name:ident: $($key:ident)*) => {
        match $name {
            $(stringify!($key) => $table.$key.as_ref().map(|written| &written.place),)*
            _ => None,
        }
    };
}

impl CameraTable {
    fn place_of(&self, key: &str) -> Option<&Place> {
        places!(self, key: height vfov azimuth elevation fov mapping fit layout focal principal_point image_size radial tangential
            calibration shift stretch aperture stereo)
    }

    /// Checks the keys that are written beside such a projection.
    ///
    /// # Errors
    /// The place of a key that does not belong there, or of what lacks one, and a sentence about it.
    pub fn check_keys(&self, projection: ProjectionName) -> Result<(), (&Place, String)> {
        for rule in RULES {
            let Some(place) = self.place_of(rule.key) else { continue };
            if !rule.projections.contains(&projection) {
                let names: Vec<String> = rule.projections.iter().map(|name| format!("\"{}\"", name.name())).collect();
                return Err((place, format!("`{}` belongs to projection = {}", rule.key, names.join(" or "))));
            }
            if self.calibration.is_some() && CALIBRATED.contains(&rule.key) {
                return Err((place, format!("`{}` is in the file that `calibration` names", rule.key)));
            }
        }
        match needed(projection) {
            Some(key) if self.calibration.is_none() && self.place_of(key).is_none() => {
                Err((&self.look_at.place, format!("the camera needs the key `{key}`")))
            }
            _ => Ok(()),
        }
    }
}

/// Two eyes, the camera's position in the middle. With `equirectangular` and `cylindrical` they turn with the direction (omnidirectional stereo).
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { layout = \"top_bottom\", eye_distance = 0.064 }")]
pub struct StereoEntry {
    /// The places of both eyes' pictures.
    pub layout: ChoiceName<StereoLayout>,
    /// From one eye to the other, in scene units.
    pub eye_distance: Checked<Positive>,
    /// Distance at which both eyes see a thing at the same place of their pictures; infinite when left out.
    pub convergence: Option<Checked<Positive>>,
}

/// The opening of a thin lens.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(rename = "key:shape", rename_all = "snake_case")]
#[schemars(tag = "shape", rename = "ApertureEntry")]
pub enum ApertureEntry {
    Disk(RoundAperture),
    Square(RoundAperture),
    Polygon(PolygonAperture),
}

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct RoundAperture {
    /// Radius of a disk, half the side of a square.
    pub radius: Checked<NonNegative>,
}

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct PolygonAperture {
    /// Radius of the circle through the corners.
    pub radius: Checked<NonNegative>,
    /// Number of corners, at least 3; 6 when left out.
    #[schemars(extend("minimum" = 3, "maximum" = 64))]
    pub blades: Option<Located<u32>>,
    /// Degrees, 0 when left out.
    pub rotation: Option<Number>,
}
