//! Colours that vary over a surface, and the images they are read from.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DMat2, DVec2};

use super::image::{Channel, ImageData};
use crate::spectrum::Spectrum;

/// Index into [`crate::scene::Scene::textures`].
pub type TextureId = usize;

/// A parameter that is one colour or comes from a texture. Scalars are grey colours; their first channel counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ColorInput {
    Constant(Spectrum),
    Texture(TextureId),
    /// A texture times a constant (MTL's `Kd` with `map_Kd`).
    ScaledTexture(TextureId, Spectrum),
    /// The square of a texture: GGX's width from a roughness.
    SquaredTexture(TextureId),
    /// One channel of a texture as a grey.
    Channel(ChannelInput),
}

/// One channel of a texture times a factor, and then perhaps squared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelInput {
    pub texture: TextureId,
    pub channel: Channel,
    pub factor: Spectrum,
    /// GGX's width from a roughness.
    pub is_squared: bool,
}

impl From<f64> for ColorInput {
    /// One number in place of a texture.
    fn from(number: f64) -> Self {
        Self::grey(number)
    }
}

impl ColorInput {
    pub fn grey(value: f64) -> Self {
        Self::Constant(Spectrum::grey(value))
    }

    /// The value varies over the surface.
    pub fn is_texture(&self) -> bool {
        self.texture().is_some()
    }

    /// The texture that it is looked up in.
    pub fn texture(&self) -> Option<TextureId> {
        match *self {
            Self::Constant(_) => None,
            Self::Texture(id) | Self::ScaledTexture(id, _) | Self::SquaredTexture(id) => Some(id),
            Self::Channel(ChannelInput { texture, .. }) => Some(texture),
        }
    }

    /// True if the looked-up value, times its factor, is squared.
    pub fn is_squared(&self) -> bool {
        matches!(self, Self::SquaredTexture(_) | Self::Channel(ChannelInput { is_squared: true, .. }))
    }

    /// The input times a factor; a squared input becomes the square of the product.
    #[must_use]
    pub fn scaled(self, by: Spectrum) -> Self {
        let channel = |texture| ChannelInput { texture, channel: Channel::R, factor: by, is_squared: true };
        match self {
            Self::Constant(color) => Self::Constant(color * by),
            Self::Texture(texture) => Self::ScaledTexture(texture, by),
            Self::ScaledTexture(texture, factor) => Self::ScaledTexture(texture, factor * by),
            Self::SquaredTexture(texture) => Self::Channel(channel(texture)),
            Self::Channel(input) => Self::Channel(ChannelInput { factor: input.factor * by, ..input }),
        }
    }

    /// The square, of which the first channel counts.
    #[must_use]
    pub fn squared(self) -> Self {
        let channel = |texture, factor| ChannelInput { texture, channel: Channel::R, factor, is_squared: true };
        match self {
            Self::Constant(value) => Self::Constant(value * value),
            Self::Texture(texture) | Self::SquaredTexture(texture) => Self::SquaredTexture(texture),
            Self::ScaledTexture(texture, factor) => Self::Channel(channel(texture, factor)),
            Self::Channel(input) => Self::Channel(ChannelInput { is_squared: true, ..input }),
        }
    }
}

#[derive(Debug, Clone)]
pub struct Texture {
    pub name: String,
    pub kind: TextureKind,
    pub transform: UvTransform,
    /// True if the texture uses the second texture coordinates of meshes that have two.
    pub by_second_uvs: bool,
    /// A normal map that lies by the second ones bends along the directions in which the first grow.
    pub bends_by_first_uvs: bool,
    /// Another texture by which it is multiplied, channel by channel; that one is multiplied by none.
    pub times: Option<TextureId>,
    pub relief: Relief,
    /// Light that reaches the normals that it bends fades where the surface itself would hide it (Estevez, Lecocq and Stein 2019, "A
    /// microfacet-based shadowing function to solve the bump terminator problem").
    pub shadows_perturbed_normals: bool,
    /// A normal that it bends away from the viewer is mirrored about the one before; else the surface's own takes its place. Of maps that shadow.
    pub mirrors_perturbed_normals: bool,
}

