//! `type = "rough_glass"`

use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::{MaterialKeys, ior_or_default, material_keys};
use super::roughness::ggx_alpha;
use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, Colour, Fraction, IndexOfRefraction, Located, Positive, Scalar};
use crate::scene::{ColorInput, MaterialKind, MicrofacetDistribution};

material_keys! {
    /// A rough dielectric: one of `alpha`, `roughness` and `exponent`.
    #[schemars(extend("allOf" = [{ "oneOf": [
        { "required": ["alpha"], "not": { "anyOf": [{ "required": ["roughness"] }, { "required": ["exponent"] }] }, "properties": { "distribution": { "const": "ggx" } } },
        { "required": ["roughness"], "not": { "anyOf": [{ "required": ["alpha"] }, { "required": ["exponent"] }] }, "properties": { "distribution": { "const": "ggx" } } },
        { "required": ["exponent"], "not": { "anyOf": [{ "required": ["alpha"] }, { "required": ["roughness"] }] }, "properties": { "distribution": { "const": "phong" } } },
    ] }]))]
    {
        /// Inside over outside, 1.5 when left out.
        ior: Option<Checked<IndexOfRefraction>>,
        /// GGX width.
        alpha: Option<Located<Scalar<Fraction>>>,
        /// alpha = roughness²
        roughness: Option<Located<Scalar<Fraction>>>,
        /// Of the Phong distribution.
        exponent: Option<Located<Scalar<Positive>>>,
        /// "ggx" when left out, but "phong" with an `exponent`.
        distribution: Option<Located<MicrofacetEntry>>,
        /// 1 when left out.
        reflectance: Option<Colour<Fraction>>,
        /// 1 when left out.
        transmittance: Option<Colour<Fraction>>,
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MicrofacetEntry {
    Ggx,
    Phong,
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &[
        "ior = 1.5\nroughness = 0.4",
        "ior = 1.7\nalpha = 0.3\nreflectance = 0.8\ntransmittance = [0.4, 0.8, 0.9]",
        "exponent = 60",
    ];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        let (alpha, distribution) = self.distribution(resolver)?;
        Ok(MaterialKind::RoughGlass {
            ior: ior_or_default(self.ior),
            alpha,
            distribution,
            reflectance: resolver.colour_or_white(&self.reflectance)?,
            transmittance: resolver.colour_or_white(&self.transmittance)?,
        })
    }
}

impl Keys {
    /// GGX and its width, or Phong's distribution and its exponent.
    fn distribution(&self, resolver: &Resolver<'_>) -> Result<(ColorInput, MicrofacetDistribution), SceneError> {
        let name = self.distribution.as_ref();
        match (&self.exponent, name.map(|name| name.value)) {
            (Some(exponent), None | Some(MicrofacetEntry::Phong)) => match self.alpha.as_ref().or(self.roughness.as_ref()) {
                Some(other) => Err(resolver.error(&other.span, "either `exponent` or one of `alpha` and `roughness`")),
                None => Ok((resolver.scalar(&exponent.value)?, MicrofacetDistribution::Phong)),
            },
            (Some(exponent), Some(MicrofacetEntry::Ggx)) => {
                Err(resolver.error(&exponent.span, "`exponent` belongs to distribution = \"phong\""))
            }
            (None, Some(MicrofacetEntry::Phong)) => {
                let span = name.map_or(&self.name.span, |name| &name.span);
                Err(resolver.error(span, "distribution = \"phong\" needs the key `exponent`"))
            }
            (None, None | Some(MicrofacetEntry::Ggx)) => {
                let missing = || resolver.error(&self.name.span, "rough_glass needs one of `alpha`, `roughness` and `exponent`");
                let alpha = ggx_alpha(self.alpha.as_ref(), self.roughness.as_ref(), resolver)?.ok_or_else(missing)?;
                Ok((alpha, MicrofacetDistribution::Ggx))
            }
        }
    }
}
