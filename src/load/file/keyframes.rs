//! Keyframes as they are written: what is elsewhere at another frame.

use std::borrow::Cow;

use glam::DVec3;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer};

use super::colour::{Rgb, any_of};
use super::value::{Any, Checked, FieldOfView, Located, Number, Positive, Vector};
use crate::scene::animation::Interpolation;

/// One factor or one per axis.
#[derive(Debug)]
pub struct ScaleEntry(pub DVec3);

impl<'de> Deserialize<'de> for ScaleEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Rgb::<Any>::deserialize_as(deserializer, "one factor or one per axis").map(ScaleEntry)
    }
}

impl JsonSchema for ScaleEntry {
    fn schema_name() -> Cow<'static, str> {
        "Scale".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        any_of(vec![generator.subschema_for::<Number>(), generator.subschema_for::<Vector>()])
    }
}

/// How frames and seconds belong together.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "Animation")]
pub struct AnimationTable {
    /// Frames in a second: frame n is n / fps seconds after the start. 24 when left out.
    pub fps: Option<Checked<Positive>>,
}

/// How keyframes lead from one to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Interpolation")]
pub enum InterpolationName {
    /// Evenly.
    Linear,
    /// With a speed that does not jump, from rest to rest, and never beyond the keys' values.
    Smooth,
    /// By jumps: what a key states holds until the next.
    Step,
}

impl From<InterpolationName> for Interpolation {
    fn from(name: InterpolationName) -> Self {
        match name {
            InterpolationName::Linear => Self::Linear,
            InterpolationName::Smooth => Self::Smooth,
            InterpolationName::Step => Self::Step,
        }
    }
}

/// A transform at a frame: what is scaled first, then turned, then moved. A part that it does not state goes through the keyframes that do.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { frame = 10, translate = [0, 1, 0] }")]
#[schemars(rename = "TransformKeyframe")]
#[schemars(extend("oneOf" = [{ "required": ["frame"] }, { "required": ["time"] }],
    "anyOf" = [{ "required": ["scale"] }, { "required": ["rotate"] }, { "required": ["translate"] }],
    "dependentRequired" = { "degrees": ["rotate"], "rotate": ["degrees"] }))]
pub struct TransformKeyEntry {
    /// Number of the frame, not necessarily a whole one; or `time`.
    pub frame: Option<Number>,
    /// Seconds after the start.
    pub time: Option<Number>,
    /// One factor or one per axis; not 0.
    pub scale: Option<Located<ScaleEntry>>,
    /// The axis of a rotation by `degrees`. Between keyframes about the same axis the angle goes evenly, also beyond a whole turn; between different
    /// axes the rotation takes the shortest way.
    pub rotate: Option<Located<Vector>>,
    /// Counter-clockwise seen from the axis' tip.
    pub degrees: Option<Located<Number>>,
    pub translate: Option<Vector>,
}

/// The camera at a frame. What it does not state goes through the keyframes that do, or stays as `[camera]` has it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { frame = 10, position = [0, 1, 5] }")]
#[schemars(rename = "CameraKeyframe")]
#[schemars(extend("oneOf" = [{ "required": ["frame"] }, { "required": ["time"] }]))]
pub struct CameraKeyEntry {
    /// Number of the frame, not necessarily a whole one; or `time`.
    pub frame: Option<Number>,
    /// Seconds after the start.
    pub time: Option<Number>,
    pub position: Option<Vector>,
    pub look_at: Option<Vector>,
    pub up: Option<Vector>,
    /// Of a perspective camera.
    pub vfov: Option<Located<Checked<FieldOfView>>>,
    /// Of an orthographic camera.
    pub height: Option<Located<Checked<Positive>>>,
    pub focus_distance: Option<Checked<Positive>>,
}

/// What of a shape says where it is at frames.
#[derive(Clone, Copy)]
pub struct WrittenTrack<'a> {
    pub keyframes: Option<&'a Located<Vec<Located<TransformKeyEntry>>>>,
    pub interpolation: Option<&'a Located<InterpolationName>>,
    pub node: Option<&'a Located<String>>,
    /// The shape's own motion is written.
    pub has_motion: bool,
}
