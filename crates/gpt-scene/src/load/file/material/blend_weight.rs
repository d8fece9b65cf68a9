//! The weights of blends.

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::ior_or_default;
use crate::load::error::SceneError;
use crate::load::file::colour::ChannelName;
use crate::load::file::reference::{NamesTextures, TextureName};
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, Fraction, IndexOfRefraction, Located, NonNegative, Number, Positive, Vector};
use crate::load::file::writer::{Writer, channel_name, number, table, text, vector};
use crate::scene::material::rounded_axis;
use crate::scene::{BlendWeight, TextureId, TextureKind};

/// The weight of a blend's first material.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(rename = "key:type", rename_all = "snake_case")]
#[schemars(tag = "type", rename = "BlendWeightEntry")]
pub enum BlendWeightEntry {
    Constant(ConstantWeight),
    Facing(FacingWeight),
    Fresnel(FresnelWeight),
    Front(NoKeys),
    Camera(NoKeys),
    Up(UpWeight),
    Open(OpenWeight),
    Texture(TextureWeight),
    Reverse(ReverseWeight),
    Threshold(ThresholdWeight),
}

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct ConstantWeight {
    pub value: Checked<Fraction>,
}

/// w0 = clamp(|N·ωo|^power, 0, 1)
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct FacingWeight {
    /// 1 when left out.
    pub power: Option<Checked<NonNegative>>,
}

/// w0 = 1 − R
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct FresnelWeight {
    /// 1.5 when left out.
    pub ior: Option<Checked<IndexOfRefraction>>,
    /// The dielectric equations instead of Schlick's approximation.
    #[serde(default)]
    pub exact: bool,
}

/// w0 = max(0, N·axis)^power: how much the surface faces a direction of the scene, N its normal on the side that is seen
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct UpWeight {
    /// [0, 1, 0] when left out.
    pub axis: Option<Located<Vector>>,
    /// 1 when left out.
    pub power: Option<Checked<Positive>>,
}

/// w0 = o^power, o the share of directions over the surface in which nothing is nearer than `distance`; of meshes, at whose vertices it is computed
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table with the key `distance`")]
pub struct OpenWeight {
    /// In scene units.
    pub distance: Checked<Positive>,
    /// 1 when left out.
    pub power: Option<Checked<Positive>>,
}

/// "front": w0 = 1 where the front is seen, 0 from behind. "camera": w0 = 1 for rays of the camera that nothing has scattered, 0 for all others
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "PlainWeight")]
pub struct NoKeys {}

/// w0 = luminance of a texture, or one of its channels
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(extend("dependentRequired" = { "factor": ["channel"] }))]
pub struct TextureWeight {
    pub texture: Located<TextureName>,
    /// The channel that is the weight; the luminance when left out.
    pub channel: Option<ChannelName>,
    /// Multiplies the channel, 1 when left out.
    pub factor: Option<Located<Checked<Fraction>>>,
}

/// w0' = 1 − w0
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct ReverseWeight {
    pub of: Box<BlendWeightEntry>,
}

/// w0' = 1 where w0 >= tau, else 0
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct ThresholdWeight {
    pub tau: Number,
    pub of: Box<BlendWeightEntry>,
}

impl Default for BlendWeightEntry {
    fn default() -> Self {
        Self::Front(NoKeys {})
    }
}

impl NamesTextures for BlendWeightEntry {
    fn each_texture(&mut self, visit: &mut dyn FnMut(&mut String)) {
        match self {
            Self::Texture(keys) => keys.texture.each_texture(visit),
            Self::Reverse(ReverseWeight { of }) | Self::Threshold(ThresholdWeight { of, .. }) => of.each_texture(visit),
            Self::Constant(_)
            | Self::Facing(_)
            | Self::Fresnel(_)
            | Self::Front(_)
            | Self::Camera(_)
            | Self::Up(_)
            | Self::Open(_) => {}
        }
    }
}

impl BlendWeightEntry {
    /// A weight that is constant over the surface.
    ///
    /// # Errors
    /// A sentence about a number that is no share.
    pub fn constant(value: f64) -> Result<Self, String> {
        Ok(Self::Constant(ConstantWeight { value: Checked::of(value)? }))
    }

