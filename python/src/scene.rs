//! Scenes: read, written, and compared on two devices.

use std::path::PathBuf;
use std::time::Duration;

use gpt::choice::Choice;
use gpt::film::Layer;
use gpt::load::{FileLog, LoadOptions, ModelView, SceneError, builtin_names, load_toml_str, load_with};
use gpt::plan::PlanOptions;
use gpt::scene_writer::{as_scene_file, save_scene_beside};
use gpt::{DeviceChoice, IntervalOptions, RenderOptions};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors::{SceneError as SceneErrorRaised, raised};
use crate::process;
use crate::settings::assigned;
use crate::task::Task;
use crate::watching::watched;

/// The path and the content of a file beside a scene file.
type Beside<'py> = (PathBuf, Bound<'py, PyBytes>);

/// A scene that was read.
#[pyclass(frozen, module = "gpt_pathtracer._native")]
pub struct Scene(pub gpt::Scene, FileLog);

impl From<gpt::Scene> for Scene {
    /// A scene that was read from no file that it knows of.
    fn from(scene: gpt::Scene) -> Self {
        Self(scene, FileLog::default())
    }
}

/// The device of this name.
pub fn device_of(name: &str) -> PyResult<DeviceChoice> {
    match name {
        "auto" => Ok(DeviceChoice::Auto),
        "gpu" => Ok(DeviceChoice::Gpu),
        "cpu" => Ok(DeviceChoice::Cpu),
        "" => Err(PyValueError::new_err("device: auto, gpu, cpu, or a part of an adapter's name")),
        name => Ok(DeviceChoice::Named(name.to_owned())),
    }
}

#[pymethods]
impl Scene {
    /// Reads a scene file, a model, a scene of another program, or a built-in scene.
    #[staticmethod]
    #[allow(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn load(
        py: Python<'_>,
        path: PathBuf,
        strict: bool,
        definitions: Vec<(String, String)>,
        camera: Option<String>,
        variant: Option<String>,
        assets_root: Option<PathBuf>,
        environment: Option<PathBuf>,
        projection: Option<String>,
    ) -> PyResult<Self> {
        process::check()?;
        let view = ModelView { environment, ..ModelView::default() };
        let preset = projection.map(|name| named("projection", &name)).transpose()?;
        let log = FileLog::default();
        let options = LoadOptions {
            strict,
            definitions,
            camera,
            variant,
            assets_root,
            view,
            preset,
            log: log.clone(),
            ..LoadOptions::default()
        };
        let load = || {
            let scene = load_with(Some(path.as_os_str()), &options)?;
            match scene.import_report.summary().filter(|_| strict) {
                Some(summary) => Err(SceneError::in_file(&scene.name, summary)),
                None => Ok(scene),
            }
        };
        py.detach(load).map(|scene| Self(scene, log)).map_err(|error| raised(error.into()))
    }

    /// Reads the text of a scene file.
    #[staticmethod]
    fn from_toml(py: Python<'_>, text: &str, folder: PathBuf) -> PyResult<Self> {
        process::check()?;
        py.detach(|| load_toml_str(text, "scene", &folder)).map(Self::from).map_err(|error| raised(error.into()))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    #[getter]
    fn size(&self) -> (u32, u32) {
        let [width, height] = self.0.film.size;
        (width, height)
    }

    #[getter]
    fn spp(&self) -> u32 {
        self.0.render.spp
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        let precision = self.0.precision_warnings();
        self.0.warnings.iter().chain(&precision).cloned().chain(self.0.import_report.summary()).collect()
    }

    /// The scene at a frame of its keyframes.
    fn at_frame(&self, py: Python<'_>, frame: f64) -> PyResult<Self> {
        let moved = py.detach(|| self.0.at_frame(frame));
        moved
            .map(|scene| Self(scene, self.1.clone()))
            .map_err(|error| raised(SceneError::in_file(&self.0.name, error.to_string()).into()))
    }

    /// A render of it with these keywords, which can be wrong.
    #[allow(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn task(
        &self,
        size: Option<(u32, u32)>,
        device: &str,
        layers: Vec<String>,
        time_limit: Option<f64>,
        target_error: Option<f64>,
        adaptive: bool,
        intervals: (Option<f64>, Option<f64>, Option<String>, Option<String>),
        part: (u32, Option<(u32, u32, u32, u32)>),
        settings: Vec<(String, String)>,
    ) -> PyResult<Task> {
        let settings = assigned(&settings)?;
        let (first_sample, crop) = part;
        let layers = layers.iter().map(|name| layer_of(name)).collect::<PyResult<Vec<_>>>()?;
        let options = RenderOptions {
            device: device_of(device)?,
            time_limit: time_limit.map(seconds).transpose()?,
            target_error,
            adaptive,
            first_sample,
            crop: crop.map(|(x, y, columns, rows)| [x, y, columns, rows]),
            interval: interval_of(intervals, &layers)?,
            ..RenderOptions::default()
        };
        let mut scene = self.0.clone();
        scene.film.size = size.map_or(scene.film.size, |(width, height)| [width, height]);
        settings.iter().for_each(|setting| setting.apply(&mut scene.render));
        scene.render.check().map_err(|bad| PyValueError::new_err(bad.to_string()))?;
        if let Some(interval) = &options.interval {
            interval.apply(&mut scene.render);
        }
        if let Some(message) = options.contradiction(&scene) {
            return Err(PyValueError::new_err(message));
        }
        Ok(Task { scene, options, layers })
    }

    /// The scene as a scene file at this path would be, and the paths and contents of the files beside it.
    fn written<'py>(&self, py: Python<'py>, path: PathBuf) -> PyResult<(String, Vec<Beside<'py>>)> {
        let written = py.detach(|| as_scene_file(&self.0, &path)).map_err(not_written)?;
        let text = String::from_utf8(written.content).map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok((text, written.files.into_iter().map(|(path, content)| (path, PyBytes::new(py, &content))).collect()))
    }

    /// Writes it as a scene file, with files beside it; the paths of all that were written.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<Vec<PathBuf>> {
        process::check()?;
        py.detach(|| save_scene_beside(&self.0, &path, &self.1)).map_err(not_written)
    }
}

