//! Plugins of sampled spectra.

use super::colour::samples;
use super::plugin::{Plugin, SpectralCurve};
use super::transform::numbers;
use crate::load::error::SceneError;

/// `regular` and `irregular`.
pub fn sampled(plugin: &Plugin) -> Result<SpectralCurve, SceneError> {
    let list = |name: &str| -> Result<Vec<f64>, SceneError> {
        let text = plugin.text(name)?.ok_or_else(|| plugin.error(format!("{} needs the string `{name}`", plugin.title())))?;
        numbers(&plugin.place, text)
    };
    let values = list("values")?;
    let wavelengths = if plugin.name == "irregular" {
        list("wavelengths")?
    } else {
        let (low, high) = (plugin.number_or("wavelength_min", 360.0)?, plugin.number_or("wavelength_max", 830.0)?);
        let steps = values.len().saturating_sub(1).max(1) as f64;
        (0..values.len()).map(|index| low + (high - low) * index as f64 / steps).collect()
    };
    if wavelengths.len() != values.len() {
        let message = format!("there are {} values for {} wavelengths", values.len(), wavelengths.len());
        return Err(plugin.error(message));
    }
    samples(&plugin.place, wavelengths.into_iter().zip(values).collect())
}
