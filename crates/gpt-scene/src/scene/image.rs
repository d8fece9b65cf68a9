//! Images, their texels kept as they came from the file, and what those mean.

use std::sync::LazyLock;

use glam::Vec3;

use crate::math::{half_to_f32, srgb_to_linear};
use crate::spectrum::Spectrum;

/// An image as it is looked up. Its colours are linear Rec.709.
#[derive(Debug, Clone)]
pub struct ImageData {
    pub width: u32,
    pub height: u32,
    /// Row by row from the top, `width * height` of them.
    pub texels: Texels,
    /// The file had an alpha channel that is not 1 everywhere.
    pub has_alpha: bool,
}

/// How the colours of an image are coded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ColorSpace {
    Srgb,
    Linear,
}

/// A channel of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Channel {
    R,
    G,
    B,
    A,
}

impl Channel {
    /// In the order in which a texel has them.
    pub const ALL: [Self; 4] = [Self::R, Self::G, Self::B, Self::A];

    /// This one of four values.
    pub fn of<T: Copy>(self, texel: [T; 4]) -> T {
        texel[self as usize]
    }

    /// This channel of an opaque colour.
    pub fn of_color(self, color: Spectrum) -> f64 {
        self.of([color.r(), color.g(), color.b(), 1.0])
    }
}

/// The texels of an image, in the least memory that holds what the file said. Alpha is never coded in sRGB.
#[derive(Debug, Clone)]
pub enum Texels {
    /// Integers of eight bits for red, green, blue and alpha; the space is that of the colours.
    Bytes { codes: Vec<[u8; 4]>, space: ColorSpace },
    /// Texels of sixteen bits.
    Shorts { codes: Vec<[u16; 4]>, space: ColorSpace },
    /// Half-precision numbers: red, green, blue and alpha.
    Half(Vec<[u16; 4]>),
    /// Red, green and blue; alpha is 1.
    Float(Vec<[f32; 3]>),
    /// Red, green, blue and alpha.
    FloatAlpha(Vec<[f32; 4]>),
}

/// The meaning of the integers from 0 to the largest of so many bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Code {
    Srgb8,
    Linear8,
    Srgb16,
    Linear16,
}

impl Code {
    fn new(space: ColorSpace, bits: u32) -> Self {
        match (space, bits) {
            (ColorSpace::Srgb, 8) => Self::Srgb8,
            (ColorSpace::Linear, 8) => Self::Linear8,
            (ColorSpace::Srgb, _) => Self::Srgb16,
            (ColorSpace::Linear, _) => Self::Linear16,
        }
    }

    /// The linear value of every integer. Devices look values up here as well: no arithmetic of theirs gives the same bits everywhere.
    pub fn values(self) -> &'static [f32] {
        static SRGB_8: LazyLock<Vec<f32>> = LazyLock::new(|| values(u8::MAX.into(), srgb_to_linear));
        static LINEAR_8: LazyLock<Vec<f32>> = LazyLock::new(|| values(u8::MAX.into(), |value| value));
        static SRGB_16: LazyLock<Vec<f32>> = LazyLock::new(|| values(u16::MAX, srgb_to_linear));
        static LINEAR_16: LazyLock<Vec<f32>> = LazyLock::new(|| values(u16::MAX, |value| value));
        match self {
            Self::Srgb8 => &SRGB_8,
            Self::Linear8 => &LINEAR_8,
            Self::Srgb16 => &SRGB_16,
            Self::Linear16 => &LINEAR_16,
        }
    }
}

fn values(largest: u16, decode: impl Fn(f32) -> f32) -> Vec<f32> {
    (0..=largest).map(|code| decode(f32::from(code) / f32::from(largest))).collect()
}

impl From<Vec<Vec3>> for Texels {
    fn from(colors: Vec<Vec3>) -> Self {
        Self::Float(colors.into_iter().map(|color| color.to_array()).collect())
    }
}

impl Texels {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Bytes { codes, .. } => codes.len(),
            Self::Shorts { codes, .. } => codes.len(),
            Self::Half(numbers) => numbers.len(),
            Self::Float(colors) => colors.len(),
            Self::FloatAlpha(texels) => texels.len(),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// How its integers are coded, the colours or the alpha; None: it has floating-point numbers.
    pub fn code(&self, of_alpha: bool) -> Option<Code> {
        let in_space = |space: ColorSpace| if of_alpha { ColorSpace::Linear } else { space };
        match self {
            Self::Bytes { space, .. } => Some(Code::new(in_space(*space), 8)),
            Self::Shorts { space, .. } => Some(Code::new(in_space(*space), 16)),
            Self::Half(_) | Self::Float(_) | Self::FloatAlpha(_) => None,
        }
    }