/// Why a scene was not written: the scene's fault, or the file system's.
fn not_written(error: gpt::output::OutputError) -> PyErr {
    match error {
        gpt::output::OutputError::Encode { what, .. } => SceneErrorRaised::new_err(what),
        error => raised(error.into()),
    }
}

fn seconds(seconds: f64) -> PyResult<Duration> {
    let limit = Duration::try_from_secs_f64(seconds).ok().filter(|limit| !limit.is_zero());
    limit.ok_or_else(|| PyValueError::new_err("time_limit: a number of seconds above 0"))
}

/// The intervals that are asked for, by a target and as layers.
fn interval_of(
    (target, confidence, of, by): (Option<f64>, Option<f64>, Option<String>, Option<String>),
    wanted: &[Layer],
) -> PyResult<Option<IntervalOptions>> {
    let layers = wanted.iter().any(|layer| matches!(layer, Layer::Low | Layer::High));
    if target.is_none() && !layers {
        let is_lonely = confidence.is_some() || of.is_some() || by.is_some();
        let what = "confidence, interval_of and interval_by belong to target_interval, or to the layers low and high";
        return if is_lonely { Err(PyValueError::new_err(what)) } else { Ok(None) };
    }
    let default = IntervalOptions::default();
    Ok(Some(IntervalOptions {
        target,
        confidence: confidence.unwrap_or(default.confidence),
        of: of.map(|name| named("interval_of", &name)).transpose()?.unwrap_or(default.of),
        by: by.map(|name| named("interval_by", &name)).transpose()?,
        layers,
    }))
}

/// A choice by its name.
pub fn named<T: Choice>(what: &str, name: &str) -> PyResult<T> {
    let names = || T::NAMES.iter().map(|named| named.name).collect::<Vec<_>>().join(", ");
    T::from_name(name).ok_or_else(|| PyValueError::new_err(format!("{what}: there is no `{name}`; there are {}", names())))
}

fn layer_of(name: &str) -> PyResult<Layer> {
    Layer::from_name(name).ok_or_else(|| {
        let names: Vec<&str> = Layer::ALL.iter().map(|layer| layer.name()).collect();
        PyValueError::new_err(format!("there is no layer `{name}`; there are {}", names.join(", ")))
    })
}

/// Whether a device and the CPU reference agree on a scene, as JSON.
#[pyfunction]
pub fn verify(py: Python<'_>, scene: &Scene, size: Option<(u32, u32)>, spp: Option<u32>, device: &str) -> PyResult<String> {
    process::check()?;
    let choice = device_of(device)?;
    let mut scene = scene.0.clone();
    scene.render.spp = spp.unwrap_or(gpt::verify::DEFAULT_SPP);
    match size {
        Some((width, height)) => scene.film.size = [width, height],
        None => gpt::verify::shrink(&mut scene, gpt::verify::DEFAULT_SIDE),
    }
    let options = PlanOptions::default();
    let verdict = watched(py, None, |watcher| gpt::verify::verify_watched(&scene, &choice, &options, watcher))?;
    text(serde_json::to_string(&verdict.map_err(|error| raised(error.into()))?))
}

/// The text of JSON.
pub fn text(json: serde_json::Result<String>) -> PyResult<String> {
    json.map_err(|error| PyValueError::new_err(error.to_string()))
}

/// Names of the scenes that are part of the program.
#[pyfunction]
pub fn builtin_scenes() -> Vec<&'static str> {
    builtin_names().collect()
}
