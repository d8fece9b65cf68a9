//! Keyframes as they are written: what is elsewhere at another frame.

use std::borrow::Cow;

use glam::DVec3;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer};

use super::colour::{Rgb, any_of};
use super::value::{Any, Checked, FieldOfView, Located, NonNegative, Number, Positive, Vector, vector};
use crate::scene::animation::Interpolation;
use crate::spectrum::Spectrum;

/// One factor or one per axis.
#[derive(Debug, Clone)]
pub struct ScaleEntry(pub DVec3);

impl<'de> Deserialize<'de> for ScaleEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Rgb::<Any>::deserialize_as(deserializer, "one factor or one per axis")
            .map(|factors| ScaleEntry(DVec3::from_array(factors)))
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
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
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
#[derive(Debug, Clone, Deserialize, JsonSchema)]
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
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { frame = 10, position = [0, 1, 5] }")]
#[schemars(rename = "CameraKeyframe")]
#[schemars(extend("oneOf" = [{ "required": ["frame"] }, { "required": ["time"] }],
    "anyOf" = [{ "required": ["position"] }, { "required": ["look_at"] }, { "required": ["up"] }, { "required": ["vfov"] },
        { "required": ["height"] }, { "required": ["focus_distance"] }]))]
pub struct CameraKeyEntry {
    /// Number of the frame, not necessarily a whole one; or `time`.
    pub frame: Option<Number>,
    /// Seconds after the start.
    pub time: Option<Number>,
    pub position: Option<Vector>,
    pub look_at: Option<Vector>,
    pub up: Option<Vector>,
    /// Field of view of a perspective camera.
    pub vfov: Option<Located<Checked<FieldOfView>>>,
    /// Height of an orthographic camera's view.
    pub height: Option<Located<Checked<Positive>>>,
    pub focus_distance: Option<Checked<Positive>>,
}

/// The keys of a shape that state its transform at frames.
#[derive(Clone, Copy)]
pub struct WrittenTrack<'a> {
    pub keyframes: Option<&'a Located<Vec<Located<TransformKeyEntry>>>>,
    pub interpolation: Option<&'a Located<InterpolationName>>,
    pub node: Option<&'a Located<String>>,
    /// The shape's own motion is written.
    pub has_motion: bool,
}

/// The values that a keyframe of a light states.
pub struct LightKey<'a> {
    pub frame: Option<Number>,
    pub time: Option<Number>,
    pub position: Option<DVec3>,
    pub direction: Option<&'a Located<Vector>>,
    /// Intensity, irradiance or radiance.
    pub strength: Option<Spectrum>,
    /// Rotation of an environment.
    pub rotation_degrees: Option<f64>,
}

/// A keyframe of a light of some type.
pub trait LightKeyEntry {
    /// The keys that it may state, in words.
    const STATES: &'static str;

    /// The values that it states.
    fn key(&self) -> LightKey<'_>;
}

/// The keys of a light that state its values at frames.
#[derive(Clone, Copy)]
pub struct WrittenLightTrack<'a, K> {
    pub keyframes: Option<&'a Located<Vec<Located<K>>>>,
    pub interpolation: Option<&'a Located<InterpolationName>>,
    pub node: Option<&'a Located<String>>,
}

/// A point light at a frame. What it does not state goes through the keyframes that do, or stays as the light has it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { frame = 10, position = [0, 1, 5] }")]
#[schemars(rename = "PointLightKeyframe")]
#[schemars(extend("oneOf" = [{ "required": ["frame"] }, { "required": ["time"] }],
    "anyOf" = [{ "required": ["position"] }, { "required": ["intensity"] }]))]
pub struct PointKeyEntry {
    /// Number of the frame, not necessarily a whole one; or `time`.
    pub frame: Option<Number>,
    /// Seconds after the start.
    pub time: Option<Number>,
    pub position: Option<Vector>,
    pub intensity: Option<Rgb<NonNegative>>,
}

