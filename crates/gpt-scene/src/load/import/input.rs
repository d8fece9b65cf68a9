//! Parameters of surfaces and lights.

use crate::load::file::colour::{ChannelName, Colour, Scalar};
use crate::load::file::material::blend_weight::BlendWeightEntry;
use crate::load::file::reference::TextureName;
use crate::load::file::value::Rule;
use crate::load::place::Place;
use crate::spectrum::Spectrum;

/// A parameter: a constant or the name of a texture.
#[derive(Debug, Clone, PartialEq)]
pub enum Input {
    Constant(Spectrum),
    /// Its name, and what multiplies it.
    Texture(String, Spectrum),
}

impl Input {
    pub fn grey(value: f64) -> Self {
        Self::Constant(Spectrum::grey(value))
    }

    pub fn constant(&self) -> Option<Spectrum> {
        match self {
            Self::Constant(colour) => Some(*colour),
            Self::Texture(..) => None,
        }
    }

    /// The parameter as a colour of an entry.
    ///
    /// # Errors
    /// A sentence about a number that `R` does not accept.
    pub fn colour<R: Rule>(&self, place: &Place) -> Result<Colour<R>, String> {
        match self {
            Self::Constant(colour) => Colour::constant(*colour),
            Self::Texture(name, factor) => Colour::of_texture(place.at(TextureName(name.clone())), *factor),
        }
    }

    /// The parameter as the weight of a blend, within 0 and 1: the first channel of a texture counts.
    ///
    /// # Errors
    /// A sentence about a number that is no share.
    pub fn weight(&self, place: &Place) -> Result<BlendWeightEntry, String> {
        match self {
            Self::Constant(share) => BlendWeightEntry::constant(share.r().clamp(0.0, 1.0)),
            Self::Texture(name, factor) => {
                let factor = if factor.r() == 1.0 { 1.0 } else { factor.r().clamp(0.0, 1.0) };
                BlendWeightEntry::channel(place.at(TextureName(name.clone())), ChannelName::R, factor)
            }
        }
    }

    /// The parameter as a number of an entry.
    ///
    /// # Errors
    /// A sentence about a colour, and about a number that `R` does not accept.
    pub fn scalar<R: Rule>(&self, place: &Place) -> Result<Scalar<R>, String> {
        let number = |colour: Spectrum| match colour.min_component() == colour.max_component() {
            true => Ok(colour.r()),
            false => Err("a colour is not possible here, expected one number".to_owned()),
        };
        match self {
            Self::Constant(colour) => Scalar::constant(number(*colour)?),
            Self::Texture(name, factor) => Scalar::of_texture(place.at(TextureName(name.clone())), None, number(*factor)?),
        }
    }
}
