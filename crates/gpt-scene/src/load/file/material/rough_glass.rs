//! `type = "rough_glass"`

use schemars::JsonSchema;
use serde::Deserialize;

use super::dispersion::{IndexKeys, Sellmeier, write_index};
use super::keys::{MaterialKeys, material_keys};
use super::roughness::{FacetKeys, MaskingEntry, write_facets};
use super::thin_film::{ThinFilmKeys, write_thin_film};
use crate::load::error::SceneError;
use crate::load::file::colour::{Colour, Scalar};
use crate::load::file::reference::NamesTextures;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, FilmIndex, Fraction, IndexOfRefraction, Located, NonNegative, Positive, Vector};
use crate::load::file::writer::{Writer, flag};
use crate::scene::{Masking, MaterialKind, MicrofacetDistribution, Microfacets};

material_keys! {
    /// A rough dielectric: one of `alpha`, `roughness`, `alpha_u` with `alpha_v`, `roughness_u` with `roughness_v`, and `exponent`.
    #[schemars(extend("allOf" = [
        { "oneOf": [
            { "required": ["alpha"] }, { "required": ["roughness"] }, { "required": ["alpha_u"] }, { "required": ["roughness_u"] },
            { "required": ["exponent"] },
        ] },
        { "dependentRequired": {
            "alpha_u": ["alpha_v"], "alpha_v": ["alpha_u"], "roughness_u": ["roughness_v"], "roughness_v": ["roughness_u"],
            "thin_film_offset": ["thin_film_thickness"], "thin_film_ior": ["thin_film_thickness"],
        } },
        { "not": { "anyOf": [
            { "required": ["cauchy", "sellmeier"] }, { "required": ["cauchy", "ior"] }, { "required": ["cauchy", "abbe_number"] },
            { "required": ["sellmeier", "ior"] }, { "required": ["sellmeier", "abbe_number"] },
        ] } },
        {
            "if": { "anyOf": [{ "required": ["abbe_number"] }, { "required": ["cauchy"] }, { "required": ["sellmeier"] }] },
            "then": { "properties": { "thin": { "const": false } }, "not": { "required": ["exponent"] } },
        },
        { "not": { "required": ["thin_film_thickness", "thin"], "properties": { "thin": { "const": true } } } },
        {
            "if": { "required": ["exponent"] },
            "then": {
                "properties": { "distribution": { "const": "phong" }, "thin": { "const": false } },
                "not": { "anyOf": [{ "required": ["masking"] }, { "required": ["thin_film_thickness"] }] },
            },
            "else": { "properties": { "distribution": { "enum": ["ggx", "beckmann"] } } },
        },
    ]))]
    {
        /// Inside over outside, 1.5 when left out.
        ior: Option<Located<Checked<IndexOfRefraction>>>,
        /// Abbe's number (n_d - 1)/(n_F - n_C), with `ior` the index n_d: light of each channel is bent by an index of its own. All are bent alike when left out.
        abbe_number: Option<Located<Checked<Positive>>>,
        /// In place of `ior`: coefficients of Cauchy's formula n = A + B/λ² + C/λ⁴, λ in micrometres.
        cauchy: Option<Located<Vector>>,
        /// In place of `ior`: coefficients of Sellmeier's formula n² = 1 + Σ bᵢ·λ²/(λ² - cᵢ), λ in micrometres.
        sellmeier: Option<Located<Sellmeier>>,
        /// Width of the microfacets.
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
        /// Exponent of the Phong distribution.
        exponent: Option<Located<Scalar<Positive>>>,
        /// "ggx" when left out, but "phong" with an `exponent`.
        distribution: Option<Located<MicrofacetEntry>>,
        /// "height_correlated" when left out.
        masking: Option<Located<MaskingEntry>>,
        /// Every microfacet is a plate with two boundaries, too thin to be seen.
        thin: Option<Located<bool>>,
        /// 1 when left out.
        reflectance: Option<Colour<Fraction>>,
        /// 1 when left out.
        transmittance: Option<Colour<Fraction>>,
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
pub enum MicrofacetEntry {
    /// Long tails: a halo around highlights.
    Ggx,
    /// Normally distributed slopes.
    Beckmann,
    /// Cosine-power lobes about the directions of smooth glass.
    Phong,
}

impl NamesTextures for MicrofacetEntry {}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &[
        "ior = 1.5\nroughness = 0.4",
        "ior = 1.7\nalpha = 0.3\nreflectance = 0.8\ntransmittance = [0.4, 0.8, 0.9]",
        "exponent = 60",
        "alpha = 0.3\ndistribution = \"beckmann\"\nmasking = \"separable\"",
        "ior = 1.4\nalpha_u = 0.5\nalpha_v = 0.15\ntransmittance = [0.4, 0.8, 0.9]",
        "ior = 1.6\nalpha = 0.3\nthin = true\ntransmittance = [0.4, 0.8, 0.9]",
        "roughness_u = 0.3\nroughness_v = 0.7\ndistribution = \"beckmann\"\nthin = true",
        "ior = 1.5\nabbe_number = 12\nalpha = 0.2\ntransmittance = [0.4, 0.8, 0.9]",
        "ior = 1.7\nalpha = 0.3\nthin_film_thickness = 300\nreflectance = 0.8\ntransmittance = [0.4, 0.8, 0.9]",
    ];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        let facets = match &self.exponent {
            Some(exponent) => self.phong(exponent, resolver)?,
            None => self.facets(resolver)?,
        };
        let film = ThinFilmKeys {
            thickness: self.thin_film_thickness.as_ref(),
            offset: self.thin_film_offset.as_ref(),
            ior: self.thin_film_ior.as_ref(),
        };
        let thin = self.thin.as_ref().is_some_and(|thin| thin.value);
        if let (Some((name, place)), true) = (film.place(), thin) {
            return Err(resolver
                .error(place, format!("`{name}` is for a boundary of glass, and a `thin` wall has two"))
                .with_help("a film in air, as of a bubble, is glass of `ior = 1` with a thin film"));
        }
        if let (Some((name, place)), Some(_)) = (film.place(), &self.exponent) {
            return Err(resolver.error(place, format!("`{name}` is for microfacets: distribution = \"phong\" has none")));
        }
        let index = IndexKeys {
            ior: self.ior.as_ref(),
            abbe_number: self.abbe_number.as_ref(),
            cauchy: self.cauchy.as_ref(),
            sellmeier: self.sellmeier.as_ref(),
        };
        let (ior, dispersion) = index.resolve(resolver)?;
        if let (Some((name, place)), true) = (index.place(), thin) {
            return Err(resolver.error(place, format!("`{name}` has no effect: a `thin` wall does not bend light")));
        }
        if let (Some((name, place)), Some(_)) = (index.place(), &self.exponent) {
            return Err(resolver.error(place, format!("`{name}` is for microfacets: distribution = \"phong\" has none")));
        }
        Ok(MaterialKind::RoughGlass {
            ior,
            dispersion,
            facets,
            reflectance: resolver.colour_or_white(&self.reflectance)?,
            transmittance: resolver.colour_or_white(&self.transmittance)?,
            thin,
            film: film.resolve(resolver)?,
        })
    }

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::RoughGlass { ior, facets, reflectance, transmittance, thin, film, dispersion } = kind else {
            return String::new();
        };
        let tints = writer.input("reflectance", reflectance) + &writer.input("transmittance", transmittance);
        write_index(*ior, dispersion.as_ref())
            + &write_facets(facets, writer)
            + &tints
            + &flag("thin", *thin)
            + &write_thin_film(film.as_ref(), writer)
    }
}

