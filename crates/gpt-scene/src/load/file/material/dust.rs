//! `type = "dust"`

use super::keys::{MaterialKeys, material_keys};
use crate::load::error::SceneError;
use crate::load::file::colour::{Colour, Scalar};
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, Fraction, MeanCosine, NonNegative};
use crate::load::file::writer::{Writer, line, number};
use crate::scene::{ColorInput, MaterialKind};

material_keys! {
    /// A thin layer of particles that scatter light once (Blinn 1982), above a surface that follows Lambert's law.
    {
        /// Share of light that a particle scatters.
        albedo: Colour<Fraction>,
        /// Optical thickness: along the normal the layer lets exp(−thickness) of light through.
        thickness: Scalar<NonNegative>,
        /// Mean cosine between the directions before and after light is scattered; 0 when left out. Below 0 it goes back rather than on.
        anisotropy: Option<Checked<MeanCosine>>,
        /// Reflectance of the surface below the layer, black when left out.
        base: Option<Colour<Fraction>>,
    }
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &[
        "albedo = [0.9, 0.8, 0.6]\nthickness = 0.8",
        "albedo = 0.7\nthickness = 0.3\nanisotropy = -0.4\nbase = [0.6, 0.1, 0.1]",
    ];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        Ok(MaterialKind::Dust {
            albedo: resolver.colour(&self.albedo)?,
            thickness: resolver.scalar(&self.thickness)?,
            anisotropy: self.anisotropy.map_or(0.0, |anisotropy| anisotropy.0),
            base: self.base.as_ref().map_or(Ok(ColorInput::grey(0.0)), |base| resolver.colour(base))?,
        })
    }

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::Dust { albedo, thickness, anisotropy, base } = kind else { return String::new() };
        writer.input("albedo", albedo)
            + &writer.input("thickness", thickness)
            + &line("anisotropy", &number(*anisotropy))
            + &writer.input("base", base)
    }
}
