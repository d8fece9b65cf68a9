//! Colours and spectra as linear Rec.709.
//!
//! A light's `rgb` is multiplied there by the spectrum of the colour space's white, and the light is divided by the photometric value of its spectrum, that
//! of the white alone where it is an `rgb`. The film weighs what arrives by the same curves. So the numbers of an `rgb` are those of the picture, and every
//! other spectrum of a light has the luminance 1 whatever its values are.

use super::converter::Converter;
use super::named_spectra;
use super::parameter::{Entity, Kind, Parameter};
use crate::load::encoding;
use crate::load::error::{SceneError, show};
use crate::load::files::MOST_LIBRARY_BYTES;
use crate::observer::{Role, between, integrate, planck};
use crate::spectrum::Spectrum;

/// The content of a spectrum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpectrumKind {
    /// A share of light, from 0 to 1.
    Albedo,
    /// Any amount of something else.
    Unbounded,
    /// Light that leaves something.
    Illuminant,
}

/// The types of spectra.
pub const SPECTRA: [Kind; 3] = [Kind::Rgb, Kind::Spectrum, Kind::BlackBody];

/// Values at wavelengths in nanometres.
pub type Samples = Vec<(f64, f64)>;

impl Converter<'_> {
    /// The colour of a parameter that is a spectrum; None where it is not written.
    pub fn spectrum(&mut self, entity: &Entity, name: &str, kind: SpectrumKind) -> Result<Option<Spectrum>, SceneError> {
        let Some(parameter) = entity.find(name, &SPECTRA).cloned() else { return Ok(None) };
        self.colour_of(&parameter, kind).map(Some)
    }

    /// The colour of a parameter of one of the types of spectra, without negative parts.
    pub fn colour_of(&mut self, parameter: &Parameter, kind: SpectrumKind) -> Result<Spectrum, SceneError> {
        let colour = match parameter.kind {
            Kind::Rgb => self.rgb(parameter, kind)?,
            Kind::BlackBody => black_body(parameter, kind)?,
            _ => match parameter.texts() {
                [] => of_samples(&samples(parameter, parameter.numbers())?, kind),
                [name] => self.named_spectrum(parameter, name, kind)?,
                _ => return Err(parameter.spot.error("a spectrum has one name")),
            },
        };
        Ok(colour.max(Spectrum::BLACK))
    }

    fn rgb(&mut self, parameter: &Parameter, kind: SpectrumKind) -> Result<Spectrum, SceneError> {
        let Parameter { name, spot, .. } = parameter;
        let &[red, green, blue] = parameter.numbers() else {
            return Err(spot.error(format!("`{name}` has {} numbers where it should have 3", parameter.numbers().len())));
        };
        let rgb = [red, green, blue];
        if rgb.iter().any(|channel| *channel < 0.0) {
            return Err(spot.error(format!("`{name}` has a number below 0")));
        }
        if kind == SpectrumKind::Albedo && rgb.iter().any(|channel| *channel > 1.0) {
            return Err(spot.error(format!("`{name}` has a number above 1, and a reflectance has none")));
        }
        Ok(parameter.space.to_rec_709(rgb))
    }

    fn named_spectrum(&mut self, parameter: &Parameter, name: &str, kind: SpectrumKind) -> Result<Spectrum, SceneError> {
        if let Some(colour) = named_spectra::illuminant(name) {
            return Ok(colour);
        }
        if let Some(glass) = named_spectra::glass(name) {
            return Ok(integrated(kind, |wavelength| named_spectra::index(glass, wavelength)));
        }
        for part in ["eta", "k"] {
            if let Some(metal) = named_spectra::metal(name, part) {
                let (eta, k) = self.constants_of(metal);
                return Ok(if part == "eta" { eta } else { k });
            }
        }
        Ok(of_samples(&self.spectrum_file(parameter, name)?, kind))
    }

    /// A file of wavelengths and values, one of each behind the other.
    pub fn spectrum_file(&mut self, parameter: &Parameter, name: &str) -> Result<Samples, SceneError> {
        let path = self.files.find(&self.folder, name).map(|found| found.path);
        let Some(path) = path else {
            let what = if named_spectra::is_name(name) { "spectrum" } else { "spectrum and no file" };
            return Err(parameter.spot.error(format!("there is no {what} `{name}`")));
        };
        let refused = |reason: String| parameter.spot.error(format!("{}: {reason}", show(&path)));
        let bytes = self.files.read(&path, MOST_LIBRARY_BYTES).map_err(|error| refused(format!("cannot be read: {error}")))?;
        let (text, _) = encoding::decode(&bytes);
        let lines = text.lines().map(|line| line.split('#').next().unwrap_or_default());
        let words = lines.flat_map(str::split_ascii_whitespace);
        let numbers = words.map(|word| super::parameter::number(word).ok_or_else(|| refused(format!("`{word}` is no number"))));
        samples(parameter, &numbers.collect::<Result<Vec<f64>, SceneError>>()?)
    }
}

/// Pairs of a wavelength and a value, in ascending order.
pub fn samples(parameter: &Parameter, numbers: &[f64]) -> Result<Samples, SceneError> {
    let Parameter { name, spot, .. } = parameter;
    if numbers.is_empty() || !numbers.len().is_multiple_of(2) {
        return Err(
            spot.error(format!("the spectrum `{name}` is pairs of a wavelength and a value, and has {} numbers", numbers.len()))
        );
    }
    let pairs: Samples = numbers.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect();
    if pairs.windows(2).any(|pair| pair[0].0 >= pair[1].0) {
        return Err(spot.error(format!("the wavelengths of the spectrum `{name}` do not ascend")));
    }
    Ok(pairs)
}

fn of_samples(samples: &Samples, kind: SpectrumKind) -> Spectrum {
    integrated(kind, |wavelength| between(samples, wavelength))
}

fn integrated(kind: SpectrumKind, value: impl Fn(f64) -> f64) -> Spectrum {
    match kind {
        SpectrumKind::Illuminant => {
            let colour = integrate(Role::Light, value);
            let luminance = colour.luminance();
            if luminance > 0.0 { colour / luminance } else { Spectrum::BLACK }
        }
        SpectrumKind::Albedo | SpectrumKind::Unbounded => integrate(Role::Surface, value),
    }
}

fn black_body(parameter: &Parameter, kind: SpectrumKind) -> Result<Spectrum, SceneError> {
    let &[kelvin, ..] = parameter.numbers() else { return Ok(Spectrum::BLACK) };
    // Versions before 4 had a factor behind the temperature.
    if parameter.numbers().len() != 1 {
        return Err(parameter.spot.error("a blackbody has one number, its temperature in kelvin"));
    }
    if !(kelvin > 0.0 && kelvin <= 1e6) {
        return Err(parameter
            .spot
            .error(format!("a blackbody has a temperature above 0, at most 1000000 kelvin, and not {kelvin}")));
    }
    // Its largest value is 1 there; Wien's law says where.
    let most = planck(2_897_772.1 / kelvin, kelvin);
    Ok(integrated(kind, |wavelength| planck(wavelength, kelvin) / most))
}
