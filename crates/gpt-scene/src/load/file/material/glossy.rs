//! `type = "glossy"`

use super::keys::{MaterialKeys, material_keys};
use crate::load::error::SceneError;
use crate::load::file::colour::{Colour, Scalar};
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Fraction, NonNegative};
use crate::load::file::writer::Writer;
use crate::scene::MaterialKind;

material_keys! {
    /// A cosine-power lobe about the mirror direction: f = ρ (n+2)/(2π) cosⁿα.
    {
        reflectance: Colour<Fraction>,
        exponent: Scalar<NonNegative>,
    }
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &["reflectance = [0.9, 0.7, 0.5]\nexponent = 40"];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        let (reflectance, exponent) = (resolver.colour(&self.reflectance)?, resolver.scalar(&self.exponent)?);
        Ok(MaterialKind::Glossy { reflectance, exponent })
    }

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::Glossy { reflectance, exponent } = kind else { return String::new() };
        writer.input("reflectance", reflectance) + &writer.input("exponent", exponent)
    }
}
