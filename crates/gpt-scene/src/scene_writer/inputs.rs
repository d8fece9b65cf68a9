//! Parameters of materials as what they are made of: a constant, or a function of a picture's texels.

use crate::scene::{Channel, ChannelInput, ColorInput, TextureId};
use crate::spectrum::Spectrum;

/// A number, or one that varies over the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scalar {
    Constant(f64),
    Map(ScalarMap),
}

/// A channel of a texture times a factor, and then perhaps squared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScalarMap {
    pub texture: TextureId,
    pub channel: Channel,
    pub factor: f64,
    pub is_squared: bool,
}

/// A colour, or one that varies over the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Colour {
    Constant(Spectrum),
    Map(ColourMap),
}

/// A texture, or one of its channels as a grey, times a factor, and then perhaps squared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColourMap {
    pub texture: TextureId,
    pub channel: Option<Channel>,
    pub factor: Spectrum,
    pub is_squared: bool,
}

impl Scalar {
    pub fn of(input: ColorInput) -> Self {
        let map = |texture, channel, factor: f64, is_squared| Self::Map(ScalarMap { texture, channel, factor, is_squared });
        match input {
            ColorInput::Constant(value) => Self::Constant(value.r()),
            ColorInput::Texture(texture) => map(texture, Channel::R, 1.0, false),
            ColorInput::ScaledTexture(texture, factor) => map(texture, Channel::R, factor.r(), false),
            ColorInput::SquaredTexture(texture) => map(texture, Channel::R, 1.0, true),
            ColorInput::Channel(ChannelInput { texture, channel, factor, is_squared }) => {
                map(texture, channel, factor.r(), is_squared)
            }
        }
    }

    /// The number, where it is the same everywhere.
    pub fn constant(self) -> Option<f64> {
        match self {
            Self::Constant(value) => Some(value),
            Self::Map(_) => None,
        }
    }

    pub fn is(self, number: f64) -> bool {
        self == Self::Constant(number)
    }
}

impl ScalarMap {
    /// The number that a texel stands for.
    pub fn of_texel(&self, texel: [f64; 4]) -> f64 {
        let value = self.channel.of(texel) * self.factor;
        if self.is_squared { value * value } else { value }
    }
}

impl Colour {
    pub fn of(input: ColorInput) -> Self {
        let map = |texture, channel, factor, is_squared| Self::Map(ColourMap { texture, channel, factor, is_squared });
        match input {
            ColorInput::Constant(value) => Self::Constant(value),
            ColorInput::Texture(texture) => map(texture, None, Spectrum::WHITE, false),
            ColorInput::ScaledTexture(texture, factor) => map(texture, None, factor, false),
            ColorInput::SquaredTexture(texture) => map(texture, None, Spectrum::WHITE, true),
            ColorInput::Channel(ChannelInput { texture, channel, factor, is_squared }) => {
                map(texture, Some(channel), factor, is_squared)
            }
        }
    }

    /// The colour, where it is the same everywhere.
    pub fn constant(self) -> Option<Spectrum> {
        match self {
            Self::Constant(value) => Some(value),
            Self::Map(_) => None,
        }
    }

    pub fn is(self, value: Spectrum) -> bool {
        self == Self::Constant(value)
    }

    #[must_use]
    pub fn times(self, by: f64) -> Self {
        match self {
            Self::Constant(value) => Self::Constant(value * by),
            Self::Map(map) if map.is_squared => Self::Map(ColourMap { factor: map.factor * by.max(0.0).sqrt(), ..map }),
            Self::Map(map) => Self::Map(ColourMap { factor: map.factor * by, ..map }),
        }
    }
}

impl ColourMap {
    /// The texture as it is, but for the factor.
    pub fn is_plain(&self) -> bool {
        self.channel.is_none() && !self.is_squared
    }

    /// The colour that a texel stands for.
    pub fn of_texel(&self, texel: [f64; 4]) -> Spectrum {
        let value = match self.channel {
            Some(channel) => Spectrum::grey(channel.of(texel)),
            None => Spectrum::new(texel[0], texel[1], texel[2]),
        };
        let value = value * self.factor;
        if self.is_squared { value * value } else { value }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_are_what_scenes_mean_by_them() {
        let texel = [0.5, 0.25, 0.1, 0.8];
        let scaled = ColorInput::ScaledTexture(3, Spectrum::new(0.5, 1.0, 2.0));
        let Colour::Map(map) = Colour::of(scaled) else { panic!("it varies") };
        assert_eq!(map.of_texel(texel), Spectrum::new(0.25, 0.25, 0.2));
        // A squared product is the square of the product.
        let Scalar::Map(map) = Scalar::of(scaled.squared()) else { panic!("it varies") };
        assert_eq!(map.of_texel(texel), 0.0625);
        let Colour::Map(half) = Colour::of(scaled.squared()).times(0.25) else { panic!("it varies") };
        assert_eq!(half.of_texel(texel).r(), 0.25 * 0.0625);
        let alpha = ChannelInput { texture: 0, channel: Channel::A, factor: Spectrum::grey(0.5), is_squared: false };
        let Scalar::Map(map) = Scalar::of(ColorInput::Channel(alpha)) else { panic!("it varies") };
        assert_eq!(map.of_texel(texel), 0.4);
        assert!(Scalar::of(ColorInput::grey(2.0)).is(2.0) && !Scalar::of(scaled).is(2.0));
    }
}
