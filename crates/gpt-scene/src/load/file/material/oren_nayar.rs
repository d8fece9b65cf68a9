//! `type = "oren_nayar"`

use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::{MaterialKeys, material_keys};
use crate::load::error::SceneError;
use crate::load::file::colour::{Colour, Scalar};
use crate::load::file::reference::NamesTextures;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::Fraction;
use crate::load::file::writer::{Writer, line, text};
use crate::scene::{ColorInput, MaterialKind, RoughDiffuseModel};

material_keys! {
    /// A rough surface whose facets each follow Lambert's law: flatter than Lambert's, and brighter towards the light.
    {
        reflectance: Colour<Fraction>,
        /// 0.5 when left out; 0 is Lambert's law. The standard deviation of the facets' angles in radians for "qualitative" and "full"; of "energy_preserving" Fujii's σ.
        roughness: Option<Scalar<Fraction>>,
        /// "energy_preserving" when left out.
        model: Option<RoughDiffuseEntry>,
    }
}

/// How facets that Lambert's law holds for are seen together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "RoughDiffuseEntry")]
pub enum RoughDiffuseEntry {
    /// Fujii's form of the qualitative model, with the light given back that it loses (Portsmouth, Kutz and Hill 2025).
    EnergyPreserving,
    /// Oren and Nayar's (1994) simpler model, without light from facet to facet.
    Qualitative,
    /// Their whole model, with light that goes from one facet to another.
    Full,
}

impl NamesTextures for RoughDiffuseEntry {}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &[
        "reflectance = [0.9, 0.5, 0.2]\nroughness = 0.7",
        "reflectance = [0.2, 0.5, 0.8]\nroughness = 0.4\nmodel = \"qualitative\"",
        "reflectance = [0.8, 0.7, 0.3]\nroughness = 0.6\nmodel = \"full\"",
    ];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        Ok(MaterialKind::OrenNayar {
            reflectance: resolver.colour(&self.reflectance)?,
            roughness: self.roughness.as_ref().map_or(Ok(ColorInput::grey(0.5)), |roughness| resolver.scalar(roughness))?,
            model: match self.model.unwrap_or(RoughDiffuseEntry::EnergyPreserving) {
                RoughDiffuseEntry::EnergyPreserving => RoughDiffuseModel::EnergyPreserving,
                RoughDiffuseEntry::Qualitative => RoughDiffuseModel::Qualitative,
                RoughDiffuseEntry::Full => RoughDiffuseModel::Full,
            },
        })
    }

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::OrenNayar { reflectance, roughness, model } = kind else { return String::new() };
        let name = match model {
            RoughDiffuseModel::EnergyPreserving => "energy_preserving",
            RoughDiffuseModel::Qualitative => "qualitative",
            RoughDiffuseModel::Full => "full",
        };
        writer.input("reflectance", reflectance) + &writer.input("roughness", roughness) + &line("model", &text(name))
    }
}
