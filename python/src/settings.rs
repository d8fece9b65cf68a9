//! Settings by their names, from the table that scene files and the command line have too.

use gpt::scene::settings::{Assignment, SETTINGS, Setting};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Names, explanations, defaults and values of all settings, in words.
#[pyfunction]
pub fn settings() -> Vec<(&'static str, &'static str, String, String)> {
    let row =
        |setting: &'static Setting| (setting.name, setting.help(), setting.default().to_string(), setting.values.to_string());
    SETTINGS.iter().map(row).collect()
}

/// The values of settings that are written as text.
///
/// # Errors
/// A `ValueError` with the values that are allowed.
pub fn assigned(written: &[(String, String)]) -> PyResult<Vec<Assignment>> {
    let one = |(name, value): &(String, String)| {
        let setting = Setting::find(name).ok_or_else(|| PyValueError::new_err(format!("there is no setting `{name}`")))?;
        setting.text(value).map_err(|expected| PyValueError::new_err(format!("{name}: expected {expected}, not `{value}`")))
    };
    written.iter().map(one).collect()
}
