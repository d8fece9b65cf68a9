//! `type = "directional"`

use std::ops::Range;

use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::LightKeys;
use crate::load::error::SceneError;
use crate::load::file::colour::Rgb;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Located, NonNegative, Vector};
use crate::load::file::writer::{Writer, colour, direction, line};
use crate::scene::DirectionalLight;

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "DirectionalLight")]
pub struct Keys {
    /// The way the light travels.
    direction: Located<Vector>,
    /// On a surface that faces the light, W·m⁻².
    irradiance: Rgb<NonNegative>,
}

impl LightKeys for Keys {
    type Light = DirectionalLight;

    const EXAMPLES: &'static [&'static str] = &["direction = [1, -2, -0.7]\nirradiance = [0.5, 0.6, 0.7]"];

    fn resolve(&self, resolver: &mut Resolver<'_>, _: &Range<usize>) -> Result<DirectionalLight, SceneError> {
        Ok(DirectionalLight { direction: resolver.direction(&self.direction)?, irradiance: self.irradiance.0 })
    }

    fn write(light: &DirectionalLight, _: &mut Writer<'_>) -> String {
        line("direction", &direction(light.direction)) + &line("irradiance", &colour(light.irradiance))
    }
}