    /// Red, green, blue and alpha of texel number `index`.
    pub fn get(&self, index: usize) -> [f32; 4] {
        match self {
            Self::Bytes { codes, space } => decode(codes[index].map(usize::from), *space, 8),
            Self::Shorts { codes, space } => decode(codes[index].map(usize::from), *space, 16),
            Self::Half(numbers) => numbers[index].map(half_to_f32),
            Self::Float(colors) => {
                let [red, green, blue] = colors[index];
                [red, green, blue, 1.0]
            }
            Self::FloatAlpha(texels) => texels[index],
        }
    }

    /// The colour of texel number `index`.
    pub fn color(&self, index: usize) -> Vec3 {
        let [red, green, blue, _] = self.get(index);
        Vec3::new(red, green, blue)
    }

    /// All colours, in order.
    pub fn colors(&self) -> impl Iterator<Item = Vec3> + '_ {
        (0..self.len()).map(|index| self.color(index))
    }

    /// All values of a channel, in order.
    pub fn channel(&self, channel: Channel) -> impl Iterator<Item = f32> + '_ {
        (0..self.len()).map(move |index| channel.of(self.get(index)))
    }

    /// 32-bit words of a texel.
    pub fn words(&self) -> usize {
        match self {
            Self::Bytes { .. } => 1,
            Self::Shorts { .. } | Self::Half(_) => 2,
            Self::Float(_) => 3,
            Self::FloatAlpha(_) => 4,
        }
    }

    /// The texels as bytes in memory.
    pub fn as_bytes(&self) -> &[u8] {
        match self {
            Self::Bytes { codes, .. } => bytemuck::cast_slice(codes),
            Self::Shorts { codes, .. } => bytemuck::cast_slice(codes),
            Self::Half(numbers) => bytemuck::cast_slice(numbers),
            Self::Float(colors) => bytemuck::cast_slice(colors),
            Self::FloatAlpha(texels) => bytemuck::cast_slice(texels),
        }
    }

    /// Texels of the same kind, but none of them.
    pub fn emptied(&self) -> Self {
        match self {
            Self::Bytes { space, .. } => Self::Bytes { codes: Vec::new(), space: *space },
            Self::Shorts { space, .. } => Self::Shorts { codes: Vec::new(), space: *space },
            Self::Half(_) => Self::Half(Vec::new()),
            Self::Float(_) => Self::Float(Vec::new()),
            Self::FloatAlpha(_) => Self::FloatAlpha(Vec::new()),
        }
    }
}

fn decode([red, green, blue, alpha]: [usize; 4], space: ColorSpace, bits: u32) -> [f32; 4] {
    let colors = Code::new(space, bits).values();
    [colors[red], colors[green], colors[blue], Code::new(ColorSpace::Linear, bits).values()[alpha]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_stand_for_what_they_say_and_alpha_is_linear() {
        let texels = Texels::Bytes { codes: vec![[0, 128, 255, 128]], space: ColorSpace::Srgb };
        let [red, green, blue, alpha] = texels.get(0);
        assert_eq!([red, blue, alpha], [0.0, 1.0, 128.0 / 255.0]);
        approx::assert_relative_eq!(green, 0.215_860_5, max_relative = 1e-6);
        let texels = Texels::Shorts { codes: vec![[1, 2, 65_535, 3]], space: ColorSpace::Linear };
        assert_eq!(texels.get(0), [1.0 / 65_535.0, 2.0 / 65_535.0, 1.0, 3.0 / 65_535.0]);
    }

    #[test]
    fn texels_take_the_words_that_they_say() {
        let all = [
            Texels::Bytes { codes: vec![[1; 4]; 5], space: ColorSpace::Srgb },
            Texels::Shorts { codes: vec![[1; 4]; 5], space: ColorSpace::Linear },
            Texels::Half(vec![[0x3c00; 4]; 5]),
            Texels::Float(vec![[1.0; 3]; 5]),
            Texels::FloatAlpha(vec![[1.0; 4]; 5]),
        ];
        for texels in all {
            assert_eq!(texels.as_bytes().len(), 4 * texels.words() * texels.len(), "{texels:?}");
            assert!(texels.emptied().is_empty() && texels.code(false).is_none() == texels.code(true).is_none());
        }
        assert_eq!(Texels::Half(vec![[0x3c00, 0x3800, 0, 0x0001]]).get(0), [1.0, 0.5, 0.0, 5.960_464_5e-8]);
    }
}