/// How a texture bends the normals of materials that have it for their normal map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Relief {
    /// Directions, whose red and green are multiplied by this.
    Normals(f64),
    /// Heights along the normal, in units of this length.
    Heights(f64),
}

impl Default for Relief {
    fn default() -> Self {
        Self::Normals(1.0)
    }
}

impl Texture {
    /// One that lies as the surface's texture coordinates do.
    pub fn new(name: impl Into<String>, kind: TextureKind) -> Self {
        Self {
            name: name.into(),
            kind,
            transform: UvTransform::default(),
            by_second_uvs: false,
            bends_by_first_uvs: false,
            times: None,
            relief: Relief::default(),
            shadows_perturbed_normals: false,
            mirrors_perturbed_normals: false,
        }
    }

    /// A normal map that is this texture bends normals as it is.
    pub fn bends_plainly(&self) -> bool {
        self.relief == Relief::default() && !self.shadows_perturbed_normals
    }

    /// The place in the texture for texture coordinates that its kind has scaled.
    pub fn placed(&self, scaled: DVec2) -> DVec2 {
        self.transform.rotation() * scaled + DVec2::from(self.transform.offset)
    }
}

/// The mean colour over the whole texture: of a product, the product of the means.
pub fn mean_of_texture(textures: &[Texture], id: TextureId) -> Spectrum {
    let by = textures[id].times.map_or(Spectrum::WHITE, |other| textures[other].kind.mean());
    textures[id].kind.mean() * by
}

/// The mean of one channel, likewise.
pub fn mean_of_channel(textures: &[Texture], id: TextureId, channel: Channel) -> f64 {
    let by = textures[id].times.map_or(1.0, |other| textures[other].kind.mean_of(channel));
    textures[id].kind.mean_of(channel) * by
}

/// Ranges of pictures that were looked through: many textures may show one.
#[derive(Debug, Default)]
pub struct KnownRanges(HashMap<(*const ImageData, Option<Channel>), (f64, f64)>);

/// The smallest and the largest value of a texture's channels, or of one of them: of a product, bounds. `known`: of pictures of these textures.
pub fn range_of_texture(textures: &[Texture], id: TextureId, channel: Option<Channel>, known: &mut KnownRanges) -> (f64, f64) {
    let mut range = |id: TextureId| {
        let kind = &textures[id].kind;
        let look = || channel.map_or_else(|| kind.range(), |channel| kind.range_of(channel));
        match kind {
            TextureKind::Image(texture) => *known.0.entry((Arc::as_ptr(&texture.image), channel)).or_insert_with(look),
            _ => look(),
        }
    };
    let own = range(id);
    let Some((low, high)) = textures[id].times.map(&mut range) else { return own };
    let ends = [own.0 * low, own.0 * high, own.1 * low, own.1 * high];
    (ends.into_iter().fold(f64::INFINITY, f64::min), ends.into_iter().fold(f64::NEG_INFINITY, f64::max))
}

/// How texture coordinates are changed before a texture is looked up, after the factors of its kind.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct UvTransform {
    /// From u towards v, about (0, 0).
    pub rotation_degrees: f64,
    /// Added last.
    pub offset: [f64; 2],
}

impl UvTransform {
    /// The rotation alone.
    pub fn rotation(&self) -> DMat2 {
        if self.rotation_degrees == 0.0 { DMat2::IDENTITY } else { DMat2::from_angle(self.rotation_degrees.to_radians()) }
    }
}

