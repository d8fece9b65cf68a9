//! `[[light]]`: lights that are not surfaces.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::load::file::value::{Checked, HalfAngle, Located, NonNegative, Number, Rgb, Vector};

/// A light that is not a surface. Surfaces emit through their material.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "type")]
pub enum LightEntry {
    Environment(EnvironmentLight),
    Sky(SkyLight),
    Point(PointLight),
    Spot(SpotLight),
    Directional(DirectionalLight),
}

/// Radiance from outside the scene: either `radiance` or `file`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct EnvironmentLight {
    /// The same radiance from everywhere.
    pub radiance: Option<Located<Rgb<NonNegative>>>,
    /// A lat-long map, EXR or HDR: u = atan2(x, −z)/2π (mod 1), v = acos(y)/π from the top row, interpolated bilinearly.
    pub file: Option<Located<String>>,
    /// Factor of the radiance, 1 when left out.
    pub scale: Option<Located<Checked<NonNegative>>>,
    /// Degrees about +Y, counter-clockwise seen from above.
    pub rotate: Option<Number>,
}

/// Three colours by the height y of a direction of length 1: horizon + (zenith − horizon)·y above the horizon, ground below.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct SkyLight {
    pub zenith: Rgb<NonNegative>,
    pub horizon: Rgb<NonNegative>,
    pub ground: Rgb<NonNegative>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct PointLight {
    pub position: Vector,
    /// W·sr⁻¹
    pub intensity: Rgb<NonNegative>,
}

/// A point light cut to a cone. Between the angles `falloff` and `angle` the intensity falls as t²(3 − 2t), where t goes from 1 to 0 in
/// proportion to the cosine of the angle.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct SpotLight {
    pub position: Vector,
    pub direction: Located<Vector>,
    /// W·sr⁻¹ on the axis.
    pub intensity: Rgb<NonNegative>,
    /// Degrees from the axis past which there is no light.
    pub angle: Checked<HalfAngle>,
    /// Degrees from the axis up to which the intensity is full; `angle` when left out.
    pub falloff: Option<Located<Checked<NonNegative>>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct DirectionalLight {
    /// The way the light travels.
    pub direction: Located<Vector>,
    /// On a surface that faces the light, W·m⁻².
    pub irradiance: Rgb<NonNegative>,
}
