//! The scene file as it is written: one type per table. The JSON Schema is generated from these types.
//!
//! A table whose shape depends on a key (`type` mostly) is an enum with one struct per value of that key; its name for serde is that key
//! ([`super::reader`]).

mod camera;
mod choice_name;
mod output;
mod render;
mod texture;

use std::num::NonZeroU32;

use schemars::JsonSchema;
use serde::Deserialize;

pub use camera::{ApertureEntry, CameraTable, ProjectionName, RoundAperture};
pub use output::OutputTable;
pub use render::RenderTable;
pub use texture::{CheckerEntry, ColorSpaceEntry, CommonKeys, ImageEntry, TextureEntry, TextureFilterEntry, WrapEntry};

use super::document::FORMAT_VERSION;
use super::import::ImportEntry;
use super::instance::{GroupEntry, InstanceEntry};
use super::keyframes::AnimationTable;
use super::light::LightEntry;
use super::material::MaterialEntry;
use super::medium::MediumEntry;
use super::meter::MeterEntry;
use super::node::NodeEntry;
use super::shape::ShapeEntry;
use super::value::{Checked, Exactly, FilterRadius, Located};

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