impl Keys {
    /// Phong's distribution, which has an exponent and nothing of what microfacets have.
    fn phong(&self, exponent: &Located<Scalar<Positive>>, resolver: &Resolver<'_>) -> Result<Microfacets, SceneError> {
        if self.distribution.as_ref().is_some_and(|name| name.value != MicrofacetEntry::Phong) {
            return Err(resolver.error(&exponent.place, "`exponent` belongs to distribution = \"phong\""));
        }
        let pairs = [&self.alpha_u, &self.alpha_v, &self.roughness_u, &self.roughness_v];
        if let Some(other) = [&self.alpha, &self.roughness].into_iter().chain(pairs).flatten().next() {
            return Err(resolver.error(&other.place, "either `exponent` or one of `alpha` and `roughness`"));
        }
        if let Some(masking) = &self.masking {
            return Err(resolver.error(&masking.place, "`masking` is for microfacets: distribution = \"phong\" has none"));
        }
        if let Some(thin) = self.thin.as_ref().filter(|thin| thin.value) {
            return Err(resolver.error(&thin.place, "thin walls are for microfacets: distribution = \"phong\" has none"));
        }
        Ok(Microfacets::phong(resolver.scalar(&exponent.value)?))
    }

    fn facets(&self, resolver: &Resolver<'_>) -> Result<Microfacets, SceneError> {
        let distribution = match &self.distribution {
            Some(name) if name.value == MicrofacetEntry::Phong => {
                return Err(resolver.error(&name.place, "distribution = \"phong\" needs the key `exponent`"));
            }
            Some(Located { value: MicrofacetEntry::Beckmann, .. }) => MicrofacetDistribution::Beckmann,
            _ => MicrofacetDistribution::Ggx,
        };
        let keys = FacetKeys {
            alpha: self.alpha.as_ref(),
            roughness: self.roughness.as_ref(),
            alphas: [self.alpha_u.as_ref(), self.alpha_v.as_ref()],
            roughnesses: [self.roughness_u.as_ref(), self.roughness_v.as_ref()],
            distribution: None,
            masking: None,
        };
        let missing = || resolver.error(&self.name.place, "rough_glass needs one of `alpha`, `roughness` and `exponent`");
        let facets = keys.resolve(resolver)?.ok_or_else(missing)?;
        let masking = self.masking.as_ref().map_or(Masking::HeightCorrelated, |masking| masking.value.into());
        Ok(Microfacets { distribution, masking, ..facets })
    }
}
