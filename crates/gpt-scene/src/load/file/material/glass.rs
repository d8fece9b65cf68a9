//! `type = "glass"`

use super::keys::{MaterialKeys, ior_or_default, material_keys};
use crate::load::error::SceneError;
use crate::load::file::colour::Colour;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, Fraction, IndexOfRefraction};
use crate::load::file::writer::{Writer, flag, line, number};
use crate::scene::MaterialKind;

material_keys! {
    /// A smooth dielectric with exact Fresnel equations.
    {
        /// Inside over outside, 1.5 when left out.
        ior: Option<Checked<IndexOfRefraction>>,
        /// 1 when left out.
        reflectance: Option<Colour<Fraction>>,
        /// 1 when left out.
        transmittance: Option<Colour<Fraction>>,
        /// A plate with two boundaries, too thin to be seen: light goes through without changing its direction.
        #[serde(default)]
        thin: bool,
    }
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &[
        "ior = 1.7\nreflectance = 0.8\ntransmittance = [0.4, 0.8, 0.9]",
        "ior = 1.6\nthin = true\nreflectance = 0.8\ntransmittance = [0.4, 0.8, 0.9]",
    ];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        Ok(MaterialKind::Glass {
            ior: ior_or_default(self.ior),
            reflectance: resolver.colour_or_white(&self.reflectance)?,
            transmittance: resolver.colour_or_white(&self.transmittance)?,
            thin: self.thin,
        })
    }

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::Glass { ior, reflectance, transmittance, thin } = kind else { return String::new() };
        let tints = writer.input("reflectance", reflectance) + &writer.input("transmittance", transmittance);
        line("ior", &number(*ior)) + &tints + &flag("thin", *thin)
    }
}
