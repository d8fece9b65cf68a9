//! `type = "point"`

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::LightKeys;
use super::profile::{ProfileEntry, write_profile};
use crate::load::error::SceneError;
use crate::load::file::colour::Rgb;
use crate::load::file::keyframes::{InterpolationName, PointKeyEntry, WrittenLightTrack};
use crate::load::file::light_group::LightGroupName;
use crate::load::file::light_link::ReceiverNames;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Located, NonNegative, Vector, vector};
use crate::load::file::writer::{self, Writer, colour, direction, line};
use crate::load::place::Place;
use crate::scene::PointLight;
use crate::scene::animation::LightTrack;

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "PointLight", extend("dependentRequired" = { "interpolation": ["keyframes"], "direction": ["profile"], "front": ["profile"] }))]
pub struct Keys {
    pub position: Vector,
    /// W·sr⁻¹; with `profile`, for each candela there: 1 takes candela for W·sr⁻¹, as lights of glTF are read, and 1/683 = 0.001464 goes by the SI's 683 lm/W.
    pub intensity: Rgb<NonNegative>,
    /// Light by direction: a photometric file (IES LM-63, `.ies`, type C) or its table. The same in all directions when left out.
    pub profile: Option<Located<ProfileEntry>>,
    /// With `profile`: the direction of vertical angle 0; [0, -1, 0] when left out.
    pub direction: Option<Located<Vector>>,
    /// With `profile`: the side of horizontal angle 0, projected across `direction`; [1, 0, 0] when left out. Horizontal angles grow counter-clockwise for who looks along `direction`.
    pub front: Option<Located<Vector>>,
    /// Values at frames (`--frame`, `--frames`, `--time`); without a frame the other keys hold.
    #[schemars(extend("minItems" = 1))]
    pub keyframes: Option<Located<Vec<Located<PointKeyEntry>>>>,
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
    type Light = PointLight;

    const EXAMPLES: &'static [&'static str] = &[
        "position = [-2, 3, 2]\nintensity = [6, 5, 4]",
        "position = [-2, 3, 2]\nintensity = [0.06, 0.05, 0.04]\ndirection = [0.4, -1, -0.3]\nfront = [0.2, 0.1, 1]\nprofile = { vertical = [0, 20, 50, 90, 120], horizontal = [0, 60, 180, 250, 360], candela = [[100, 80, 120, 30, 0], [100, 90, 40, 60, 10], [100, 20, 70, 50, 0], [100, 60, 90, 20, 5], [100, 80, 120, 30, 0]] }",
    ];
    const STRENGTH: &'static str = "intensity";

    fn resolve(&self, resolver: &mut Resolver<'_>, _: &Place) -> Result<PointLight, SceneError> {
        let profile = match &self.profile {
            Some(written) => {
                let nadir = self.direction.as_ref().map_or(Ok(DVec3::NEG_Y), |direction| resolver.direction(direction))?;
                Some(resolver.aimed_profile(written, nadir, self.front.as_ref())?)
            }
            None => {
                if let Some(stray) = self.direction.as_ref().or(self.front.as_ref()) {
                    let message =
                        "`direction` and `front` belong to `profile`: without one, a point light shines alike in all directions";
                    return Err(resolver.error(&stray.place, message));
                }
                None
            }
        };
        Ok(PointLight { position: vector(self.position), intensity: self.intensity.0, profile })
    }

    fn track(&self, resolver: &Resolver<'_>) -> Result<Option<LightTrack>, SceneError> {
        resolver.light_track(WrittenLightTrack {
            keyframes: self.keyframes.as_ref(),
            interpolation: self.interpolation.as_ref(),
            node: self.node.as_ref(),
        })
    }

    fn write(light: &PointLight, writer: &mut Writer<'_>) -> String {
        let keys = line("position", &writer::vector(light.position)) + &line("intensity", &colour(light.intensity));
        match &light.profile {
            Some(aimed) => keys + &line("direction", &direction(aimed.nadir)) + &write_profile(aimed, writer),
            None => keys,
        }
    }
}
