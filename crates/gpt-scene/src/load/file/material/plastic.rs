//! `type = "plastic"`

use super::keys::{MaterialKeys, ior_or_default, material_keys};
use super::roughness::{DistributionEntry, MaskingEntry, write_distribution, write_masking};
use crate::load::error::SceneError;
use crate::load::file::colour::Colour;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, Fraction, IndexOfRefraction, Located};
use crate::load::file::writer::{Writer, flag, line, number};
use crate::scene::{Masking, MaterialKind, MicrofacetDistribution, PlasticInterface};

material_keys! {
    /// A diffuse base below a dielectric surface, which is smooth, or of microfacets where `alpha` or `roughness` is written.
    #[schemars(extend("allOf" = [
        { "not": { "required": ["alpha", "roughness"] } },
        {
            "if": { "anyOf": [{ "required": ["distribution"] }, { "required": ["masking"] }] },
            "then": { "anyOf": [{ "required": ["alpha"] }, { "required": ["roughness"] }] },
        },
    ]))]
    {
        /// Reflectance of the diffuse base.
        reflectance: Colour<Fraction>,
        /// Inside over outside, 1.5 when left out.
        ior: Option<Checked<IndexOfRefraction>>,
        /// Factor of what the surface reflects, 1 when left out.
        specular_reflectance: Option<Colour<Fraction>>,
        /// Width of the surface's microfacets, the same everywhere.
        alpha: Option<Located<Checked<Fraction>>>,
        /// alpha = roughness²
        roughness: Option<Located<Checked<Fraction>>>,
        /// "ggx" when left out.
        distribution: Option<Located<DistributionEntry>>,
        /// "height_correlated" when left out.
        masking: Option<Located<MaskingEntry>>,
        /// The colour deepens as light goes up and down below the surface.
        #[serde(default)]
        nonlinear: bool,
    }
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &[
        "reflectance = [0.8, 0.3, 0.1]",
        "reflectance = [0.8, 0.3, 0.1]\nior = 1.9\nspecular_reflectance = [0.5, 0.8, 0.9]\nnonlinear = true",
        "reflectance = [0.1, 0.4, 0.7]\nalpha = 0.2",
        "reflectance = 0.5\nroughness = 0.7\ndistribution = \"beckmann\"\nmasking = \"separable\"\nnonlinear = true",
    ];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        Ok(MaterialKind::Plastic {
            interface: self.interface(resolver)?,
            reflectance: resolver.colour(&self.reflectance)?,
            specular_reflectance: resolver.colour_or_white(&self.specular_reflectance)?,
            nonlinear: self.nonlinear,
        })
    }

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::Plastic { interface, reflectance, specular_reflectance, nonlinear } = kind else {
            return String::new();
        };
        let colours = writer.input("reflectance", reflectance) + &writer.input("specular_reflectance", specular_reflectance);
        write_interface(interface) + &colours + &flag("nonlinear", *nonlinear)
    }
}

impl Keys {
    fn interface(&self, resolver: &Resolver<'_>) -> Result<PlasticInterface, SceneError> {
        let ior = ior_or_default(self.ior);
        let alpha = match (&self.alpha, &self.roughness) {
            (Some(_), Some(roughness)) => return Err(resolver.error(&roughness.place, "either `alpha` or `roughness`")),
            (Some(alpha), None) => alpha.value.0,
            (None, Some(roughness)) => roughness.value.0.powi(2),
            (None, None) => {
                let unused = self.distribution.as_ref().map(|key| ("distribution", &key.place));
                return match unused.or(self.masking.as_ref().map(|key| ("masking", &key.place))) {
                    Some((name, span)) => {
                        Err(resolver.error(span, format!("`{name}` is for rough surfaces: it needs `alpha` or `roughness`")))
                    }
                    None => Ok(PlasticInterface::smooth(ior)),
                };
            }
        };
        let distribution = self.distribution.as_ref().map_or(MicrofacetDistribution::Ggx, |key| key.value.into());
        let masking = self.masking.as_ref().map_or(Masking::HeightCorrelated, |key| key.value.into());
        Ok(PlasticInterface::rough(ior, alpha, distribution, masking))
    }
}

fn write_interface(interface: &PlasticInterface) -> String {
    let ior = line("ior", &number(interface.ior));
    if !interface.is_rough() {
        return ior;
    }
    let rough = write_distribution(interface.distribution) + &write_masking(interface.masking);
    ior + &line("alpha", &number(interface.alpha)) + &rough
}
