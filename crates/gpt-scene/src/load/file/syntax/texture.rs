//! `[[texture]]`

use std::num::NonZeroU32;

use schemars::JsonSchema;
use serde::Deserialize;

use crate::load::file::colour::Rgb;
use crate::load::file::reference::{FileOr, TextureName};
use crate::load::file::value::{Any, Checked, Exactly, Located, Number, Positive};
use crate::load::image_file::EmbeddedFile;

/// A colour that varies over a surface.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(rename = "key:type", rename_all = "snake_case")]
#[schemars(tag = "type", rename = "TextureEntry")]
pub enum TextureEntry {
    Image(ImageEntry),
    Checker(CheckerEntry),
    Perlin(PerlinEntry),
    Worley(WorleyEntry),
}

/// Keys that all textures have, as one of them states them.
#[derive(Debug, Clone, Copy)]
pub struct CommonKeys<'e> {
    pub name: &'e Located<String>,
    /// Degrees.
    pub rotation: Option<Number>,
    pub offset: Option<Exactly<Number, 2>>,
    pub second_uvs: Option<bool>,
    pub bends_by_first_uvs: Option<bool>,
    /// The texture by which it is multiplied.
    pub times: Option<&'e Located<TextureName>>,
}

/// Mutable references to the common keys.
pub struct CommonKeysMut<'e> {
    pub name: &'e mut Located<String>,
    pub rotation: &'e mut Option<Number>,
    pub offset: &'e mut Option<Exactly<Number, 2>>,
    pub times: &'e mut Option<Located<TextureName>>,
}

/// Kinds of textures by the keys of their own, to which it adds those that all have.
macro_rules! texture_entries {
    ($($(#[$about:meta])* $entry:ident { $($(#[$key_about:meta])* $key:ident: $type:ty,)* })*) => {$(
        $(#[$about])*
        #[derive(Debug, Clone, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields, expecting = "a table")]
        pub struct $entry {
            #[schemars(extend("minLength" = 1))]
            pub name: Located<String>,
            $($(#[$key_about])* pub $key: $type,)*
            /// Degrees by which (u, v) is turned about (0, 0) after scaling, from u towards v; 0 when left out.
            pub rotation: Option<Number>,
            /// Added last to (u, v) as it is scaled and turned, [0, 0] when left out.
            pub offset: Option<Exactly<Number, 2>>,
            /// Look the texture up by `second_uvs` of meshes; shapes without them have only one set of
            /// texture coordinates.
            pub second_uvs: Option<bool>,
            /// A normal map with `second_uvs` and this key has red and green along the directions in which `uvs` grow.
            pub bends_by_first_uvs: Option<bool>,
            /// The name of another texture by which it is multiplied, channel by channel, and which has no `times` itself. Not for normal and bump maps.
            pub times: Option<Located<TextureName>>,
        }

        impl $entry {
            fn common_mut(&mut self) -> CommonKeysMut<'_> {
                let Self { name, rotation, offset, times, .. } = self;
                CommonKeysMut { name, rotation, offset, times }
            }

            fn common(&self) -> CommonKeys<'_> {
                let Self { name, rotation, offset, second_uvs, bends_by_first_uvs, times, .. } = self;
                let (second_uvs, bends_by_first_uvs) = (*second_uvs, *bends_by_first_uvs);
                CommonKeys { name, rotation: *rotation, offset: *offset, second_uvs, bends_by_first_uvs, times: times.as_ref() }
            }
        }
    )*};
}

texture_entries! {
    /// A picture file, looked up by uv.
    ImageEntry {
        /// Path relative to the scene file.
        file: Located<FileOr<EmbeddedFile>>,
        /// "srgb" for integer formats, "linear" for floating-point ones when left out.
        color_space: Option<ColorSpaceEntry>,
        /// The way the texture goes on beyond the picture; "repeat" when left out.
        wrap: Option<WrapEntry>,
        /// The way it goes on above and below the picture, along v; `wrap` when left out.
        wrap_v: Option<WrapEntry>,
        /// "bilinear" when left out.
        filter: Option<TextureFilterEntry>,
        /// Factors of u and v, [1, 1] when left out.
        scale: Option<Exactly<Number, 2>>,
        /// The colour that stands in the picture's place where the file cannot be read, with a warning. Without it, and with --strict, the scene is refused.
        fallback: Option<Rgb<Any>>,
    }

    /// Two colours in squares.
    CheckerEntry {
        a: Rgb<Any>,
        b: Rgb<Any>,
        /// Squares per unit of u and v, [1, 1] when left out.
        scale: Option<Exactly<Number, 2>>,
    }

    /// Improved Perlin noise between two colours.
    PerlinEntry {
        /// Factor of u and v, 1 when left out.
        scale: Option<Checked<Positive>>,
        /// 1 when left out, at most 16.
        #[schemars(extend("maximum" = 16))]
        octaves: Option<Located<NonZeroU32>>,
        a: Rgb<Any>,
        b: Rgb<Any>,
        seed: Option<u32>,
    }

    /// Distance to the nearest feature point, between two colours.
    WorleyEntry {
        /// Factor of u and v, 1 when left out.
        scale: Option<Checked<Positive>>,
        a: Rgb<Any>,
        b: Rgb<Any>,
        seed: Option<u32>,
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ColorSpaceEntry {
    Srgb,
    Linear,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
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

impl ImageEntry {
    /// The picture of a file as it is.
    pub fn of_file(name: Located<String>, file: Located<FileOr<EmbeddedFile>>) -> Self {
        Self {
            name,
            file,
            color_space: None,
            wrap: None,
            wrap_v: None,
            filter: None,
            scale: None,
            fallback: None,
            rotation: None,
            offset: None,
            second_uvs: None,
            bends_by_first_uvs: None,
            times: None,
        }
    }
}

impl TextureEntry {
    pub fn name(&self) -> &str {
        &self.common().name.value
    }

    /// Factors of u and v, of textures that have two.
    pub fn scale_mut(&mut self) -> Option<&mut Option<Exactly<Number, 2>>> {
        match self {
            Self::Image(entry) => Some(&mut entry.scale),
            Self::Checker(entry) => Some(&mut entry.scale),
            Self::Perlin(_) | Self::Worley(_) => None,
        }
    }

    pub fn common_mut(&mut self) -> CommonKeysMut<'_> {
        match self {
            Self::Image(entry) => entry.common_mut(),
            Self::Checker(entry) => entry.common_mut(),
            Self::Perlin(entry) => entry.common_mut(),
            Self::Worley(entry) => entry.common_mut(),
        }
    }

    /// The keys that textures of all kinds have.
    pub fn common(&self) -> CommonKeys<'_> {
        match self {
            Self::Image(entry) => entry.common(),
            Self::Checker(entry) => entry.common(),
            Self::Perlin(entry) => entry.common(),
            Self::Worley(entry) => entry.common(),
        }
    }
}
