//! A render that is asked for: once, at several frames, or with pictures on the way.

use std::collections::BTreeMap;
use std::time::Duration;

use gpt::film::Layer;
use gpt::learn::{Effort, Pace, with_lights_settled};
use gpt::load::SceneError;
use gpt::output::LayerChannel;
use gpt::render::cryptomatte;
use gpt::render::frames::FrameList;
use gpt::render::layers::{notes_of_groups, render_layers};
use gpt::render::stats::Stats;
use gpt::{Observer, RenderOptions, Renderer};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::array::Array;
use crate::errors::raised;
use crate::layers::{arrays, names};
use crate::looks::Looks;
use crate::picture::Picture;
use crate::pictures::{Message, Pictures};
use crate::process;
use crate::scene::text;
use crate::watching::watched;

/// A scene and how it is rendered.
#[pyclass(frozen, module = "gpt_pathtracer._native")]
#[derive(Clone)]
pub struct Task {
    pub scene: gpt::Scene,
    pub options: RenderOptions,
    pub layers: Vec<Layer>,
}

/// A picture, its layers by channel, its light groups, and what the render did, as JSON.
#[pyclass(frozen, get_all, module = "gpt_pathtracer._native")]
pub struct Rendered {
    pub picture: Py<Picture>,
    pub layers: BTreeMap<String, Py<Array>>,
    /// Names of the layers' channels in EXR files, each with its layer's; those of a layer in the order of its array.
    pub channels: Vec<(String, String)>,
    /// Names of the layers as they were asked for, with commas.
    pub layer_list: String,
    pub groups: Vec<String>,
    /// Entries of the header of an EXR file.
    pub notes: Vec<(String, String)>,
    pub stats: String,
}

/// A finished render that Python does not have yet.
pub struct Finished {
    pub image: gpt::Image,
    pub channels: Vec<LayerChannel>,
    pub layers: Vec<Layer>,
    pub groups: Vec<String>,
    pub notes: Vec<(String, String)>,
    pub stats: serde_json::Result<String>,
}

impl Finished {
    /// Gives it to Python.
    pub fn rendered(self, py: Python<'_>) -> PyResult<Rendered> {
        let layers = py.detach(|| arrays(&self.channels, &self.image))?;
        let layers = layers.into_iter().map(|(name, array)| Ok((name, Py::new(py, array)?))).collect::<PyResult<_>>()?;
        Ok(Rendered {
            picture: Py::new(py, Picture(self.image))?,
            layers,
            channels: names(&self.channels),
            layer_list: Layer::list(&self.layers),
            groups: self.groups,
            notes: self.notes,
            stats: text(self.stats)?,
        })
    }
}

impl Task {
    /// Renders with what is ready for the scene. `watcher` sees the layers, `looker` the picture.
    fn finish(
        &self,
        (scene, frame): (&gpt::Scene, Option<f64>),
        renderer: &mut Renderer,
        watcher: &dyn Observer,
        looker: &dyn Observer,
    ) -> Result<Finished, gpt::Error> {
        let none = &mut |_: &Renderer, _: &_| Ok::<_, gpt::Error>(None);
        let channels = render_layers(scene, &self.options, (&self.layers, false), watcher, none)?;
        let image = renderer.image(looker)?;
        let mut stats = Stats::of_image(&image, scene, &self.options);
        if let Some(stats) = &mut stats {
            stats.notice = renderer.notice().map(str::to_owned);
            stats.frame = frame;
        }
        let has_groups = self.layers.contains(&Layer::Groups);
        let groups = if has_groups { scene.light_group_names().into_iter().map(str::to_owned).collect() } else { Vec::new() };
        let mut notes = if self.layers.contains(&Layer::Cryptomatte) { cryptomatte::notes(scene) } else { Vec::new() };
        if has_groups {
            notes.extend(notes_of_groups(scene));
        }
        let stats = serde_json::to_string(&stats);
        Ok(Finished { image, channels: channels.unwrap_or_default(), layers: self.layers.clone(), groups, notes, stats })
    }
}

