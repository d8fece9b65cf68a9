//! Parameters of surfaces and lights.

use glam::DVec3;

use crate::load::file::colour::{Colour, Scalar};
use crate::load::file::reference::TextureName;
use crate::load::file::value::Rule;
use crate::load::place::Place;

/// A parameter: a constant or the name of a texture.
#[derive(Debug, Clone, PartialEq)]
pub enum Input {
    Constant(DVec3),
    /// Its name, and what multiplies it.
    Texture(String, DVec3),
}

impl Input {
    pub fn grey(value: f64) -> Self {
        Self::Constant(DVec3::splat(value))
    }

    pub fn constant(&self) -> Option<DVec3> {
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

    /// The parameter as a number of an entry.
    ///
    /// # Errors
    /// A sentence about a colour, and about a number that `R` does not accept.
    pub fn scalar<R: Rule>(&self, place: &Place) -> Result<Scalar<R>, String> {
        let number = |colour: DVec3| match colour.min_element() == colour.max_element() {
            true => Ok(colour.x),
            false => Err("a colour is not possible here, expected one number".to_owned()),
        };
        match self {
            Self::Constant(colour) => Scalar::constant(number(*colour)?),
            Self::Texture(name, factor) => Scalar::of_texture(place.at(TextureName(name.clone())), None, number(*factor)?),
        }
    }
}
