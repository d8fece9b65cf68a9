//! `type = "projector"`

use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::LightKeys;
use super::spot::up_across;
use crate::load::error::SceneError;
use crate::load::file::colour::Rgb;
use crate::load::file::light_group::LightGroupName;
use crate::load::file::light_link::ReceiverNames;
use crate::load::file::reference::TextureName;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, FieldOfView, Located, NonNegative, Positive, Vector, vector};
use crate::load::file::writer::{self, Writer, colour, direction, line, number};
use crate::load::place::Place;
use crate::scene::{Projector, TextureKind};

/// A light from one point that projects a rectangular picture.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "ProjectorLight")]
pub struct Keys {
    pub position: Vector,
    pub direction: Located<Vector>,
    /// Direction towards the picture's upper edge; [0, 1, 0] when left out.
    pub up: Option<Located<Vector>>,
    /// W·m⁻² where the texture is white, on a plane at distance 1 that faces the projector.
    pub irradiance: Rgb<NonNegative>,
    /// Degrees from the picture's lower edge to its upper one.
    pub vfov: Checked<FieldOfView>,
    /// Width of the picture over its height; that of the texture's image when left out, and 1 without an image.
    pub aspect: Option<Checked<Positive>>,
    /// A `[[texture]]`'s name; white when left out.
    pub texture: Option<Located<TextureName>>,
    /// The light group in which `--aov groups` keeps its light apart; "rest" when left out.
    pub light_group: Option<Located<LightGroupName>>,
    /// The receivers that the light lights, by the names that objects give them (`receiver`); all when left out.
    pub lights_only: Option<ReceiverNames>,
    /// In place of `lights_only`: the receivers that the light does not light.
    pub lights_all_but: Option<ReceiverNames>,
}

impl LightKeys for Keys {
    type Light = Projector;

    const EXAMPLES: &'static [&'static str] = &[
        "position = [1, 3, 2]\ndirection = [-0.5, -1, -0.6]\nirradiance = [9, 8, 7]\nvfov = 70\naspect = 1.5\nup = [0.2, 0.5, 1]",
    ];
    const STRENGTH: &'static str = "irradiance";

    fn resolve(&self, resolver: &mut Resolver<'_>, _: &Place) -> Result<Projector, SceneError> {
        let texture = self.texture.as_ref().map(|name| resolver.texture_id(name)).transpose()?;
        let of_image = texture.and_then(|id| match &resolver.scene.textures[id].kind {
            TextureKind::Image(image) => Some(f64::from(image.image.width) / f64::from(image.image.height)),
            _ => None,
        });
        Ok(Projector {
            position: vector(self.position),
            direction: resolver.direction(&self.direction)?,
            up: up_across(resolver, &self.direction, self.up.as_ref())?,
            irradiance: self.irradiance.0,
            vertical_fov_degrees: self.vfov.0,
            aspect: self.aspect.as_ref().map(|aspect| aspect.0).or(of_image).unwrap_or(1.0),
            texture,
        })
    }

    fn write(light: &Projector, writer: &mut Writer<'_>) -> String {
        [
            line("position", &writer::vector(light.position)),
            line("direction", &direction(light.direction)),
            line("up", &writer::vector(light.up)),
            line("irradiance", &colour(light.irradiance)),
            line("vfov", &number(light.vertical_fov_degrees)),
            line("aspect", &number(light.aspect)),
            light.texture.map_or(String::new(), |texture| line("texture", &writer.textures.quoted(texture))),
        ]
        .concat()
    }
}
