//! `[[texture]]`

use std::num::NonZeroU32;

use schemars::JsonSchema;
use serde::Deserialize;

use crate::load::file::colour::Rgb;
use crate::load::file::value::{Any, Checked, Exactly, Located, Number, Positive};

/// A colour that varies over a surface.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "type")]
pub enum TextureEntry {
    Image(ImageEntry),
    Checker(CheckerEntry),
    Perlin(PerlinEntry),
    Worley(WorleyEntry),
}

/// A picture file, looked up by uv.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct ImageEntry {
    #[schemars(extend("minLength" = 1))]
    pub name: Located<String>,
    /// Path relative to the scene file.
    pub file: Located<String>,
    /// "srgb" for integer formats, "linear" for floating-point ones when left out.
    pub color_space: Option<ColorSpaceEntry>,
    /// "repeat" when left out.
    pub wrap: Option<WrapEntry>,
    /// "bilinear" when left out.
    pub filter: Option<TextureFilterEntry>,
    /// Factors of u and v, [1, 1] when left out.
    pub scale: Option<Exactly<Number, 2>>,
    /// Degrees by which (u, v) is turned about (0, 0) after scaling, from u towards v; 0 when left out.
    pub rotation: Option<Number>,
    /// Added to (u, v) last, [0, 0] when left out.
    pub offset: Option<Exactly<Number, 2>>,
    /// It lies by `second_uvs` of meshes; shapes without them are looked up by their only texture coordinates.
    pub second_uvs: Option<bool>,
    /// The name of another texture by which it is multiplied, channel by channel, and which has no `times` itself. Not for normal and bump maps.
    pub times: Option<Located<String>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ColorSpaceEntry {
    Srgb,
    Linear,
}

#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WrapEntry {
    Repeat,
    Clamp,
    Mirror,
}

#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TextureFilterEntry {
    Bilinear,
    Nearest,
    /// Each block of 2 × 2 texels holds the colours of a triangle's corners (upper left, upper right, lower left), which are interpolated as over
    /// the triangle: vertex colours.
    Triangle,
}

/// Two colours in squares.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct CheckerEntry {
    #[schemars(extend("minLength" = 1))]
    pub name: Located<String>,
    pub a: Rgb<Any>,
    pub b: Rgb<Any>,
    /// Squares per unit of u and v, [1, 1] when left out.
    pub scale: Option<Exactly<Number, 2>>,
    /// Degrees by which (u, v) is turned about (0, 0) after scaling, from u towards v; 0 when left out.
    pub rotation: Option<Number>,
    /// Added to (u, v) last, in squares; [0, 0] when left out.
    pub offset: Option<Exactly<Number, 2>>,
    /// It lies by `second_uvs` of meshes; shapes without them are looked up by their only texture coordinates.
    pub second_uvs: Option<bool>,
    /// The name of another texture by which it is multiplied, channel by channel, and which has no `times` itself. Not for normal and bump maps.
    pub times: Option<Located<String>>,
}

/// Improved Perlin noise between two colours.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct PerlinEntry {
    #[schemars(extend("minLength" = 1))]
    pub name: Located<String>,
    /// Factor of u and v, 1 when left out.
    pub scale: Option<Checked<Positive>>,
    /// 1 when left out, at most 16.
    #[schemars(extend("maximum" = 16))]
    pub octaves: Option<Located<NonZeroU32>>,
    pub a: Rgb<Any>,
    pub b: Rgb<Any>,
    pub seed: Option<u32>,
    /// Degrees by which (u, v) is turned about (0, 0) after scaling, from u towards v; 0 when left out.
    pub rotation: Option<Number>,
    /// Added to (u, v) last, [0, 0] when left out.
    pub offset: Option<Exactly<Number, 2>>,
    /// It lies by `second_uvs` of meshes; shapes without them are looked up by their only texture coordinates.
    pub second_uvs: Option<bool>,
    /// The name of another texture by which it is multiplied, channel by channel, and which has no `times` itself. Not for normal and bump maps.
    pub times: Option<Located<String>>,
}

/// Distance to the nearest feature point, between two colours.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct WorleyEntry {
    #[schemars(extend("minLength" = 1))]
    pub name: Located<String>,
    /// Factor of u and v, 1 when left out.
    pub scale: Option<Checked<Positive>>,
    pub a: Rgb<Any>,
    pub b: Rgb<Any>,
    pub seed: Option<u32>,
    /// Degrees by which (u, v) is turned about (0, 0) after scaling, from u towards v; 0 when left out.
    pub rotation: Option<Number>,
    /// Added to (u, v) last, [0, 0] when left out.
    pub offset: Option<Exactly<Number, 2>>,
    /// It lies by `second_uvs` of meshes; shapes without them are looked up by their only texture coordinates.
    pub second_uvs: Option<bool>,
    /// The name of another texture by which it is multiplied, channel by channel, and which has no `times` itself. Not for normal and bump maps.
    pub times: Option<Located<String>>,
}

impl TextureEntry {
    /// Rotation and offset.
    pub fn placement(&self) -> (Option<Number>, Option<Exactly<Number, 2>>) {
        match self {
            Self::Image(entry) => (entry.rotation, entry.offset),
            Self::Checker(entry) => (entry.rotation, entry.offset),
            Self::Perlin(entry) => (entry.rotation, entry.offset),
            Self::Worley(entry) => (entry.rotation, entry.offset),
        }
    }

    /// The texture by which it is multiplied.
    pub fn times(&self) -> Option<&Located<String>> {
        match self {
            Self::Image(entry) => entry.times.as_ref(),
            Self::Checker(entry) => entry.times.as_ref(),
            Self::Perlin(entry) => entry.times.as_ref(),
            Self::Worley(entry) => entry.times.as_ref(),
        }
    }

    /// It lies by the second texture coordinates.
    pub fn is_by_second_uvs(&self) -> bool {
        let written = match self {
            Self::Image(entry) => entry.second_uvs,
            Self::Checker(entry) => entry.second_uvs,
            Self::Perlin(entry) => entry.second_uvs,
            Self::Worley(entry) => entry.second_uvs,
        };
        written.unwrap_or(false)
    }

    pub fn name(&self) -> &Located<String> {
        match self {
            Self::Image(entry) => &entry.name,
            Self::Checker(entry) => &entry.name,
            Self::Perlin(entry) => &entry.name,
            Self::Worley(entry) => &entry.name,
        }
    }
}
