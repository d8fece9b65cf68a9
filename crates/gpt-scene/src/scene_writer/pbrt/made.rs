//! Materials that are written.

use super::directive::Number;
use crate::scene::TextureId;

/// The texture that bends a blend's normals.
pub type Relief = TextureId;

/// The name and the alpha that stand for a material.
#[derive(Debug, Clone)]
pub struct Made {
    /// The name of a material; None where light goes straight through.
    pub name: Option<String>,
    /// The share of the surface that is there, which shapes state.
    pub alpha: Number,
}

impl Made {
    pub fn opaque(name: String) -> Self {
        Self { name: Some(name), alpha: Number::Constant(1.0) }
    }

    pub fn nothing() -> Self {
        Self { name: None, alpha: Number::Constant(1.0) }
    }
}
