//! `type = "directional"`

use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::LightKeys;
use crate::load::error::SceneError;
use crate::load::file::colour::Rgb;
use crate::load::file::keyframes::{DirectionalKeyEntry, InterpolationName, WrittenLightTrack};
use crate::load::file::light_group::LightGroupName;
use crate::load::file::light_link::ReceiverNames;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Located, NonNegative, Vector};
use crate::load::file::writer::{Writer, colour, direction, line};
use crate::load::place::Place;
use crate::scene::DirectionalLight;
use crate::scene::animation::LightTrack;

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "DirectionalLight", extend("dependentRequired" = { "interpolation": ["keyframes"] }))]
pub struct Keys {
    /// The way the light travels.
    pub direction: Located<Vector>,
    /// On a surface that faces the light, W·m⁻².
    pub irradiance: Rgb<NonNegative>,
    /// Values at frames (`--frame`, `--frames`, `--time`); without a frame the other keys hold.
    #[schemars(extend("minItems" = 1))]
    pub keyframes: Option<Located<Vec<Located<DirectionalKeyEntry>>>>,
    /// How keyframes lead from one to the next; "linear" when left out.
    pub interpolation: Option<Located<InterpolationName>>,
    /// A `[[node]]` that takes the light along at frames.
    pub node: Option<Located<String>>,
    /// The light group in which `--aov groups` keeps its light apart; "rest" when left out.
    pub light_group: Option<Located<LightGroupName>>,
    /// The receivers that the light lights, by the names that objects give them (`receiver`); all when left out.
    pub lights_only: Option<ReceiverNames>,
    /// In place of `lights_only`: the receivers that the light does not light.
    pub lights_all_but: Option<ReceiverNames>,
}

impl LightKeys for Keys {
    type Light = DirectionalLight;

    const EXAMPLES: &'static [&'static str] = &["direction = [1, -2, -0.7]\nirradiance = [0.5, 0.6, 0.7]"];
    const STRENGTH: &'static str = "irradiance";

    fn resolve(&self, resolver: &mut Resolver<'_>, _: &Place) -> Result<DirectionalLight, SceneError> {
        Ok(DirectionalLight { direction: resolver.direction(&self.direction)?, irradiance: self.irradiance.0 })
    }

    fn track(&self, resolver: &Resolver<'_>) -> Result<Option<LightTrack>, SceneError> {
        resolver.light_track(WrittenLightTrack {
            keyframes: self.keyframes.as_ref(),
            interpolation: self.interpolation.as_ref(),
            node: self.node.as_ref(),
        })
    }

    fn write(light: &DirectionalLight, _: &mut Writer<'_>) -> String {
        line("direction", &direction(light.direction)) + &line("irradiance", &colour(light.irradiance))
    }
}
