//! `[[medium]]`

use schemars::JsonSchema;
use serde::Deserialize;

use super::colour::Rgb;
use super::resolver::Resolver;
use super::value::{Checked, Fraction, Located, MeanCosine, NonNegative, Positive};
use super::writer::{colour, line, list, number, table, text};
use crate::load::error::SceneError;
use crate::scene::{Medium, Phase, PhaseKind, PhaseLobe};
use crate::spectrum::Spectrum;

/// A medium that fills bodies (`interior` of a material) or the space around the camera (`medium` of the camera). Either `absorption` and
/// `scattering` say how dense it is, or `albedo` and `mean_free_path` do.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "MediumEntry", extend("dependentRequired" = { "albedo": ["mean_free_path"], "mean_free_path": ["albedo"] }))]
pub struct MediumEntry {
    /// Name by which materials and the camera refer to the medium.
    #[schemars(extend("minLength" = 1))]
    pub name: Located<String>,
    /// Share of light that is absorbed, per scene unit; 0 when left out.
    pub absorption: Option<Located<Rgb<NonNegative>>>,
    /// Share of light that is scattered, per scene unit; 0 when left out.
    pub scattering: Option<Located<Rgb<NonNegative>>>,
    /// In place of `absorption` and `scattering`: the share that is scattered of the light that is lost to a ray.
    pub albedo: Option<Located<Rgb<Fraction>>>,
    /// With `albedo`: how far light goes on average before it is absorbed or scattered, in scene units.
    pub mean_free_path: Option<Located<Rgb<Positive>>>,
    /// Radiance that is given off, per scene unit; none when left out.
    pub emission: Option<Rgb<NonNegative>>,
    /// How scattered light is spread over directions; isotropic when left out.
    pub phase: Option<PhaseEntry>,
}

/// A phase function.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(rename = "key:type", rename_all = "snake_case")]
#[schemars(tag = "type", rename = "PhaseEntry")]
pub enum PhaseEntry {
    /// All directions alike.
    Isotropic(NoKeys),
    /// Henyey and Greenstein's, which is ahead or back as `g` says.
    HenyeyGreenstein(HenyeyGreensteinKeys),
    /// Scattering by what is much smaller than the wavelength.
    Rayleigh(NoKeys),
    /// A mean of other phase functions.
    Blend(PhaseBlendKeys),
}

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct NoKeys {}

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct HenyeyGreensteinKeys {
    /// Mean cosine between the directions before and after, from -0.999 to 0.999: below 0 light is thrown back, above it goes ahead.
    pub g: Checked<MeanCosine>,
}

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct PhaseBlendKeys {
    /// The phase functions.
    #[schemars(extend("minItems" = 1))]
    pub phases: Located<Vec<PhaseEntry>>,
    /// The share of each; in all they count as 1.
    pub weights: Located<Vec<Checked<NonNegative>>>,
}

impl MediumEntry {
    pub fn resolve(&self, resolver: &Resolver<'_>) -> Result<Medium, SceneError> {
        let value =
            |written: &Option<Located<Rgb<NonNegative>>>| written.as_ref().map_or(Spectrum::BLACK, |written| written.value.0);
        let [absorption, scattering] = match (&self.albedo, &self.mean_free_path) {
            (None, None) => [value(&self.absorption), value(&self.scattering)],
            (Some(albedo), Some(path)) => {
                if let Some(other) = self.absorption.as_ref().or(self.scattering.as_ref()) {
                    let message = "a medium has `absorption` and `scattering`, or `albedo` and `mean_free_path`, not both";
                    return Err(resolver.error(&other.place, message));
                }
                let extinction = Spectrum::WHITE / path.value.0;
                let scattering = albedo.value.0 * extinction;
                [extinction - scattering, scattering]
            }
            (Some(Located { place, .. }), None) => {
                return Err(resolver.error(place, "`albedo` needs the key `mean_free_path`, which says how dense the medium is"));
            }
            (None, Some(Located { place, .. })) => return Err(resolver.error(place, "`mean_free_path` needs the key `albedo`")),
        };
        let phase = self.phase.as_ref().map_or(Ok(Phase::isotropic()), |phase| phase.resolve(resolver))?;
        let emission = self.emission.as_ref().map_or(Spectrum::BLACK, |emission| emission.0);
        Ok(Medium { name: self.name.value.clone(), absorption, scattering, emission, phase })
    }
}

impl PhaseEntry {
    fn resolve(&self, resolver: &Resolver<'_>) -> Result<Phase, SceneError> {
        let PhaseBlendKeys { phases, weights } = match self {
            Self::Isotropic(_) => return Ok(Phase::isotropic()),
            Self::HenyeyGreenstein(keys) => return Ok(Phase::of(PhaseKind::HenyeyGreenstein { g: keys.g.0 })),
            Self::Rayleigh(_) => return Ok(Phase::of(PhaseKind::Rayleigh)),
            Self::Blend(keys) => keys,
        };
        if phases.value.len() != weights.value.len() {
            let message =
                format!("{} phase functions need as many weights, and there are {}", phases.value.len(), weights.value.len());
            return Err(resolver.error(&weights.place, message));
        }
        let sum: f64 = weights.value.iter().map(|weight| weight.0).sum();
        if sum <= 0.0 {
            return Err(resolver.error(&weights.place, "the weights of phase functions cannot all be 0"));
        }
        let mut lobes: Vec<PhaseLobe> = Vec::new();
        for (phase, weight) in phases.value.iter().zip(&weights.value) {
            let Phase(parts) = phase.resolve(resolver)?;
            lobes.extend(parts.into_iter().map(|lobe| PhaseLobe { weight: lobe.weight * weight.0 / sum, ..lobe }));
        }
        lobes.retain(|lobe| lobe.weight > 0.0);
        Ok(Phase(lobes))
    }
}

/// The keys of a medium, a line each.
pub fn write(medium: &Medium) -> String {
    let mut out = String::new();
    for (key, value) in [("absorption", medium.absorption), ("scattering", medium.scattering), ("emission", medium.emission)] {
        if !value.is_black() {
            out += &line(key, &colour(value));
        }
    }
    if medium.phase != Phase::isotropic() {
        out += &line("phase", &phase(&medium.phase));
    }
    out
}

fn phase(Phase(lobes): &Phase) -> String {
    let of_kind = |kind: PhaseKind| match kind {
        PhaseKind::HenyeyGreenstein { g } => table([("type", text("henyey_greenstein")), ("g", number(g))]),
        PhaseKind::Rayleigh => table([("type", text("rayleigh"))]),
    };
    match lobes.as_slice() {
        [PhaseLobe { weight: 1.0, kind }] => of_kind(*kind),
        lobes => table([
            ("type", text("blend")),
            ("phases", list(lobes.iter().map(|lobe| of_kind(lobe.kind)))),
            ("weights", list(lobes.iter().map(|lobe| number(lobe.weight)))),
        ]),
    }
}
