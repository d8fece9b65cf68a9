//! `type = "mirror"`

use super::keys::{MaterialKeys, material_keys};
use crate::load::error::SceneError;
use crate::load::file::colour::Colour;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::Fraction;
use crate::load::file::writer::Writer;
use crate::scene::MaterialKind;

material_keys! {
    /// A perfect mirror.
    {
        /// 1 when left out.
        reflectance: Option<Colour<Fraction>>,
    }
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &["reflectance = 0.9"];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        Ok(MaterialKind::Mirror { reflectance: resolver.colour_or_white(&self.reflectance)? })
    }

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::Mirror { reflectance } = kind else { return String::new() };
        writer.input("reflectance", reflectance)
    }
}
