//! Readings of a scene's meters.

use gpt::plan::PlanOptions;
use gpt::render::measure::{MOST_SAMPLES, chosen, measure};
use gpt::{IntervalOptions, RenderOptions};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::raised;
use crate::process;
use crate::scene::{Scene, device_of, named};
use crate::watching::watched;

/// Readings of the meters of these names, of all meters where none is named, as JSON; each until half its interval is `target` of its value.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "they are keywords in Python")]
#[pyo3(name = "measure")]
pub fn measured(
    py: Python<'_>,
    scene: &Scene,
    meters: Vec<String>,
    target: f64,
    confidence: Option<f64>,
    interval_by: Option<String>,
    spp: Option<u32>,
    seed: Option<u32>,
    device: &str,
) -> PyResult<String> {
    process::check()?;
    let default = IntervalOptions::default();
    let interval = IntervalOptions {
        target: Some(target),
        confidence: confidence.unwrap_or(default.confidence),
        by: interval_by.map(|name| named("interval_by", &name)).transpose()?,
        ..default
    };
    let options = RenderOptions {
        device: device_of(device)?,
        samples: Some(spp.unwrap_or(MOST_SAMPLES)),
        seed,
        interval: Some(interval),
        plan: PlanOptions::default(),
        ..RenderOptions::default()
    };
    let chosen = chosen(&scene.0, &meters).map_err(PyValueError::new_err)?;
    let read = watched(py, None, |watcher| {
        chosen.into_iter().map(|meter| measure(&scene.0, meter, &options, watcher)).collect::<Result<Vec<_>, _>>()
    })?;
    serde_json::to_string(&read.map_err(raised)?).map_err(|error| PyValueError::new_err(error.to_string()))
}
