//! How much of a surface there is: a key of every material.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::load::error::SceneError;
use crate::load::file::colour::{ChannelName, NumberOr};
use crate::load::file::reference::{NamesTextures, TextureName};
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, Fraction, Located};
use crate::scene::{BlendWeight, Channel, ChannelInput, ColorInput};
use crate::spectrum::Spectrum;

/// One number, or a texture.
pub type Opacity = NumberOr<Fraction, OpacityTexture>;

/// A texture that says how much of a surface there is.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table with the key `texture`")]
pub struct OpacityTexture {
    /// A `[[texture]]`'s name.
    texture: Located<TextureName>,
    /// The channel that counts; the red one when left out.
    channel: Option<ChannelName>,
    /// Multiplies the texture, 1 when left out.
    factor: Option<Checked<Fraction>>,
    /// Threshold: where it is given, the surface is opaque where the product is at least this, and absent
    /// elsewhere.
    cutoff: Option<Checked<Fraction>>,
}

impl NamesTextures for OpacityTexture {
    fn each_texture(&mut self, visit: &mut dyn FnMut(&mut String)) {
        self.texture.each_texture(visit);
    }
}

impl Opacity {
    /// The weight of the surface against nothing.
    pub fn weight(&self, resolver: &Resolver<'_>) -> Result<BlendWeight, SceneError> {
        let keys = match self {
            Self::Number(value) => return Ok(BlendWeight::Constant { value: value.0 }),
            Self::Table(keys) => keys,
        };
        let channel = keys.channel.map_or(Channel::R, Into::into);
        let factor = Spectrum::grey(keys.factor.map_or(1.0, |factor| factor.0));
        let weight = match resolver.texture_in_range::<Fraction>(&keys.texture, Some(channel), factor)? {
            ColorInput::Channel(ChannelInput { texture, channel, factor, .. }) => {
                BlendWeight::Channel { texture, channel, factor: factor.r() }
            }
            // With a channel, nothing else comes of it.
            other => BlendWeight::Texture { texture: other.texture().unwrap_or_default() },
        };
        Ok(match keys.cutoff {
            Some(cutoff) => BlendWeight::Threshold { tau: cutoff.0, of: Box::new(weight) },
            None => weight,
        })
    }
}
