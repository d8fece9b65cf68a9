//! `type = "spot"`

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::LightKeys;
use super::profile::{ProfileEntry, write_profile};
use crate::load::error::SceneError;
use crate::load::file::colour::Rgb;
use crate::load::file::keyframes::{InterpolationName, SpotKeyEntry, WrittenLightTrack};
use crate::load::file::light_group::LightGroupName;
use crate::load::file::light_link::ReceiverNames;
use crate::load::file::reference::TextureName;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, HalfAngle, Located, NonNegative, Vector, vector};
use crate::load::file::writer::{self, Writer, colour, direction, line, number};
use crate::load::place::Place;
use crate::scene::animation::LightTrack;
use crate::scene::{FalloffCurve, ProjectedTexture, SpotLight};

/// A point light cut to a cone. Between the angles `falloff` and `angle` the intensity falls as `curve` says.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "SpotLight", extend("dependentRequired" = { "interpolation": ["keyframes"], "front": ["profile"] }))]
pub struct Keys {
    pub position: Vector,
    pub direction: Located<Vector>,
    /// W·sr⁻¹ on the axis; with `profile`, for each candela there, as of a point light.
    pub intensity: Rgb<NonNegative>,
    /// Degrees from the axis past which there is no light.
    pub angle: Checked<HalfAngle>,
    /// Degrees from the axis up to which the intensity is full; `angle` when left out.
    pub falloff: Option<Located<Checked<NonNegative>>>,
    /// How it falls between them; "smooth" when left out.
    pub curve: Option<CurveName>,
    /// A `[[texture]]`'s name, which multiplies the intensity: it fills the square around the cone. Then `angle` is below 90.
    pub texture: Option<Located<TextureName>>,
    /// With `texture`: where its upper edge is, seen from the light; [0, 1, 0] when left out.
    pub up: Option<Located<Vector>>,
    /// Light by direction, within the cone: a photometric file (IES LM-63, `.ies`, type C) or its table, of which `direction` is vertical angle 0.
    pub profile: Option<Located<ProfileEntry>>,
    /// With `profile`: the side of horizontal angle 0, projected across `direction`; [1, 0, 0] when left out. Horizontal angles grow counter-clockwise for who looks along `direction`.
    pub front: Option<Located<Vector>>,
    /// Values at frames (`--frame`, `--frames`, `--time`); without a frame the other keys hold.
    #[schemars(extend("minItems" = 1))]
    pub keyframes: Option<Located<Vec<Located<SpotKeyEntry>>>>,
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

/// How a spot light's intensity falls between its angles.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CurveName {
    /// t²(3 − 2t), where t goes from 1 to 0 in proportion to the cosine of the angle.
    Smooth,
    /// t², as glTF recommends.
    Square,
    /// In proportion to the angle, as in Mitsuba.
    Linear,
}

impl LightKeys for Keys {
    type Light = SpotLight;

