//! `type = "point"`

use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::LightKeys;
use crate::load::error::SceneError;
use crate::load::file::colour::Rgb;
use crate::load::file::keyframes::{InterpolationName, PointKeyEntry, WrittenLightTrack};
use crate::load::file::light_group::LightGroupName;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Located, NonNegative, Vector, vector};
use crate::load::file::writer::{self, Writer, colour, line};
use crate::load::place::Place;
use crate::scene::PointLight;
use crate::scene::animation::LightTrack;

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "PointLight", extend("dependentRequired" = { "interpolation": ["keyframes"] }))]
pub struct Keys {
    pub position: Vector,
    /// W·sr⁻¹
    pub intensity: Rgb<NonNegative>,
    /// Values at frames (`--frame`, `--frames`, `--time`); without a frame the other keys hold.
    #[schemars(extend("minItems" = 1))]
    pub keyframes: Option<Located<Vec<Located<PointKeyEntry>>>>,
    /// How keyframes lead from one to the next; "linear" when left out.
    pub interpolation: Option<Located<InterpolationName>>,
    /// A `[[node]]` that takes the light along at frames.
    pub node: Option<Located<String>>,
    /// The light group in which `--aov groups` keeps its light apart; "rest" when left out.
    pub light_group: Option<Located<LightGroupName>>,
}

impl LightKeys for Keys {
    type Light = PointLight;

    const EXAMPLES: &'static [&'static str] = &["position = [-2, 3, 2]\nintensity = [6, 5, 4]"];
    const STRENGTH: &'static str = "intensity";

    fn resolve(&self, _: &mut Resolver<'_>, _: &Place) -> Result<PointLight, SceneError> {
        Ok(PointLight { position: vector(self.position), intensity: self.intensity.0 })
    }

    fn track(&self, resolver: &Resolver<'_>) -> Result<Option<LightTrack>, SceneError> {
        resolver.light_track(WrittenLightTrack {
            keyframes: self.keyframes.as_ref(),
            interpolation: self.interpolation.as_ref(),
            node: self.node.as_ref(),
        })
    }

    fn write(light: &PointLight, _: &mut Writer<'_>) -> String {
        line("position", &writer::vector(light.position)) + &line("intensity", &colour(light.intensity))
    }
}
