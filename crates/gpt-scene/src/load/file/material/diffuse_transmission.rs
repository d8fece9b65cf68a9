//! `type = "diffuse_transmission"`

use super::keys::{MaterialKeys, material_keys};
use crate::load::error::SceneError;
use crate::load::file::colour::Colour;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::Fraction;
use crate::load::file::writer::Writer;
use crate::scene::{ColorInput, MaterialKind};

/// Rounding of colours that add up to 1.
const ROUNDING: f64 = 1e-9;

material_keys! {
    /// A sheet that scatters light in all directions on both sides, as paper and leaves do: f = ρ/π for light from the side that is seen, and
    /// τ/π for light from the other one. Together they are at most 1 in each channel; where textures add up to more, both are divided by their sum.
    {
        /// The share ρ that is scattered back.
        reflectance: Colour<Fraction>,
        /// The share τ that is scattered on.
        transmittance: Colour<Fraction>,
    }
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &[
        "reflectance = [0.5, 0.3, 0.1]\ntransmittance = [0.2, 0.6, 0.3]",
        "reflectance = 0.05\ntransmittance = [0.9, 0.5, 0.2]\ntwo_sided = false",
    ];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        let (reflectance, transmittance) = (resolver.colour(&self.reflectance)?, resolver.colour(&self.transmittance)?);
        if let (ColorInput::Constant(back), ColorInput::Constant(on)) = (reflectance, transmittance)
            && (back + on).max_component() > 1.0 + ROUNDING
        {
            let message = format!("`reflectance` and `transmittance` add up to {}: more light than arrives", back + on);
            return Err(resolver.error(&self.name.place, message).with_help("their sum is at most 1 in each channel"));
        }
        Ok(MaterialKind::DiffuseTransmission { reflectance, transmittance })
    }

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::DiffuseTransmission { reflectance, transmittance } = kind else { return String::new() };
        writer.input("reflectance", reflectance) + &writer.input("transmittance", transmittance)
    }
}
