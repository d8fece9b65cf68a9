//! Parameters of plugins: constants or textures.

use glam::DVec3;

use crate::load::import::{Keys, Value, list};

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

    /// As scene files write it: a number for grey.
    pub fn value(&self) -> Value {
        match self {
            Self::Constant(colour) if colour.min_element() == colour.max_element() => Value::Number(colour.x),
            Self::Constant(colour) => list(colour.to_array()),
            Self::Texture(name, factor) => {
                let keys = Keys::new().with("texture", name.as_str());
                let factor = (*factor != DVec3::ONE).then(|| Self::Constant(*factor).value());
                Value::Table(keys.with_some("factor", factor))
            }
        }
    }
}

/// The use of a picture's texels. Files of integers hold all of them in sRGB unless they are `raw`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Texels {
    Colours,
    /// Their luminance.
    Numbers,
    /// Their luminance, of which slopes are taken.
    Heights,
    /// Directions.
    Normals,
}
