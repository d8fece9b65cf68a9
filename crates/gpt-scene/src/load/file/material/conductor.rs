//! `type = "conductor"`

use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::{MaterialKeys, material_keys};
use super::roughness::{DistributionEntry, FacetKeys, MaskingEntry, write_facets};
use super::thin_film::{ThinFilmKeys, write_thin_film};
use crate::load::error::SceneError;
use crate::load::file::colour::{Colour, Rgb, Scalar};
use crate::load::file::reference::NamesTextures;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, FilmIndex, Fraction, Located, NonNegative, Positive};
use crate::load::file::writer::{Writer, colour, line};
use crate::scene::{ColorInput, ConductorFresnel, MaterialKind, Microfacets};
use crate::spectrum::Spectrum;

material_keys! {
    /// A metal, smooth or of microfacets: `eta` and `k`, a `preset`, or `reflectance`.
    #[schemars(extend("allOf" = [
        { "oneOf": [
            { "required": ["eta", "k"], "not": { "anyOf": [{ "required": ["preset"] }, { "required": ["reflectance"] }] } },
            { "required": ["preset"], "not": { "anyOf": [{ "required": ["eta"] }, { "required": ["k"] }, { "required": ["reflectance"] }] } },
            { "required": ["reflectance"], "not": { "anyOf": [{ "required": ["eta"] }, { "required": ["k"] }, { "required": ["preset"] }] } },
        ] },
        { "not": { "anyOf": [
            { "required": ["alpha", "roughness"] }, { "required": ["alpha", "alpha_u"] }, { "required": ["alpha", "roughness_u"] },
            { "required": ["roughness", "alpha_u"] }, { "required": ["roughness", "roughness_u"] }, { "required": ["alpha_u", "roughness_u"] },
        ] } },
        { "dependentRequired": {
            "alpha_u": ["alpha_v"], "alpha_v": ["alpha_u"], "roughness_u": ["roughness_v"], "roughness_v": ["roughness_u"],
            "thin_film_offset": ["thin_film_thickness"], "thin_film_ior": ["thin_film_thickness"],
        } },
        {
            "if": { "anyOf": [{ "required": ["distribution"] }, { "required": ["masking"] }] },
            "then": { "anyOf": [
                { "required": ["alpha"] }, { "required": ["roughness"] }, { "required": ["alpha_u"] }, { "required": ["roughness_u"] },
            ] },
        },
    ]))]
    {
        /// A metal whose eta and k are known.
        preset: Option<Located<MetalEntry>>,
        eta: Option<Located<Rgb<Positive>>>,
        k: Option<Located<Rgb<NonNegative>>>,
        /// At normal incidence (Schlick's approximation).
        reflectance: Option<Located<Colour<Fraction>>>,
        /// Factor of what is reflected, 1 when left out.
        specular_reflectance: Option<Colour<Fraction>>,
        /// Width of the microfacets; 0, a smooth metal, when left out.
        alpha: Option<Located<Scalar<Fraction>>>,
        /// alpha = roughness²
        roughness: Option<Located<Scalar<Fraction>>>,
        /// Width along the direction in which texture coordinate u grows, instead of `alpha`.
        alpha_u: Option<Located<Scalar<Fraction>>>,
        /// And across it.
        alpha_v: Option<Located<Scalar<Fraction>>>,
        /// alpha_u = roughness_u²
        roughness_u: Option<Located<Scalar<Fraction>>>,
        /// alpha_v = roughness_v²
        roughness_v: Option<Located<Scalar<Fraction>>>,
        /// "ggx" when left out.
        distribution: Option<Located<DistributionEntry>>,
        /// "height_correlated" when left out.
        masking: Option<Located<MaskingEntry>>,
        /// Thickness of a film on the surface in nanometres, which makes light interfere; no film when left out.
        thin_film_thickness: Option<Located<Scalar<NonNegative>>>,
        /// Nanometres that are added to the thickness, which is that much where its texture is 0.
        thin_film_offset: Option<Located<Checked<NonNegative>>>,
        /// Index of refraction of the film over that outside, 1.3 when left out.
        thin_film_ior: Option<Located<Checked<FilmIndex>>>,
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

impl NamesTextures for MetalEntry {}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &[
        "preset = \"copper\"\nroughness = 0.3",
        "reflectance = [0.9, 0.6, 0.3]\nalpha = 0.3",
        "preset = \"silver\"",
        "preset = \"gold\"\nalpha = 0.4\ndistribution = \"beckmann\"\nspecular_reflectance = [0.5, 0.8, 0.9]",
        "preset = \"aluminium\"\nalpha_u = 0.6\nalpha_v = 0.15\nmasking = \"separable\"",
        "reflectance = [0.9, 0.6, 0.3]\nroughness_u = 0.3\nroughness_v = 0.8\ndistribution = \"beckmann\"\nmasking = \"separable\"",
        "preset = \"copper\"\nroughness = 0.4\ntwo_sided = false",
        "preset = \"silver\"\nroughness = 0.4\nthin_film_thickness = 350\nthin_film_ior = 1.5",
        "reflectance = [0.9, 0.6, 0.3]\nthin_film_thickness = 150\nthin_film_offset = 100\nthin_film_ior = 1.8",
    ];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        let fresnel = match (&self.eta, &self.k, &self.preset, &self.reflectance) {
            (Some(eta), Some(k), None, None) => ConductorFresnel::Complex { eta: eta.value.0, k: k.value.0 },
            (None, None, Some(metal), None) => metal.value.fresnel(),
            (None, None, None, Some(reflectance)) => ConductorFresnel::Reflectance(resolver.colour(&reflectance.value)?),
            _ => {
                let message = "a conductor needs both `eta` and `k`, or `preset` alone, or `reflectance` alone";
                return Err(resolver.error(&self.name.place, message));
            }
        };
        let facets = FacetKeys {
            alpha: self.alpha.as_ref(),
            roughness: self.roughness.as_ref(),
            alphas: [self.alpha_u.as_ref(), self.alpha_v.as_ref()],
            roughnesses: [self.roughness_u.as_ref(), self.roughness_v.as_ref()],
            distribution: self.distribution.as_ref(),
            masking: self.masking.as_ref(),
        };
        let film = ThinFilmKeys {
            thickness: self.thin_film_thickness.as_ref(),
            offset: self.thin_film_offset.as_ref(),
            ior: self.thin_film_ior.as_ref(),
        };
        Ok(MaterialKind::Conductor {
            fresnel,
            facets: facets.resolve(resolver)?.unwrap_or(Microfacets::ggx(ColorInput::grey(0.0))),
            specular_reflectance: resolver.colour_or_white(&self.specular_reflectance)?,
            film: film.resolve(resolver)?,
        })
    }

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::Conductor { fresnel, facets, specular_reflectance, film } = kind else { return String::new() };
        let fresnel = match fresnel {
            ConductorFresnel::Complex { eta, k } => line("eta", &colour(*eta)) + &line("k", &colour(*k)),
            ConductorFresnel::Reflectance(reflectance) => writer.input("reflectance", reflectance),
        };
        let factor = match *specular_reflectance == ColorInput::grey(1.0) {
            true => String::new(),
            false => writer.input("specular_reflectance", specular_reflectance),
        };
        let is_smooth = *facets == Microfacets::ggx(ColorInput::grey(0.0));
        fresnel
            + &if is_smooth { line("alpha", "0") } else { write_facets(facets, writer) }
            + &factor
            + &write_thin_film(film.as_ref(), writer)
    }
}

