//! `type = "sky"`

use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::LightKeys;
use crate::load::error::SceneError;
use crate::load::file::colour::Rgb;
use crate::load::file::light_group::LightGroupName;
use crate::load::file::light_link::ReceiverNames;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Located, NonNegative};
use crate::load::file::writer::{Writer, colour, line};
use crate::load::place::Place;
use crate::scene::Sky;

/// Three colours by the height y of a direction of length 1: horizon + (zenith − horizon)·y above the horizon, ground below.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "SkyLight")]
pub struct Keys {
    pub zenith: Rgb<NonNegative>,
    pub horizon: Rgb<NonNegative>,
    pub ground: Rgb<NonNegative>,
    /// The light group in which `--aov groups` keeps its light apart; "rest" when left out.
    pub light_group: Option<Located<LightGroupName>>,
    /// The receivers that the light lights, by the names that objects give them (`receiver`); all when left out.
    pub lights_only: Option<ReceiverNames>,
    /// In place of `lights_only`: the receivers that the light does not light.
    pub lights_all_but: Option<ReceiverNames>,
}

impl LightKeys for Keys {
    type Light = Sky;

    const EXAMPLES: &'static [&'static str] = &["zenith = [0.2, 0.4, 0.9]\nhorizon = [0.8, 0.8, 0.7]\nground = [0.2, 0.15, 0.1]"];
    const STRENGTH: &'static str = "radiance";

    fn resolve(&self, _: &mut Resolver<'_>, _: &Place) -> Result<Sky, SceneError> {
        Ok(Sky { zenith: self.zenith.0, horizon: self.horizon.0, ground: self.ground.0 })
    }

    fn write(sky: &Sky, _: &mut Writer<'_>) -> String {
        [("zenith", sky.zenith), ("horizon", sky.horizon), ("ground", sky.ground)]
            .map(|(key, radiance)| line(key, &colour(radiance)))
            .concat()
    }
}
