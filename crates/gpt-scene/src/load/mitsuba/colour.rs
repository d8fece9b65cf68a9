//! Colours and spectra as linear Rec.709.

use glam::DVec3;

use super::number::parse_number;
use super::plugin::{PropertyValue, SpectralCurve, error_at};
use super::transform::numbers;
use crate::load::error::SceneError;
use crate::load::place::Origin;
pub use crate::observer::{Role, integrate};
use crate::observer::{between, from_xyz, planck};
use crate::spectrum::Spectrum;

impl SpectralCurve {
    /// The colour in linear Rec.709, without negative parts; a surface's is as bright as it says, which may be above 1.
    pub fn color(&self, role: Role) -> Spectrum {
        let colour = match self {
            // A light of equal energy is not white.
            Self::Uniform(value) if role == Role::Light => from_xyz(DVec3::splat(*value)),
            Self::Uniform(value) => Spectrum::grey(*value),
            Self::Samples(samples) => integrate(role, |wavelength| between(samples, wavelength)),
            Self::BlackBody(kelvin, scale) => integrate(role, |wavelength| scale * planck(wavelength, *kelvin)),
        };
        colour.max(Spectrum::BLACK)
    }
}

fn hex(place: &Origin, text: &str) -> Result<Spectrum, SceneError> {
    let digits = &text[1..];
    let wrong = || error_at(place, format!("expected a colour as #rrggbb, found `{text}`"));
    let number = u32::from_str_radix(digits, 16).map_err(|_| wrong())?;
    if digits.len() != 6 {
        return Err(wrong());
    }
    let channels = [16, 8, 0].map(|shift| ((number >> shift) & 0xff) as u8);
    Ok(decoded(Spectrum::from_rgb(channels.map(|channel| f64::from(channel) / 255.0))))
}

/// sRGB's curve undone.
fn decoded(colour: Spectrum) -> Spectrum {
    let decode = |value: f64| if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) };
    colour.map(decode)
}

/// One number or three.
pub fn parse_rgb(place: &Origin, text: &str) -> Result<Spectrum, SceneError> {
    let text = text.trim();
    if text.starts_with('#') && text.is_ascii() {
        return hex(place, text);
    }
    match numbers(place, text)?[..] {
        [grey] => Ok(Spectrum::grey(grey)),
        [r, g, b] => Ok(Spectrum::new(r, g, b)),
        _ => Err(error_at(place, format!("expected one number or three, found `{text}`"))),
    }
}

pub fn parse_srgb(place: &Origin, text: &str) -> Result<Spectrum, SceneError> {
    if text.trim().starts_with('#') { parse_rgb(place, text) } else { parse_rgb(place, text).map(decoded) }
}

/// One number, three of linear Rec.709, or `wavelength:value` pairs.
pub fn parse_spectrum(place: &Origin, text: &str) -> Result<PropertyValue, SceneError> {
    if !text.contains(':') {
        return match numbers(place, text.trim().trim_start_matches('#'))?[..] {
            [value] if !text.trim().starts_with('#') => Ok(PropertyValue::Spectrum(SpectralCurve::Uniform(value))),
            [r, g, b] => Ok(PropertyValue::Rgb(Spectrum::new(r, g, b))),
            _ => Err(error_at(place, format!("expected a number or wavelength:value pairs, found `{text}`"))),
        };
    }
    let pairs = text.split(|c: char| c == ',' || c.is_whitespace()).filter(|pair| !pair.is_empty());
    let pairs = pairs.map(|pair| {
        let (wavelength, value) =
            pair.split_once(':').ok_or_else(|| error_at(place, format!("expected wavelength:value, found `{pair}`")))?;
        Ok((parse_number(place, wavelength)?, parse_number(place, value)?))
    });
    samples(place, pairs.collect::<Result<_, SceneError>>()?).map(PropertyValue::Spectrum)
}

/// Lines of a wavelength and a value; those that begin with # say nothing.
pub fn parse_spectrum_file(place: &Origin, text: &str) -> Result<SpectralCurve, SceneError> {
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    let pairs = lines.map(|line| match numbers(place, line)?[..] {
        [wavelength, value] => Ok((wavelength, value)),
        _ => Err(error_at(place, format!("expected a wavelength and a value, found `{line}`"))),
    });
    samples(place, pairs.collect::<Result<_, SceneError>>()?)
}

/// Samples in ascending order.
pub fn samples(place: &Origin, pairs: Vec<(f64, f64)>) -> Result<SpectralCurve, SceneError> {
    if pairs.is_empty() || pairs.windows(2).any(|pair| pair[0].0 >= pair[1].0) {
        return Err(error_at(place, "the wavelengths of a spectrum ascend"));
    }
    Ok(SpectralCurve::Samples(pairs))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_white_under_daylight() {
        let white = integrate(Role::Surface, |_| 1.0);
        assert!((white - Spectrum::WHITE).map(f64::abs).max_component() < 1e-12, "{white}");
        // The control: a light of equal energy is reddish beside daylight.
        let light = integrate(Role::Light, |_| 1.0);
        assert!((light - Spectrum::new(1.2048, 0.9484, 0.9087)).map(f64::abs).max_component() < 2e-3, "{light}");
    }

    #[test]
    fn hot_bodies_are_blue_and_cool_ones_red() {
        let colour = |kelvin| SpectralCurve::BlackBody(kelvin, 1.0).color(Role::Light);
        let (warm, cold) = (colour(2800.0), colour(12_000.0));
        assert!(warm.r() > 2.0 * warm.b() && cold.b() > cold.r(), "{warm} {cold}");
    }

    #[test]
    fn colours_are_read_in_every_form() {
        let place = Origin::default();
        assert_eq!(parse_rgb(&place, "0.5").unwrap(), Spectrum::grey(0.5));
        assert_eq!(parse_rgb(&place, "1, 2 3").unwrap(), Spectrum::new(1.0, 2.0, 3.0));
        assert!(parse_srgb(&place, "#ff8000").unwrap().distance(Spectrum::new(1.0, 0.2158605, 0.0)) < 1e-6);
        for bad in ["1 2", "red", "#ff", "#ÿÿÿ", "nan", ""] {
            assert!(parse_rgb(&place, bad).is_err(), "{bad}");
        }
        for bad in ["400:1, 300:2", "400", "400:", ":", "1 2", "#"] {
            let read = parse_spectrum(&place, bad);
            assert!(read.is_err() || bad == "400", "{bad}: {read:?}");
        }
    }
}
