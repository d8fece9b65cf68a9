//! `type = "glass"`

use super::keys::{MaterialKeys, ior_or_default, material_keys};
use super::thin_film::{ThinFilmKeys, write_thin_film};
use crate::load::error::SceneError;
use crate::load::file::colour::{Colour, Scalar};
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, FilmIndex, Fraction, IndexOfRefraction, Located, NonNegative};
use crate::load::file::writer::{Writer, flag, line, number};
use crate::scene::MaterialKind;

material_keys! {
    /// A smooth dielectric with exact Fresnel equations.
    #[schemars(extend("allOf" = [
        { "dependentRequired": { "thin_film_offset": ["thin_film_thickness"], "thin_film_ior": ["thin_film_thickness"] } },
        { "not": { "required": ["thin_film_thickness", "thin"], "properties": { "thin": { "const": true } } } },
    ]))]
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
        Ok(MaterialKind::Glass {
            ior: ior_or_default(self.ior),
            reflectance: resolver.colour_or_white(&self.reflectance)?,
            transmittance: resolver.colour_or_white(&self.transmittance)?,
            thin: self.thin,
            film: film.resolve(resolver)?,
        })
    }

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::Glass { ior, reflectance, transmittance, thin, film } = kind else { return String::new() };
        let tints = writer.input("reflectance", reflectance) + &writer.input("transmittance", transmittance);
        line("ior", &number(*ior)) + &tints + &flag("thin", *thin) + &write_thin_film(film.as_ref(), writer)
    }
}