    const EXAMPLES: &'static [&'static str] = &[
        "position = [1, 3, 2]\ndirection = [-0.5, -1, -0.6]\nintensity = [20, 18, 15]\nangle = 35\nfalloff = 10",
        "position = [1, 3, 2]\ndirection = [-0.5, -1, -0.6]\nintensity = 15\nangle = 35\nfalloff = 10\ncurve = \"square\"",
        "position = [1, 3, 2]\ndirection = [-0.5, -1, -0.6]\nintensity = 15\nangle = 35\nfalloff = 10\ncurve = \"linear\"",
        "position = [1, 3, 2]\ndirection = [-0.5, -1, -0.6]\nintensity = 0.15\nangle = 65\nfalloff = 10\nprofile = { vertical = [0, 15, 45, 80], horizontal = [0, 50, 90], candela = [[100, 160, 60, 20], [100, 120, 90, 40], [100, 70, 130, 0]] }",
    ];
    const STRENGTH: &'static str = "intensity";

    fn resolve(&self, resolver: &mut Resolver<'_>, _: &Place) -> Result<SpotLight, SceneError> {
        let angle = self.angle.0;
        let falloff = self.falloff.as_ref().map_or(angle, |falloff| falloff.value.0);
        if let Some(written) = &self.falloff
            && falloff > angle
        {
            return Err(resolver.error(&written.place, format!("`falloff` is at most `angle`, {angle} degrees")));
        }
        let picture = self.picture(resolver)?;
        let direction = resolver.direction(&self.direction)?;
        if let (Some(front), None) = (&self.front, &self.profile) {
            return Err(resolver.error(&front.place, "`front` belongs to `profile`, which this light has not"));
        }
        let written = self.profile.as_ref();
        let profile = written.map(|written| resolver.aimed_profile(written, direction, self.front.as_ref())).transpose()?;
        let light = SpotLight {
            position: vector(self.position),
            direction,
            intensity: self.intensity.0,
            angle_degrees: angle,
            falloff_degrees: falloff,
            curve: match self.curve {
                None | Some(CurveName::Smooth) => FalloffCurve::Smooth,
                Some(CurveName::Square) => FalloffCurve::Square,
                Some(CurveName::Linear) => FalloffCurve::Linear,
            },
            picture,
            profile,
        };
        match written.filter(|_| !light.shines()) {
            Some(written) => {
                Err(resolver.error(&written.place, format!("its profile gives no light within {angle} degrees of `direction`")))
            }
            None => Ok(light),
        }
    }

    fn track(&self, resolver: &Resolver<'_>) -> Result<Option<LightTrack>, SceneError> {
        resolver.light_track(WrittenLightTrack {
            keyframes: self.keyframes.as_ref(),
            interpolation: self.interpolation.as_ref(),
            node: self.node.as_ref(),
        })
    }

    fn write(light: &SpotLight, writer: &mut Writer<'_>) -> String {
        [
            line("position", &writer::vector(light.position)),
            line("direction", &direction(light.direction)),
            line("intensity", &colour(light.intensity)),
            line("angle", &number(light.angle_degrees)),
            line("falloff", &number(light.falloff_degrees)),
            match light.curve {
                FalloffCurve::Smooth => String::new(),
                FalloffCurve::Square => line("curve", "\"square\""),
                FalloffCurve::Linear => line("curve", "\"linear\""),
            },
            light.picture.map_or(String::new(), |picture| {
                line("texture", &writer.textures.quoted(picture.texture)) + &line("up", &writer::vector(picture.up))
            }),
            light.profile.as_ref().map_or(String::new(), |aimed| write_profile(aimed, writer)),
        ]
        .concat()
    }
}

impl Keys {
    fn picture(&self, resolver: &mut Resolver<'_>) -> Result<Option<ProjectedTexture>, SceneError> {
        let Some(name) = &self.texture else {
            return match &self.up {
                Some(up) => Err(resolver.error(&up.place, "`up` belongs to `texture`, which this light has not")),
                None => Ok(None),
            };
        };
        if self.angle.0 >= 90.0 {
            return Err(resolver.error(&name.place, "the texture of a spot light fills a cone with an `angle` below 90 degrees"));
        }
        let texture = resolver.texture_id(name)?;
        let up = up_across(resolver, &self.direction, self.up.as_ref())?;
        Ok(Some(ProjectedTexture { texture, up }))
    }
}

/// Which way is up in a picture that a light projects along `direction`.
pub fn up_across(
    resolver: &Resolver<'_>,
    direction: &Located<Vector>,
    up: Option<&Located<Vector>>,
) -> Result<DVec3, SceneError> {
    let written = up.map_or(DVec3::Y, |up| vector(up.value));
    let along = resolver.direction(direction)?;
    if written.try_normalize().is_some_and(|up| along.cross(up).length() > 1e-6) {
        return Ok(written);
    }
    let span = up.map_or(&direction.place, |up| &up.place);
    Err(resolver.error(span, "`up` is zero or lies along `direction`, so which way is up is not known"))
}
