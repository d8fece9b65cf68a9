//! `type = "diffuse"`

use super::keys::{MaterialKeys, material_keys};
use crate::load::error::SceneError;
use crate::load::file::colour::Colour;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::Fraction;
use crate::load::file::writer::Writer;
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

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::Diffuse { reflectance } = kind else { return String::new() };
        writer.input("reflectance", reflectance)
    }
}
