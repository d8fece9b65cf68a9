//! Keys of indices of refraction that depend on the wavelength.

use schemars::JsonSchema;
use serde::Deserialize;

use super::keys::ior_or_default;
use crate::load::error::SceneError;
use crate::load::file::reference::NamesTextures;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, IndexOfRefraction, Located, Positive, Rule, Vector};
use crate::load::file::writer::{line, number, numbers};
use crate::load::place::Place;
use crate::scene::Dispersion;

/// Coefficients of Sellmeier's formula n² = 1 + Σ bᵢ·λ²/(λ² − cᵢ), λ in micrometres.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table with the keys `b` and `c`")]
pub struct Sellmeier {
    /// Without a unit.
    b: Vector,
    /// Square micrometres.
    c: Vector,
}

impl NamesTextures for Sellmeier {}

impl Sellmeier {
    /// These coefficients, c in square micrometres.
    ///
    /// # Errors
    /// A sentence about a number that is out of range.
    pub fn of(b: [f64; 3], c: [f64; 3]) -> Result<Self, String> {
        Ok(Self { b: Vector::of(b)?, c: Vector::of(c)? })
    }
}

/// All keys of an index of refraction.
pub struct IndexKeys<'a> {
    pub ior: Option<&'a Located<Checked<IndexOfRefraction>>>,
    pub abbe_number: Option<&'a Located<Checked<Positive>>>,
    pub cauchy: Option<&'a Located<Vector>>,
    pub sellmeier: Option<&'a Located<Sellmeier>>,
}

impl IndexKeys<'_> {
    /// The index at the line d, and how it depends on the wavelength.
    pub fn resolve(&self, resolver: &Resolver<'_>) -> Result<(f64, Option<Dispersion>), SceneError> {
        let formulas = [self.cauchy.map(|key| &key.place), self.sellmeier.map(|key| &key.place)];
        let others = [self.abbe_number.map(|key| &key.place), self.ior.map(|key| &key.place)];
        let mut said = formulas.into_iter().flatten();
        if said.next().is_some()
            && let Some(other) = said.next().or(others.into_iter().flatten().next())
        {
            return Err(resolver.error(other, "either `ior`, perhaps with `abbe_number`, or `cauchy`, or `sellmeier`"));
        }
        let written = ior_or_default(self.ior.map(|ior| ior.value));
        let values = |list: &Vector| list.0.map(|value| value.0);
        let (dispersion, place) = match (self.abbe_number, self.cauchy, self.sellmeier) {
            (Some(key), _, _) => (Dispersion::Abbe(key.value.0), &key.place),
            (_, Some(key), _) => (Dispersion::Cauchy(values(&key.value)), &key.place),
            (_, _, Some(key)) => (Dispersion::Sellmeier { b: values(&key.value.b), c: values(&key.value.c) }, &key.place),
            (None, None, None) => return Ok((written, None)),
        };
        let central = dispersion.central().unwrap_or(written);
        let channels = dispersion.channels(central).to_rgb();
        match [central].into_iter().chain(channels).find(|index| !IndexOfRefraction::accepts(*index)) {
            Some(index) => {
                let message = format!("expected {} at all visible wavelengths, found {index}", IndexOfRefraction::WORDS);
                Err(resolver.error(place, message))
            }
            None => Ok((central, Some(dispersion))),
        }
    }

    /// One of the keys of dispersion that is written, and where.
    pub fn place(&self) -> Option<(&'static str, &Place)> {
        let abbe_number = self.abbe_number.map(|key| ("abbe_number", &key.place));
        let cauchy = self.cauchy.map(|key| ("cauchy", &key.place));
        abbe_number.or(cauchy).or(self.sellmeier.map(|key| ("sellmeier", &key.place)))
    }
}

/// The keys of an index of refraction.
pub fn write_index(ior: f64, dispersion: Option<&Dispersion>) -> String {
    match dispersion {
        None => line("ior", &number(ior)),
        Some(Dispersion::Abbe(abbe)) => line("ior", &number(ior)) + &line("abbe_number", &number(*abbe)),
        Some(Dispersion::Cauchy(terms)) => line("cauchy", &numbers(terms)),
        Some(Dispersion::Sellmeier { b, c }) => line("sellmeier", &format!("{{ b = {}, c = {} }}", numbers(b), numbers(c))),
    }
}