/// A spot light at a frame. What it does not state goes through the keyframes that do, or stays as the light has it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { frame = 10, direction = [0, -1, 0] }")]
#[schemars(rename = "SpotLightKeyframe")]
#[schemars(extend("oneOf" = [{ "required": ["frame"] }, { "required": ["time"] }],
    "anyOf" = [{ "required": ["position"] }, { "required": ["direction"] }, { "required": ["intensity"] }]))]
pub struct SpotKeyEntry {
    /// Number of the frame, not necessarily a whole one; or `time`.
    pub frame: Option<Number>,
    /// Seconds after the start.
    pub time: Option<Number>,
    pub position: Option<Vector>,
    pub direction: Option<Located<Vector>>,
    pub intensity: Option<Rgb<NonNegative>>,
}

/// A directional light at a frame. What it does not state goes through the keyframes that do, or stays as the light has it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { frame = 10, direction = [0, -1, 0] }")]
#[schemars(rename = "DirectionalLightKeyframe")]
#[schemars(extend("oneOf" = [{ "required": ["frame"] }, { "required": ["time"] }],
    "anyOf" = [{ "required": ["direction"] }, { "required": ["irradiance"] }]))]
pub struct DirectionalKeyEntry {
    /// Number of the frame, not necessarily a whole one; or `time`.
    pub frame: Option<Number>,
    /// Seconds after the start.
    pub time: Option<Number>,
    pub direction: Option<Located<Vector>>,
    pub irradiance: Option<Rgb<NonNegative>>,
}

/// An environment at a frame. What it does not state goes through the keyframes that do, or stays as the light has it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table such as { frame = 10, rotate = 90 }")]
#[schemars(rename = "EnvironmentKeyframe")]
#[schemars(extend("oneOf" = [{ "required": ["frame"] }, { "required": ["time"] }],
    "anyOf" = [{ "required": ["radiance"] }, { "required": ["rotate"] }]))]
pub struct EnvironmentKeyEntry {
    /// Number of the frame, not necessarily a whole one; or `time`.
    pub frame: Option<Number>,
    /// Seconds after the start.
    pub time: Option<Number>,
    /// Radiance of an environment with `radiance`, which its `scale` multiplies.
    pub radiance: Option<Located<Rgb<NonNegative>>>,
    /// Degrees about +Y.
    pub rotate: Option<Number>,
}

impl LightKey<'_> {
    /// One that states nothing yet.
    fn at(frame: Option<Number>, time: Option<Number>) -> Self {
        Self { frame, time, position: None, direction: None, strength: None, rotation_degrees: None }
    }
}

fn rgb(written: Option<&Rgb<NonNegative>>) -> Option<Spectrum> {
    written.map(|colour| colour.0)
}

impl LightKeyEntry for PointKeyEntry {
    const STATES: &'static str = "`position` or `intensity`";

    fn key(&self) -> LightKey<'_> {
        let position = self.position.map(vector);
        LightKey { position, strength: rgb(self.intensity.as_ref()), ..LightKey::at(self.frame, self.time) }
    }
}

impl LightKeyEntry for SpotKeyEntry {
    const STATES: &'static str = "`position`, `direction` or `intensity`";

    fn key(&self) -> LightKey<'_> {
        let (position, direction) = (self.position.map(vector), self.direction.as_ref());
        LightKey { position, direction, strength: rgb(self.intensity.as_ref()), ..LightKey::at(self.frame, self.time) }
    }
}

impl LightKeyEntry for DirectionalKeyEntry {
    const STATES: &'static str = "`direction` or `irradiance`";

    fn key(&self) -> LightKey<'_> {
        let direction = self.direction.as_ref();
        LightKey { direction, strength: rgb(self.irradiance.as_ref()), ..LightKey::at(self.frame, self.time) }
    }
}

impl LightKeyEntry for EnvironmentKeyEntry {
    const STATES: &'static str = "`radiance` or `rotate`";

    fn key(&self) -> LightKey<'_> {
        let strength = rgb(self.radiance.as_ref().map(|radiance| &radiance.value));
        LightKey { strength, rotation_degrees: self.rotate.map(|degrees| degrees.0), ..LightKey::at(self.frame, self.time) }
    }
}
