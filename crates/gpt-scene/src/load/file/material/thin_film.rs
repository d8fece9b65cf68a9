//! Keys of thin films.

use crate::load::error::SceneError;
use crate::load::file::colour::Scalar;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, FilmIndex, Located, NonNegative};
use crate::load::file::writer::{Writer, line, number};
use crate::load::place::Place;
use crate::scene::ThinFilm;

/// Index of refraction of a film where none is written.
const IOR: f64 = 1.3;

/// All keys of a thin film.
pub struct ThinFilmKeys<'a> {
    pub thickness: Option<&'a Located<Scalar<NonNegative>>>,
    pub offset: Option<&'a Located<Checked<NonNegative>>>,
    pub ior: Option<&'a Located<Checked<FilmIndex>>>,
}

impl ThinFilmKeys<'_> {
    /// None where there is no film.
    pub fn resolve(&self, resolver: &Resolver<'_>) -> Result<Option<ThinFilm>, SceneError> {
        let Some(thickness) = self.thickness else {
            return match self.place() {
                Some((name, place)) => Err(resolver.error(place, format!("`{name}` needs the key `thin_film_thickness`"))),
                None => Ok(None),
            };
        };
        let film = ThinFilm {
            thickness: resolver.scalar(&thickness.value)?,
            offset: self.offset.map_or(0.0, |offset| offset.value.0),
            ior: self.ior.map_or(IOR, |ior| ior.value.0),
        };
        Ok(Some(film).filter(|film| !film.is_none()))
    }

    /// One of the keys that is written, and where.
    pub fn place(&self) -> Option<(&'static str, &Place)> {
        let thickness = self.thickness.map(|key| ("thin_film_thickness", &key.place));
        let offset = self.offset.map(|key| ("thin_film_offset", &key.place));
        thickness.or(offset).or(self.ior.map(|key| ("thin_film_ior", &key.place)))
    }
}

/// The keys of a film.
pub fn write_thin_film(film: Option<&ThinFilm>, writer: &Writer<'_>) -> String {
    let Some(ThinFilm { thickness, offset, ior }) = film else { return String::new() };
    let offset = if *offset == 0.0 { String::new() } else { line("thin_film_offset", &number(*offset)) };
    writer.input("thin_film_thickness", thickness) + &offset + &line("thin_film_ior", &number(*ior))
}
