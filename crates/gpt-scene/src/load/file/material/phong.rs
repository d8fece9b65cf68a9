//! `type = "phong"`

use super::keys::{MaterialKeys, material_keys};
use crate::load::error::SceneError;
use crate::load::file::colour::{Colour, Scalar};
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Fraction, Located, NonNegative};
use crate::load::file::writer::Writer;
use crate::scene::MaterialKind;

material_keys! {
    /// Modified Phong (Lafortune and Willems 1994).
    {
        diffuse: Colour<Fraction>,
        specular: Located<Colour<Fraction>>,
        exponent: Scalar<NonNegative>,
    }
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &["diffuse = [0.4, 0.2, 0.1]\nspecular = 0.5\nexponent = 25"];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        self.check_sum(resolver)?;
        Ok(MaterialKind::Phong {
            diffuse: resolver.colour(&self.diffuse)?,
            specular: resolver.colour(&self.specular.value)?,
            exponent: resolver.scalar(&self.exponent)?,
        })
    }

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::Phong { diffuse, specular, exponent } = kind else { return String::new() };
        writer.input("diffuse", diffuse) + &writer.input("specular", specular) + &writer.input("exponent", exponent)
    }
}

impl Keys {
    /// Diffuse plus specular above 1 would make energy.
    fn check_sum(&self, resolver: &Resolver<'_>) -> Result<(), SceneError> {
        if let (Colour::Constant(diffuse), Colour::Constant(specular)) = (&self.diffuse, &self.specular.value) {
            let sum = diffuse.0 + specular.0;
            if sum.max_component() > 1.0 + 1e-9 {
                let message = format!("diffuse + specular is at most 1 per channel, found {}", sum.max_component());
                return Err(resolver.error(&self.specular.place, message));
            }
        }
        Ok(())
    }
}
