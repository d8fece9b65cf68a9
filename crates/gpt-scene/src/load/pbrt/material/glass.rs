//! Dielectrics.

use super::Widths;
use crate::load::error::SceneError;
use crate::load::file::material::dispersion::Sellmeier;
use crate::load::file::material::{MaterialEntry, glass, rough_glass};
use crate::load::file::value::{Checked, IndexOfRefraction, Located, Positive, Rule};
use crate::load::pbrt::converter::Converter;
use crate::load::pbrt::named_spectra;
use crate::load::pbrt::parameter::{Entity, Kind};
use crate::load::pbrt::spectrum::{Samples, SpectrumKind, samples};
use crate::observer::between;

/// The lines d, F and C of helium and hydrogen in nanometres, by which Abbe's number is defined.
const LINES: [f64; 3] = [587.56, 486.13, 656.27];

/// An index of refraction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Index {
    Number(f64),
    /// The coefficients b and c of Sellmeier's formula.
    Sellmeier([[f64; 3]; 2]),
    /// The index at the line d, and Abbe's number.
    Abbe(f64, f64),
}

impl Index {
    /// The index at the line d.
    pub fn central(self) -> f64 {
        match self {
            Self::Number(index) | Self::Abbe(index, _) => index,
            Self::Sellmeier(glass) => named_spectra::index(glass, LINES[0]),
        }
    }
}

/// The keys of an index of refraction.
struct IndexKeys {
    ior: Option<Located<Checked<IndexOfRefraction>>>,
    abbe_number: Option<Located<Checked<Positive>>>,
    sellmeier: Option<Located<Sellmeier>>,
}

impl Converter<'_> {
    pub(super) fn glass(&mut self, entity: &Entity) -> Result<MaterialEntry, SceneError> {
        let index = self.index(entity, "eta", 1.5)?;
        let widths = self.widths(entity, "")?;
        self.glass_of(entity, index, widths)
    }

    /// A plate of glass that bends no light.
    pub(super) fn thin_glass(&mut self, entity: &Entity) -> Result<MaterialEntry, SceneError> {
        let index = self.index(entity, "eta", 1.5)?;
        let ior = Some(entity.spot.place().at(entity.possible(Checked::of(index.central()))?));
        Ok(MaterialEntry::from(glass::Keys { ior, thin: true, ..Default::default() }))
    }

    /// Glass of an index of refraction, smooth or rough.
    pub(super) fn glass_of(&mut self, entity: &Entity, index: Index, widths: Widths) -> Result<MaterialEntry, SceneError> {
        let IndexKeys { ior, abbe_number, sellmeier } = index_keys(entity, index)?;
        let is_smooth = widths.are_smooth();
        let Widths { alpha, alpha_u, alpha_v } = widths;
        Ok(if is_smooth {
            MaterialEntry::from(glass::Keys { ior, abbe_number, sellmeier, ..Default::default() })
        } else {
            MaterialEntry::from(rough_glass::Keys { ior, abbe_number, sellmeier, alpha, alpha_u, alpha_v, ..Default::default() })
        })
    }

    /// An index of refraction: a number, a glass by its name, or a spectrum.
    pub(super) fn index(&mut self, entity: &Entity, name: &str, default: f64) -> Result<Index, SceneError> {
        let index = match entity.float(name)? {
            // Zero stands for no change there.
            Some(0.0) => Index::Number(1.0),
            Some(index) => Index::Number(index),
            None => self.spectral_index(entity, name)?.unwrap_or(Index::Number(default)),
        };
        let central = index.central();
        if IndexOfRefraction::accepts(central) {
            return Ok(index);
        }
        Err(entity.spot_of(name).error(format!("`{name}`: expected {}, found {central}", IndexOfRefraction::WORDS)))
    }

    fn spectral_index(&mut self, entity: &Entity, name: &str) -> Result<Option<Index>, SceneError> {
        let Some(parameter) = entity.find(name, &[Kind::Spectrum, Kind::Rgb, Kind::BlackBody]).cloned() else { return Ok(None) };
        if parameter.kind != Kind::Spectrum {
            self.approximate(&parameter.spot, format!("colour for `{name}`"), "the mean of its channels is taken");
            return self.colour_of(&parameter, SpectrumKind::Unbounded).map(|colour| Some(Index::Number(colour.mean())));
        }
        let values = match parameter.texts() {
            [glass] => match named_spectra::glass(glass) {
                Some(glass) => return Ok(Some(Index::Sellmeier(glass))),
                None => self.spectrum_file(&parameter, &glass.clone())?,
            },
            _ => samples(&parameter, parameter.numbers())?,
        };
        let index = of_samples(&values);
        if matches!(index, Index::Abbe(..)) {
            let instead = "it is Cauchy's formula by the index at the line d and Abbe's number";
            self.approximate(&parameter.spot, format!("spectrum of `{name}`"), instead);
        }
        Ok(Some(index))
    }
}

/// The index at the line d of a spectrum, and Abbe's number where it falls with the wavelength.
fn of_samples(samples: &Samples) -> Index {
    let clamped = |wavelength: f64| match samples[..] {
        [(first, value), ..] if wavelength < first => value,
        [.., (last, value)] if wavelength > last => value,
        _ => between(samples, wavelength),
    };
    let [d, f, c] = LINES.map(clamped);
    if f - c > 1e-6 && d > 1.0 { Index::Abbe(d, (d - 1.0) / (f - c)) } else { Index::Number(d) }
}

fn index_keys(entity: &Entity, index: Index) -> Result<IndexKeys, SceneError> {
    let place = entity.spot.place();
    let ior = |index: f64| entity.possible(Checked::of(index)).map(|index| Some(place.at(index)));
    Ok(match index {
        Index::Number(index) => IndexKeys { ior: ior(index)?, abbe_number: None, sellmeier: None },
        Index::Abbe(index, number) => {
            let abbe_number = Some(place.at(entity.possible(Checked::of(number))?));
            IndexKeys { ior: ior(index)?, abbe_number, sellmeier: None }
        }
        Index::Sellmeier([b, c]) => {
            let sellmeier = Some(place.at(entity.possible(Sellmeier::of(b, c))?));
            IndexKeys { ior: None, abbe_number: None, sellmeier }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spectra_of_indices_have_their_abbe_numbers() {
        let glass = named_spectra::glass("glass-BK7").expect("it is known");
        let samples =
            (0..48).map(|step| 360.0 + 10.0 * f64::from(step)).map(|at| (at, named_spectra::index(glass, at))).collect();
        let Index::Abbe(index, number) = of_samples(&samples) else { panic!("it disperses") };
        assert!((index - 1.5168).abs() < 1e-4 && (number - 64.17).abs() < 0.3, "{index} {number}");
        assert_eq!(of_samples(&vec![(400.0, 1.4), (700.0, 1.4)]), Index::Number(1.4), "the control");
    }
}
