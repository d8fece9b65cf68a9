//! `type = "diffuse"`

use super::keys::{MaterialKeys, material_keys};
use crate::load::error::SceneError;
use crate::load::file::colour::Colour;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::Fraction;
use crate::scene::MaterialKind;

material_keys! {
    /// Lambert: f = ρ/π.
    {
        reflectance: Colour<Fraction>,
    }
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &["reflectance = [0.8, 0.4, 0.1]"];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        Ok(MaterialKind::Diffuse { reflectance: resolver.colour(&self.reflectance)? })
    }
}
