//! One scene, several settings: how the error falls with samples and with time.

use std::path::PathBuf;
use std::rc::Rc;

use serde::Serialize;

use super::analysis::{self, Comparison, Curve, METRICS, interpolate};
use super::denoised::DenoisedSubject;
use super::interval::Spread;
use super::reference::{OwnError, Reference, Store};
use super::schedule::{Observations, SampleSchedule, observe_schedule};
use super::setting::{Axes, Variant};
use super::subject::{BenchError, Devices, SceneSubject, Subject};
use crate::compare::compare;
use crate::denoise::library::Library;
use crate::film::KernelLayer;
use crate::output::Image;
use crate::renderer::Observer;
use crate::scene::{self, Scene};

/// The options of a convergence measurement.
#[derive(Debug, Clone)]
pub struct ConvergenceOptions {
    pub axes: Axes,
    pub schedule: SampleSchedule,
    /// None: made, or found among those made before.
    pub reference: Option<PathBuf>,
    /// Samples per pixel of a reference that is made.
    pub reference_spp: u32,
    /// The folder of references that were rendered.
    pub store: PathBuf,
}

/// The results of one scene.
#[derive(Debug, Clone, Serialize)]
pub struct SceneConvergence {
    pub scene: String,
    pub scene_hash: String,
    pub width: u32,
    pub height: u32,
    /// Path edges at most; 0: no limit.
    pub max_depth: u32,
    pub replications: usize,
    pub reference: ReferenceSummary,
    /// The first is the baseline of all comparisons.
    pub settings: Vec<SettingConvergence>,
    /// Seconds for which the pictures were made; the shortest of the settings' last levels.
    pub equal_time: f64,
    /// The measurement was stopped before all replications were done.
    pub interrupted: bool,
    #[serde(skip)]
    pub reference_picture: Image,
}

/// The reference that errors were measured against.
#[derive(Debug, Clone, Serialize)]
pub struct ReferenceSummary {
    pub origin: String,
    pub spp: Option<u32>,
    /// None: unknown.
    pub own_error: Option<OwnError>,
}

/// One setting of a scene.
#[derive(Debug, Clone, Serialize)]
pub struct SettingConvergence {
    pub setting: String,
    pub device: String,
    pub build_seconds: f64,
    pub compile_seconds: f64,
    #[serde(flatten)]
    pub curve: Curve,
    /// Against the first setting, by each metric; none for the first itself.
    pub against_first: Vec<Comparison>,
    pub at_equal_time: Option<EqualTimePicture>,
    /// Every picture's figures, for tables of one's own.
    #[serde(skip)]
    pub observations: Observations,
}

/// A picture of as many samples as fit the equal time.
#[derive(Debug, Clone, Serialize)]
pub struct EqualTimePicture {
    pub spp: u32,
    /// Time that the render took.
    pub seconds: f64,
    pub mse: f64,
    pub relmse: f64,
    #[serde(skip)]
    pub picture: Image,
}

/// Measures one scene; `say` is told what is going on.
///
/// # Errors
/// Errors of devices and files, a reference that does not fit, and [`BenchError::Interrupted`] where nothing can be said yet.
pub fn measure(
    scene: &Scene,
    options: &ConvergenceOptions,
    devices: &mut Devices,
    observer: &dyn Observer,
    say: &mut dyn FnMut(&str),
) -> Result<SceneConvergence, BenchError> {
    let settings = options.axes.variants(&scene.render);
    // Its absence is reported before anything is rendered.
    let library = if options.axes.denoise.contains(&true) { Some(Rc::new(Library::open()?)) } else { None };
    let reference = reference(scene, &settings[0], options, devices, observer, say)?;
    let mut names = Vec::new();
    let mut subjects: Vec<Box<dyn Subject + '_>> = Vec::new();
    for setting in &settings {
        let mut scene = scene.clone();
        scene.render = setting.render.clone();
        say(&format!("{}: preparing {}", scene.name, setting.name));
        let size = scene.film.size;
        let mut subject = |layer: Option<KernelLayer>| {
            let renderer = devices.prepare_layer(&scene, &setting.device, layer);
            renderer.map(|renderer| SceneSubject { renderer, size, observer })
        };
        let picture = subject(None)?;
        names.push(picture.renderer.device().to_owned());
        subjects.push(match &library {
            Some(library) if setting.denoise => {
                let [albedo, normal] = [subject(Some(KernelLayer::Albedo))?, subject(Some(KernelLayer::Normal))?];
                Box::new(DenoisedSubject { picture, albedo, normal, library: library.clone() })
            }
            _ => Box::new(picture),
        });
    }
    let mut step = |what: &str| say(&format!("{}: {what}", scene.name));
    let (observations, interrupted) = observe_schedule(&mut subjects, &reference, &options.schedule, &mut step)?;

    let equal_time = equal_time(&observations);
    let mut results = Vec::new();
    for (index, (setting, seen)) in settings.iter().zip(&observations).enumerate() {
        let curve = analysis::curve(seen, &reference, &options.schedule);
        let compare = |metric| analysis::compare_settings(seen, &observations[0], &reference, metric);
        let against_first = if index == 0 { Vec::new() } else { METRICS.map(compare).to_vec() };
        let shown =
            if interrupted { None } else { picture_at(subjects[index].as_mut(), &curve, equal_time, &reference, options)? };
        let (build_seconds, compile_seconds) = seen.set_up;
        results.push(SettingConvergence {
            setting: setting.name.clone(),
            device: names[index].clone(),
            build_seconds,
            compile_seconds,
            curve,
            against_first,
            at_equal_time: shown,
            observations: seen.clone(),
        });
    }
    Ok(SceneConvergence {
        scene: scene.name.clone(),
        scene_hash: scene::digest(scene),
        width: scene.film.size[0],
        height: scene.film.size[1],
        max_depth: scene.render.max_depth,
        replications: observations.iter().map(Observations::replications).min().unwrap_or(0),
        reference: ReferenceSummary { origin: reference.origin, spp: reference.spp, own_error: reference.own_error },
        settings: results,
        equal_time,
        interrupted,
        reference_picture: reference.image,
    })
}