impl MetalEntry {
    /// Complex indices of refraction in linear Rec.709, averages of the measured spectra that renderers commonly share.
    pub fn fresnel(self) -> ConductorFresnel {
        let (eta, k) = match self {
            Self::Gold => ([0.143119, 0.374957, 1.44248], [3.98316, 2.38572, 1.60322]),
            Self::Copper => ([0.200438, 0.924033, 1.10221], [3.91295, 2.45285, 2.14219]),
            Self::Silver => ([0.155265, 0.116723, 0.138344], [4.82835, 3.12225, 2.14696]),
            Self::Aluminium => ([1.65746, 0.880369, 0.521229], [9.22387, 6.26952, 4.837]),
        };
        ConductorFresnel::Complex { eta: Spectrum::from_rgb(eta), k: Spectrum::from_rgb(k) }
    }
}

/// The chemical symbol of the preset of a metal with this index of refraction.
pub fn metal_symbol(eta: Spectrum, k: Spectrum) -> Option<&'static str> {
    let presets =
        [(MetalEntry::Gold, "Au"), (MetalEntry::Copper, "Cu"), (MetalEntry::Silver, "Ag"), (MetalEntry::Aluminium, "Al")];
    let is_it = |metal: MetalEntry| matches!(metal.fresnel(), ConductorFresnel::Complex { eta: e, k: i } if (e, i) == (eta, k));
    presets.into_iter().find(|(metal, _)| is_it(*metal)).map(|(_, symbol)| symbol)
}
