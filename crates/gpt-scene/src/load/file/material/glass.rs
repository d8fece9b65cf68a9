//! `type = "glass"`

use super::dispersion::{IndexKeys, Sellmeier, write_index};
use super::keys::{MaterialKeys, material_keys};
use super::thin_film::{ThinFilmKeys, write_thin_film};
use crate::load::error::SceneError;
use crate::load::file::colour::{Colour, Scalar};
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, FilmIndex, Fraction, IndexOfRefraction, Located, NonNegative, Positive, Vector};
use crate::load::file::writer::{Writer, flag};
use crate::scene::MaterialKind;

material_keys! {
    /// A smooth dielectric with exact Fresnel equations.
    #[schemars(extend("allOf" = [
        { "dependentRequired": { "thin_film_offset": ["thin_film_thickness"], "thin_film_ior": ["thin_film_thickness"] } },
        { "not": { "anyOf": [
            { "required": ["cauchy", "sellmeier"] }, { "required": ["cauchy", "ior"] }, { "required": ["cauchy", "abbe_number"] },
            { "required": ["sellmeier", "ior"] }, { "required": ["sellmeier", "abbe_number"] },
        ] } },
        {
            "if": { "anyOf": [{ "required": ["abbe_number"] }, { "required": ["cauchy"] }, { "required": ["sellmeier"] }] },
            "then": { "properties": { "thin": { "const": false } } },
        },
        { "not": { "required": ["thin_film_thickness", "thin"], "properties": { "thin": { "const": true } } } },
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
        /// 1 when left out.
        reflectance: Option<Colour<Fraction>>,
        /// 1 when left out.
        transmittance: Option<Colour<Fraction>>,
        /// A plate with two boundaries, too thin to be seen: light goes through without changing its direction.
        #[serde(default)]
        thin: bool,
        /// Thickness of a film on the surface in nanometres, which makes light interfere; no film when left out.
        thin_film_thickness: Option<Located<Scalar<NonNegative>>>,
        /// Nanometres that are added to the thickness, which is that much where its texture is 0.
        thin_film_offset: Option<Located<Checked<NonNegative>>>,
        /// Index of refraction of the film over that outside, 1.3 when left out.
        thin_film_ior: Option<Located<Checked<FilmIndex>>>,
    }
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &[
        "ior = 1.7\nreflectance = 0.8\ntransmittance = [0.4, 0.8, 0.9]",
        "ior = 1.6\nthin = true\nreflectance = 0.8\ntransmittance = [0.4, 0.8, 0.9]",
        "ior = 1.5\nthin_film_thickness = 400\nthin_film_ior = 2.2\ntransmittance = [0.4, 0.8, 0.9]",
        "ior = 1\nthin_film_thickness = 250\nthin_film_offset = 100",
        "ior = 1.7\nabbe_number = 9\nreflectance = 0.8\ntransmittance = [0.4, 0.8, 0.9]",
        "cauchy = [1.4, 0.03, 0.002]\nthin_film_thickness = 400",
        "sellmeier = { b = [1.2, 0.3, 1.0], c = [0.03, 0.05, 100] }",
    ];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        let film = ThinFilmKeys {
            thickness: self.thin_film_thickness.as_ref(),
            offset: self.thin_film_offset.as_ref(),
            ior: self.thin_film_ior.as_ref(),
        };
        if let (Some((name, place)), true) = (film.place(), self.thin) {
            return Err(resolver
                .error(place, format!("`{name}` is for a boundary of glass, and a `thin` wall has two"))
                .with_help("a film in air, as of a bubble, is glass of `ior = 1` with a thin film"));
        }
        let index = IndexKeys {
            ior: self.ior.as_ref(),
            abbe_number: self.abbe_number.as_ref(),
            cauchy: self.cauchy.as_ref(),
            sellmeier: self.sellmeier.as_ref(),
        };
        let (ior, dispersion) = index.resolve(resolver)?;
        if let (Some((name, place)), true) = (index.place(), self.thin) {
            return Err(resolver.error(place, format!("`{name}` has no effect: a `thin` wall does not bend light")));
        }
        Ok(MaterialKind::Glass {
            ior,
            dispersion,
            reflectance: resolver.colour_or_white(&self.reflectance)?,
            transmittance: resolver.colour_or_white(&self.transmittance)?,
            thin: self.thin,
            film: film.resolve(resolver)?,
        })
    }

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::Glass { ior, reflectance, transmittance, thin, film, dispersion } = kind else { return String::new() };
        let tints = writer.input("reflectance", reflectance) + &writer.input("transmittance", transmittance);
        write_index(*ior, dispersion.as_ref()) + &tints + &flag("thin", *thin) + &write_thin_film(film.as_ref(), writer)
    }
}
