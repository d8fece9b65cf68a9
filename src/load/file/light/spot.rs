//! `type = "spot"`

use std::ops::Range;

use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::LightKeys;
use crate::load::error::SceneError;
use crate::load::file::colour::Rgb;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, HalfAngle, Located, NonNegative, Vector, vector};
use crate::load::file::writer::{self, Writer, colour, direction, line, number};
use crate::scene::SpotLight;

/// A point light cut to a cone. Between the angles `falloff` and `angle` the intensity falls as t²(3 − 2t), where t goes from 1 to 0 in
/// proportion to the cosine of the angle.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "SpotLight")]
pub struct Keys {
    position: Vector,
    direction: Located<Vector>,
    /// W·sr⁻¹ on the axis.
    intensity: Rgb<NonNegative>,
    /// Degrees from the axis past which there is no light.
    angle: Checked<HalfAngle>,
    /// Degrees from the axis up to which the intensity is full; `angle` when left out.
    falloff: Option<Located<Checked<NonNegative>>>,
}

impl LightKeys for Keys {
    type Light = SpotLight;

    const EXAMPLES: &'static [&'static str] =
        &["position = [1, 3, 2]\ndirection = [-0.5, -1, -0.6]\nintensity = [20, 18, 15]\nangle = 35\nfalloff = 10"];

    fn resolve(&self, resolver: &mut Resolver<'_>, _: &Range<usize>) -> Result<SpotLight, SceneError> {
        let angle = self.angle.0;
        let falloff = self.falloff.as_ref().map_or(angle, |falloff| falloff.value.0);
        if let Some(written) = &self.falloff
            && falloff > angle
        {
            return Err(resolver.error(&written.span, format!("`falloff` is at most `angle`, {angle} degrees")));
        }
        Ok(SpotLight {
            position: vector(self.position),
            direction: resolver.direction(&self.direction)?,
            intensity: self.intensity.0,
            angle_degrees: angle,
            falloff_degrees: falloff,
        })
    }

    fn write(light: &SpotLight, _: &mut Writer<'_>) -> String {
        [
            line("position", &writer::vector(light.position)),
            line("direction", &direction(light.direction)),
            line("intensity", &colour(light.intensity)),
            line("angle", &number(light.angle_degrees)),
            line("falloff", &number(light.falloff_degrees)),
        ]
        .concat()
    }
}
