//! `type = "point"`

use std::ops::Range;

use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::LightKeys;
use crate::load::error::SceneError;
use crate::load::file::colour::Rgb;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{NonNegative, Vector, vector};
use crate::load::file::writer::{self, Writer, colour, line};
use crate::scene::PointLight;

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "PointLight")]
pub struct Keys {
    position: Vector,
    /// W·sr⁻¹
    intensity: Rgb<NonNegative>,
}

impl LightKeys for Keys {
    type Light = PointLight;

    const EXAMPLES: &'static [&'static str] = &["position = [-2, 3, 2]\nintensity = [6, 5, 4]"];

    fn resolve(&self, _: &mut Resolver<'_>, _: &Range<usize>) -> Result<PointLight, SceneError> {
        Ok(PointLight { position: vector(self.position), intensity: self.intensity.0 })
    }

    fn write(light: &PointLight, _: &mut Writer<'_>) -> String {
        line("position", &writer::vector(light.position)) + &line("intensity", &colour(light.intensity))
    }
}