#[pymethods]
impl Task {
    /// Renders it whole.
    fn render(&self, py: Python<'_>, progress: Option<Py<PyAny>>) -> PyResult<Rendered> {
        process::check()?;
        let finished = watched(py, progress.as_ref(), |watcher| {
            // First, because it finds what is wrong with the options.
            let mut renderer = Renderer::new(&self.scene, &self.options)?;
            self.finish((&self.scene, None), &mut renderer, watcher, watcher)
        })?;
        finished.map_err(raised)?.rendered(py)
    }

    /// Finds what is wrong with frames before any of them is rendered.
    fn check_frames(&self, frames: Vec<f64>) -> PyResult<()> {
        if self.scene.animation.is_empty() {
            return Err(PyValueError::new_err("the scene has no keyframes, so all of its frames would be the same"));
        }
        let no_number = frames.into_iter().find(|frame| !frame.is_finite());
        no_number.map_or(Ok(()), |frame| at(&self.scene, frame).map(drop)).map_err(|error| raised(error.into()))
    }

    /// Renders frames of its keyframes one after the other, on a device that stays open.
    fn frames(&self, frames: Vec<f64>, progress: Option<Py<PyAny>>) -> PyResult<Pictures> {
        process::check()?;
        let task = self.clone();
        Pictures::begin(progress, move |watcher, hands_over| {
            // All frames draw from lights in the same way, whichever of them are rendered.
            let effort = Effort { pace: Pace::Processor, time_limit: task.options.time_limit };
            let rest = with_lights_settled(&task.scene, effort)?;
            let mut before: Option<(Renderer, gpt::Scene)> = None;
            for frame in frames {
                let scene = at(&rest, frame)?;
                let mut renderer = match before.take() {
                    Some((renderer, before)) => renderer.at_frame(&before, &scene)?,
                    None => Renderer::new(&scene, &task.options)?,
                };
                let finished = task.finish((&scene, Some(frame)), &mut renderer, watcher, watcher)?;
                if watcher.stop_requested() || hands_over(Message::Finished(Box::new(finished))).is_err() {
                    break;
                }
                before = Some((renderer, scene));
            }
            Ok(())
        })
    }

    /// Finds what is wrong with the time between two pictures.
    #[staticmethod]
    fn check_seconds(seconds: f64) -> PyResult<()> {
        duration(seconds).map(drop)
    }

    /// Renders it once, with pictures on the way, each at least so many seconds after the one before.
    fn progressively(&self, seconds: f64, progress: Option<Py<PyAny>>) -> PyResult<Pictures> {
        process::check()?;
        let every = duration(seconds)?;
        let task = self.clone();
        Pictures::begin(progress, move |watcher, hands_over| {
            let mut renderer = Renderer::new(&task.scene, &task.options)?;
            let looks = Looks::new(watcher, hands_over, (&task.scene, renderer.device(), renderer.size()), every);
            let finished = task.finish((&task.scene, None), &mut renderer, watcher, &looks)?;
            // Whoever does not listen any more needs no picture.
            let _ = hands_over(Message::Finished(Box::new(finished)));
            Ok(())
        })
    }
}

/// The scene at a frame of its keyframes.
fn at(scene: &gpt::Scene, frame: f64) -> Result<gpt::Scene, SceneError> {
    scene.at_frame(frame).map_err(|error| SceneError::in_file(&scene.name, error.to_string()))
}

fn duration(seconds: f64) -> PyResult<Duration> {
    Duration::try_from_secs_f64(seconds).map_err(|_| PyValueError::new_err("seconds: a number that is not below 0"))
}

/// Numbers of frames as people write them: `1-100`, `1-100x5`, `1,5,20-30`.
#[pyfunction]
pub fn frame_list(text: &str) -> PyResult<Vec<u32>> {
    FrameList::parse(text).map(|FrameList(frames)| frames).map_err(PyValueError::new_err)
}
