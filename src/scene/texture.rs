//! Colours that vary over a surface, and the images they are read from.

use std::sync::Arc;

use glam::{DVec3, Vec3};

/// Index into [`crate::scene::Scene::textures`].
pub type TextureId = usize;

/// A parameter that is one colour or comes from a texture. Scalars are grey colours; their first channel counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ColorInput {
    Constant(DVec3),
    Texture(TextureId),
    /// A texture times a constant (MTL's `Kd` with `map_Kd`).
    ScaledTexture(TextureId, DVec3),
    /// The square of a texture: GGX's width from a roughness.
    SquaredTexture(TextureId),
}

impl ColorInput {
    pub fn grey(value: f64) -> Self {
        Self::Constant(DVec3::splat(value))
    }

    /// The value varies over the surface.
    pub fn is_texture(&self) -> bool {
        !matches!(self, Self::Constant(_))
    }
}

#[derive(Debug, Clone)]
pub struct Texture {
    pub name: String,
    pub kind: TextureKind,
}

#[derive(Debug, Clone)]
pub enum TextureKind {
    Image(ImageTexture),
    /// Alternates `a` and `b`: a where floor(u·scale.x) + floor(v·scale.y) is even.
    Checker {
        a: DVec3,
        b: DVec3,
        scale: [f64; 2],
    },
    /// Improved Perlin noise in uv, summed over octaves, mapped from [-1, 1] to a..b.
    Perlin {
        scale: f64,
        octaves: u32,
        a: DVec3,
        b: DVec3,
        seed: u32,
    },
    /// Distance to the nearest feature point in uv, clamped to [0, 1], mapped to a..b.
    Worley {
        scale: f64,
        a: DVec3,
        b: DVec3,
        seed: u32,
    },
}

impl TextureKind {
    /// The smallest and the largest value of any channel.
    pub fn range(&self) -> (f64, f64) {
        let ends = |colours: &mut dyn Iterator<Item = DVec3>| {
            colours.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), colour| {
                (low.min(colour.min_element()), high.max(colour.max_element()))
            })
        };
        match self {
            Self::Image(image) => ends(&mut image.image.texels.iter().map(|texel| texel.as_dvec3())),
            Self::Checker { a, b, .. } | Self::Perlin { a, b, .. } | Self::Worley { a, b, .. } => ends(&mut [*a, *b].into_iter()),
        }
    }
}

/// An image looked up by uv. v = 0 is the bottom row, as in OBJ.
#[derive(Debug, Clone)]
pub struct ImageTexture {
    pub image: Arc<ImageData>,
    pub wrap: TextureWrap,
    pub filter: TextureFilter,
    /// uv is multiplied by `scale`, then `offset` is added, before wrapping.
    pub scale: [f64; 2],
    pub offset: [f64; 2],
}

/// Decoded texels, linear Rec.709.
#[derive(Debug, Clone)]
pub struct ImageData {
    pub width: u32,
    pub height: u32,
    /// Row by row from the top, `width * height` texels.
    pub texels: Vec<Vec3>,
    /// The file had an alpha channel that is not 1 everywhere.
    pub has_alpha: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ColorSpace {
    Srgb,
    Linear,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextureWrap {
    Repeat,
    Clamp,
    Mirror,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextureFilter {
    Bilinear,
    Nearest,
}