#[derive(Debug, Clone)]
pub enum TextureKind {
    Image(ImageTexture),
    /// Alternates `a` and `b`: a where floor(u·scale.x) + floor(v·scale.y) is even.
    Checker {
        a: Spectrum,
        b: Spectrum,
        scale: [f64; 2],
    },
    /// Improved Perlin noise in uv, summed over octaves, mapped from [-1, 1] to a..b.
    Perlin {
        scale: f64,
        octaves: u32,
        a: Spectrum,
        b: Spectrum,
        seed: u32,
    },
    /// Distance to the nearest feature point in uv, clamped to [0, 1], mapped to a..b.
    Worley {
        scale: f64,
        a: Spectrum,
        b: Spectrum,
        seed: u32,
    },
}

impl TextureKind {
    /// The smallest and the largest value of any channel.
    pub fn range(&self) -> (f64, f64) {
        let ends = |colours: &mut dyn Iterator<Item = Spectrum>| {
            colours.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), colour| {
                (low.min(colour.min_component()), high.max(colour.max_component()))
            })
        };
        match self {
            Self::Image(image) => ends(&mut image.image.texels.colors().map(|texel| Spectrum::from_f32(texel.to_array()))),
            Self::Checker { a, b, .. } | Self::Perlin { a, b, .. } | Self::Worley { a, b, .. } => ends(&mut [*a, *b].into_iter()),
        }
    }

    /// The smallest and the largest value of one channel.
    pub fn range_of(&self, channel: Channel) -> (f64, f64) {
        let ends = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
        };
        match self {
            Self::Image(image) => ends(&mut image.image.texels.channel(channel).map(f64::from)),
            Self::Checker { a, b, .. } | Self::Perlin { a, b, .. } | Self::Worley { a, b, .. } => {
                ends(&mut [*a, *b].into_iter().map(|color| channel.of_color(color)))
            }
        }
    }

    /// The mean colour over the whole texture; of noise, the middle between its two colours.
    pub fn mean(&self) -> Spectrum {
        match self {
            Self::Image(image) => image.mean(),
            Self::Checker { a, b, .. } | Self::Perlin { a, b, .. } | Self::Worley { a, b, .. } => 0.5 * (*a + *b),
        }
    }

    /// The mean of one channel, likewise.
    pub fn mean_of(&self, channel: Channel) -> f64 {
        match self {
            Self::Image(image) => {
                let texels = &image.image.texels;
                texels.channel(channel).map(f64::from).sum::<f64>() / texels.len().max(1) as f64
            }
            Self::Checker { .. } | Self::Perlin { .. } | Self::Worley { .. } => channel.of_color(self.mean()),
        }
    }
}

/// An image looked up by uv. v = 0 is the bottom row, as in OBJ.
#[derive(Debug, Clone)]
pub struct ImageTexture {
    pub image: Arc<ImageData>,
    /// Along u and along v.
    pub wrap: [TextureWrap; 2],
    pub filter: TextureFilter,
    /// Factors of u and v.
    pub scale: [f64; 2],
}

impl ImageTexture {
    /// The mean over all texels.
    pub fn mean(&self) -> Spectrum {
        let texels = &self.image.texels;
        texels.colors().map(|texel| Spectrum::from_f32(texel.to_array())).sum::<Spectrum>() / texels.len().max(1) as f64
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextureWrap {
    Repeat,
    Clamp,
    Mirror,
}

impl TextureWrap {
    /// A place of 0..size for every index.
    pub fn index(self, index: i64, size: usize) -> usize {
        let size = size as i64;
        let inside = match self {
            Self::Repeat => index.rem_euclid(size),
            Self::Clamp => index.clamp(0, size - 1),
            Self::Mirror => {
                let period = index.rem_euclid(2 * size);
                period.min(2 * size - 1 - period)
            }
        };
        inside as usize
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextureFilter {
    Bilinear,
    Nearest,
    /// The plane through the upper left, upper right and lower left texels of each block of 2 × 2: colours of a triangle's corners.
    Triangle,
}
