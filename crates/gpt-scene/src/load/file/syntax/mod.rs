//! The scene file as it is written: one type per table. The JSON Schema is generated from these types.
//!
//! A table whose shape depends on a key (`type` mostly) is an enum with one struct per value of that key; its name for serde is that key
//! ([`super::reader`]).

mod output;
mod render;
mod texture;

use std::num::NonZeroU32;

use schemars::JsonSchema;
use serde::Deserialize;

pub use output::OutputTable;
pub use render::RenderTable;
pub use texture::{CheckerEntry, ColorSpaceEntry, CommonKeys, ImageEntry, TextureEntry, TextureFilterEntry, WrapEntry};

use super::document::FORMAT_VERSION;
use super::import::ImportEntry;
use super::instance::{GroupEntry, InstanceEntry};
use super::keyframes::{AnimationTable, CameraKeyEntry, InterpolationName};
use super::light::LightEntry;
use super::material::MaterialEntry;
use super::medium::MediumEntry;
use super::meter::MeterEntry;
use super::node::NodeEntry;
use super::shape::ShapeEntry;
use super::value::{Checked, Exactly, FieldOfView, FilterRadius, Located, NonNegative, Number, Positive, Vector};

/// A scene of the path tracer gpt. Lengths in scene units, angles in degrees, colours linear Rec.709, radiance in W·sr⁻¹·m⁻².
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a scene")]
#[schemars(title = "gpt scene")]
#[schemars(extend("required" = [], "anyOf" = [{ "required": ["camera"] }, { "required": ["import"] }]))]
pub struct SceneFile {
    /// Version of the scene format: 1, also when left out. A file of a newer version is refused.
    #[schemars(extend("minimum" = 1, "maximum" = FORMAT_VERSION))]
    #[allow(dead_code, reason = "`Document` looks at it before it reads the rest")]
    pub version: Option<NonZeroU32>,
    #[serde(default)]
    pub film: FilmTable,
    #[serde(default)]
    pub render: RenderTable,
    #[serde(default)]
    pub output: OutputTable,
    /// Left out where an imported file brings one.
    pub camera: Option<CameraTable>,
    #[serde(default)]
    pub animation: Option<AnimationTable>,
    #[serde(default)]
    pub node: Vec<Located<NodeEntry>>,
    #[serde(default)]
    pub texture: Vec<TextureEntry>,
    #[serde(default)]
    pub medium: Vec<MediumEntry>,
    #[serde(default)]
    pub material: Vec<MaterialEntry>,
    #[serde(default)]
    pub shape: Vec<Located<ShapeEntry>>,
    #[serde(default)]
    pub group: Vec<GroupEntry>,
    #[serde(default)]
    pub instance: Vec<Located<InstanceEntry>>,
    #[serde(default)]
    pub light: Vec<Located<LightEntry>>,
    #[serde(default)]
    pub meter: Vec<Located<MeterEntry>>,
    #[serde(default)]
    pub import: Vec<ImportEntry>,
}

/// The picture.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct FilmTable {
    /// Width and height in pixels, 512 × 512 when left out.
    #[schemars(extend("items" = { "type": "integer", "minimum": 1, "maximum": 32_768 }))]
    pub size: Option<Exactly<NonZeroU32, 2>>,
    /// How samples become pixels; a box of radius 0.5 when left out.
    pub filter: Option<FilterEntry>,
}

/// The shape around a pixel's centre by which its samples are drawn.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(rename = "key:type", rename_all = "snake_case")]
#[schemars(tag = "type", rename = "FilterEntry")]
pub enum FilterEntry {
    Box(FilterKeys),
    Tent(FilterKeys),
    Gaussian(FilterKeys),
    BlackmanHarris(FilterKeys),
}

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct FilterKeys {
    /// Half the filter's width in pixels; 0.5 for a box, 1 for a tent, 1.5 for gaussian and 2 for blackman_harris when left out.
    pub radius: Option<Checked<FilterRadius>>,
}

/// The camera, from which the picture is taken.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(extend("dependentRequired" = { "aperture": ["focus_distance"], "interpolation": ["keyframes"] }, "allOf" = [{ "oneOf": [
    { "required": ["vfov"], "not": { "required": ["height"] }, "properties": { "projection": { "const": "perspective" } } },
    { "required": ["height", "projection"], "not": { "required": ["vfov"] }, "properties": { "projection": { "const": "orthographic" } } },
] }]))]
pub struct CameraTable {
    pub position: Vector,
    /// The camera looks along `look_at - position`.
    pub look_at: Located<Vector>,
    /// [0, 1, 0] when left out.
    pub up: Option<Located<Vector>>,
    /// Vertical field of view in degrees; with `projection = "perspective"`.
    pub vfov: Option<Located<Checked<FieldOfView>>>,
    /// "perspective" when left out.
    pub projection: Option<Located<ProjectionName>>,
    /// Height of the window in scene units; with `projection = "orthographic"`.
    pub height: Option<Located<Checked<Positive>>>,
    /// How far the picture's middle lies to the right of the camera's axis and above it, in widths and heights of the picture; [0, 0] when left
    /// out.
    pub shift: Option<Exactly<Number, 2>>,
    /// Factor of what the picture shows from side to side, 1 when left out: at 2 all is half as wide as it should be. Below 0, left and right are
    /// exchanged, so that -1 is a mirror's picture.
    pub stretch: Option<Located<Number>>,
    /// The lens opening; a pinhole when left out.
    pub aperture: Option<Located<ApertureEntry>>,
    /// Distance along the viewing direction of the plane in focus; needed with an aperture.
    pub focus_distance: Option<Checked<Positive>>,
    /// Times at which the shutter opens and closes, [0, 1] when left out. Where there are keyframes they count in frames from the frame itself: 1 is
    /// the next frame.
    pub shutter: Option<Located<Exactly<Number, 2>>>,
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

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ProjectionName {
    Perspective,
    Orthographic,
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