    /// A channel of a texture times a factor.
    ///
    /// # Errors
    /// A sentence about a factor that is no share.
    pub fn channel(texture: Located<TextureName>, channel: ChannelName, factor: f64) -> Result<Self, String> {
        let factor = if factor == 1.0 { None } else { Some(texture.place.at(Checked::of(factor)?)) };
        Ok(Self::Texture(TextureWeight { texture, channel: Some(channel), factor }))
    }
    pub fn resolve(&self, resolver: &Resolver<'_>) -> Result<BlendWeight, SceneError> {
        Ok(match self {
            Self::Constant(keys) => BlendWeight::Constant { value: keys.value.0 },
            Self::Facing(keys) => BlendWeight::Facing { power: keys.power.map_or(1.0, |power| power.0) },
            Self::Fresnel(keys) => BlendWeight::Fresnel { ior: ior_or_default(keys.ior), exact: keys.exact },
            Self::Front(NoKeys {}) => BlendWeight::Front,
            Self::Camera(NoKeys {}) => BlendWeight::Camera,
            Self::Up(keys) => BlendWeight::Up {
                axis: rounded_axis(keys.axis.as_ref().map_or(Ok(DVec3::Y), |axis| resolver.direction(axis))?),
                power: keys.power.map_or(1.0, |power| power.0),
            },
            Self::Open(keys) => BlendWeight::Open { distance: keys.distance.0, power: keys.power.map_or(1.0, |power| power.0) },
            Self::Texture(keys) => keys.resolve(resolver)?,
            Self::Reverse(keys) => BlendWeight::Reverse { of: Box::new(keys.of.resolve(resolver)?) },
            Self::Threshold(keys) => BlendWeight::Threshold { tau: keys.tau.0, of: Box::new(keys.of.resolve(resolver)?) },
        })
    }
}

impl TextureWeight {
    fn resolve(&self, resolver: &Resolver<'_>) -> Result<BlendWeight, SceneError> {
        let Some(channel) = self.channel else {
            if let Some(factor) = &self.factor {
                return Err(resolver.error(&factor.place, "`factor` needs the key `channel`"));
            }
            return Ok(BlendWeight::Texture { texture: weight_texture(&self.texture, resolver)? });
        };
        let texture = resolver.texture_id(&self.texture)?;
        Ok(BlendWeight::Channel {
            texture,
            channel: channel.into(),
            factor: self.factor.as_ref().map_or(1.0, |factor| factor.value.0),
        })
    }
}

/// A weight is the luminance of a texture's colours: an alpha channel beside them would have no effect.
fn weight_texture(name: &Located<TextureName>, resolver: &Resolver<'_>) -> Result<TextureId, SceneError> {
    let id = resolver.texture_id(name)?;
    if let TextureKind::Image(image) = &resolver.scene.textures[id].kind
        && image.image.has_alpha
    {
        let message = format!("the weight is the luminance of `{}`, whose alpha channel would have no effect", name.value.0);
        return Err(resolver
            .error(&name.place, message)
            .with_help("take a channel, `channel = \"a\"` for the alpha, or save the image without alpha, as the mask itself"));
    }
    Ok(id)
}

/// The weight as a scene file has it.
pub fn write(weight: &BlendWeight, writer: &Writer<'_>) -> String {
    let (type_name, keys) = match weight {
        BlendWeight::Constant { value } => ("constant", vec![("value", number(*value))]),
        BlendWeight::Facing { power } => ("facing", vec![("power", number(*power))]),
        BlendWeight::Fresnel { ior, exact } => ("fresnel", vec![("ior", number(*ior)), ("exact", exact.to_string())]),
        BlendWeight::Front => ("front", Vec::new()),
        BlendWeight::Camera => ("camera", Vec::new()),
        BlendWeight::Up { axis, power } => ("up", vec![("axis", vector(*axis)), ("power", number(*power))]),
        BlendWeight::Open { distance, power } => ("open", vec![("distance", number(*distance)), ("power", number(*power))]),
        BlendWeight::Texture { texture } => ("texture", vec![("texture", writer.textures.quoted(*texture))]),
        BlendWeight::Channel { texture, channel, factor } => {
            let name = ("texture", writer.textures.quoted(*texture));
            ("texture", vec![name, ("channel", text(channel_name(*channel))), ("factor", number(*factor))])
        }
        BlendWeight::Reverse { of } => ("reverse", vec![("of", write(of, writer))]),
        BlendWeight::Threshold { tau, of } => ("threshold", vec![("tau", number(*tau)), ("of", write(of, writer))]),
    };
    table(std::iter::once(("type", text(type_name))).chain(keys))
}