/// The given reference, one made before, or a new one: by the scene's own settings, on the first setting's device.
fn reference(
    scene: &Scene,
    first: &Variant,
    options: &ConvergenceOptions,
    devices: &mut Devices,
    observer: &dyn Observer,
    say: &mut dyn FnMut(&str),
) -> Result<Reference, BenchError> {
    if let Some(path) = &options.reference {
        let reference = Reference::from_file(path, scene.film.size)?;
        reference.warnings.iter().for_each(|warning| say(warning));
        return Ok(reference);
    }
    let store = Store { folder: options.store.clone() };
    let renderer = devices.prepare(scene, &first.device)?;
    let device = renderer.device().to_owned();
    let spp = options.reference_spp;
    if let Some(found) = store.find(scene, &device, spp) {
        say(&format!("{}: reference of {spp} spp {}", scene.name, found.origin));
        return Ok(found);
    }
    say(&format!("{}: rendering the reference, {spp} spp", scene.name));
    let mut reference = Reference::render(&mut SceneSubject { renderer, size: scene.film.size, observer }, spp)?;
    if reference.image.pixels.iter().flatten().all(|value| *value == 0.0) {
        return Err(BenchError::UnsuitableReference(format!(
            "{}: the reference is black, so errors mean nothing: does the camera look at the scene, and does light reach what it sees?",
            scene.name
        )));
    }
    // A reference that cannot be kept is made again next time; that is no reason to stop.
    reference.origin = match store.keep(scene, &device, spp, &reference) {
        Ok(path) => format!("rendered, kept in {}", path.display()),
        Err(error) => format!("rendered, not kept: {error}"),
    };
    say(&format!("{}: reference {}", scene.name, reference.origin));
    Ok(reference)
}

/// The shortest of the settings' last levels.
fn equal_time(observations: &[Observations]) -> f64 {
    let last = |seen: &Observations| {
        let seconds: Vec<f64> = seen.by_level.last().into_iter().flatten().map(|one| one.seconds).collect();
        Spread::of(&seconds).median
    };
    observations.iter().map(last).fold(f64::INFINITY, f64::min)
}

/// The picture that a setting makes in so many seconds, or with its fewest samples where it takes longer for these; None where the curve says
/// nothing about so many seconds.
fn picture_at(
    subject: &mut dyn Subject,
    curve: &Curve,
    seconds: f64,
    reference: &Reference,
    options: &ConvergenceOptions,
) -> Result<Option<EqualTimePicture>, BenchError> {
    let points: Vec<(f64, f64)> = curve.levels.iter().map(|level| (level.seconds.median, f64::from(level.spp))).collect();
    let spp = match (interpolate(&points, seconds), points.first()) {
        (Some(spp), _) => spp,
        (None, Some(&(least_seconds, fewest))) if least_seconds > seconds => fewest,
        _ => return Ok(None),
    };
    let spp = (spp.round() as u32).clamp(1, 2 * options.schedule.levels.last().copied().unwrap_or(1));
    let run = match subject.render(options.schedule.seed_of(0, 63, 1), spp) {
        Err(BenchError::Interrupted) => return Ok(None),
        outcome => outcome?,
    };
    let comparison = compare(&run.picture, &reference.image)?;
    Ok(Some(EqualTimePicture {
        spp,
        seconds: run.seconds,
        mse: comparison.mse.all,
        relmse: comparison.relmse.all,
        picture: run.picture,
    }))
}
