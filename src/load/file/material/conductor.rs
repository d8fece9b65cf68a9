//! `type = "conductor"`

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::{MaterialKeys, material_keys};
use super::roughness::ggx_alpha;
use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Colour, Fraction, Located, NonNegative, Positive, Rgb, Scalar};
use crate::scene::{ColorInput, ConductorFresnel, MaterialKind};

material_keys! {
    /// GGX with height-correlated Smith shadowing: `eta` and `k`, a `preset`, or `reflectance`.
    #[schemars(extend("allOf" = [
        { "oneOf": [
            { "required": ["eta", "k"], "not": { "anyOf": [{ "required": ["preset"] }, { "required": ["reflectance"] }] } },
            { "required": ["preset"], "not": { "anyOf": [{ "required": ["eta"] }, { "required": ["k"] }, { "required": ["reflectance"] }] } },
            { "required": ["reflectance"], "not": { "anyOf": [{ "required": ["eta"] }, { "required": ["k"] }, { "required": ["preset"] }] } },
        ] },
        { "not": { "required": ["alpha", "roughness"] } },
    ]))]
    {
        /// A metal whose eta and k are known.
        preset: Option<Located<MetalEntry>>,
        eta: Option<Located<Rgb<Positive>>>,
        k: Option<Located<Rgb<NonNegative>>>,
        /// At normal incidence (Schlick's approximation).
        reflectance: Option<Located<Colour<Fraction>>>,
        /// GGX width; 0, a smooth metal, when left out.
        alpha: Option<Located<Scalar<Fraction>>>,
        /// alpha = roughness²
        roughness: Option<Located<Scalar<Fraction>>>,
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MetalEntry {
    Gold,
    Copper,
    Silver,
    Aluminium,
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] =
        &["preset = \"copper\"\nroughness = 0.3", "reflectance = [0.9, 0.6, 0.3]\nalpha = 0.3", "preset = \"silver\""];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        let fresnel = match (&self.eta, &self.k, &self.preset, &self.reflectance) {
            (Some(eta), Some(k), None, None) => ConductorFresnel::Complex { eta: eta.value.0, k: k.value.0 },
            (None, None, Some(metal), None) => metal_fresnel(metal.value),
            (None, None, None, Some(reflectance)) => ConductorFresnel::Reflectance(resolver.colour(&reflectance.value)?),
            _ => {
                let message = "a conductor needs both `eta` and `k`, or `preset` alone, or `reflectance` alone";
                return Err(resolver.error(&self.name.span, message));
            }
        };
        let alpha = ggx_alpha(self.alpha.as_ref(), self.roughness.as_ref(), resolver)?;
        Ok(MaterialKind::Conductor { fresnel, alpha: alpha.unwrap_or(ColorInput::grey(0.0)) })
    }
}

/// Complex indices of refraction in linear Rec.709, averages of the measured spectra that renderers commonly share.
fn metal_fresnel(metal: MetalEntry) -> ConductorFresnel {
    let (eta, k) = match metal {
        MetalEntry::Gold => ([0.143119, 0.374957, 1.44248], [3.98316, 2.38572, 1.60322]),
        MetalEntry::Copper => ([0.200438, 0.924033, 1.10221], [3.91295, 2.45285, 2.14219]),
        MetalEntry::Silver => ([0.155265, 0.116723, 0.138344], [4.82835, 3.12225, 2.14696]),
        MetalEntry::Aluminium => ([1.65746, 0.880369, 0.521229], [9.22387, 6.26952, 4.837]),
    };
    ConductorFresnel::Complex { eta: DVec3::from_array(eta), k: DVec3::from_array(k) }
}
