//! `gpt bench convergence`.

use gpt::bench::convergence::{ConvergenceOptions, SceneConvergence, measure};
use gpt::bench::machine::Machine;
use gpt::bench::reference::Store;
use gpt::bench::report::{convergence_csv, convergence_page, convergence_text};
use gpt::bench::schedule::SampleSchedule;
use gpt::bench::setting::Axes;
use gpt::bench::subject::{BenchError, Devices};
use gpt::load::{self, LoadOptions};
use gpt::plan::PlanOptions;
use gpt::scene::Scene;
use gpt::verify;
use serde::Serialize;

use super::arguments::ConvergenceArguments;
use super::output::{OnlyStops, Results, command};
use crate::cli::exit::{Exit, Failure};
use crate::cli::{interrupt, settings, terminal};

/// Settings that are measured side by side at most: each holds a renderer.
const MOST_SETTINGS: usize = 32;
/// Longer side of the picture where no size is given.
const DEFAULT_SIDE: u32 = 128;

/// The content of the JSON file.
#[derive(Serialize)]
struct File<'a> {
    machine: &'a Machine,
    scenes: &'a [SceneConvergence],
}

/// Measures scene after scene and writes the results.
pub fn run(arguments: &ConvergenceArguments, plan: &PlanOptions, access: &LoadOptions) -> Result<Exit, Failure> {
    let scenes = load(arguments, access)?;
    let axes = Axes::from(&arguments.axes);
    let settings = axes.variants(&scenes[0].render).len();
    if settings > MOST_SETTINGS {
        return Err(Failure::usage(format!("these options make {settings} settings; {MOST_SETTINGS} can be compared at once")));
    }
    let results = Results::prepare(&arguments.output, "convergence", &access.log)?;
    interrupt::install()?;
    let options = ConvergenceOptions {
        axes,
        schedule: SampleSchedule::doubling(arguments.spp, arguments.levels, arguments.replications, arguments.seed),
        reference: arguments.reference.clone(),
        reference_spp: arguments.reference_spp.unwrap_or(arguments.spp.saturating_mul(16)),
        store: arguments.references.clone().unwrap_or_else(Store::default_folder),
    };
    let mut devices = Devices::for_plans(plan);
    let mut measured = Vec::new();
    for scene in &scenes {
        match measure(scene, &options, &mut devices, &OnlyStops, &mut |what| results.say(what)) {
            Err(BenchError::Interrupted) if !measured.is_empty() => break,
            outcome => measured.push(outcome?),
        }
        if let Some(last) = measured.last() {
            terminal::answer(&convergence_text(last))?;
        }
        if interrupt::requested() {
            break;
        }
    }
    let machine = Machine::here(&devices.names(), command());
    let page = convergence_page(&measured, &machine)?;
    results.write(&File { machine: &machine, scenes: &measured }, &convergence_csv(&measured)?, &page)?;
    Ok(if interrupt::requested() { Exit::Interrupted } else { Exit::Done })
}

/// All scenes, so that a mistyped name shows before the first is measured.
fn load(arguments: &ConvergenceArguments, access: &LoadOptions) -> Result<Vec<Scene>, Failure> {
    let default = ["cornell".to_owned()];
    let names = if arguments.scenes.is_empty() { &default[..] } else { &arguments.scenes };
    if arguments.reference.is_some() && names.len() > 1 {
        return Err(Failure::usage("--reference is a picture of one scene, and several are named"));
    }
    names.iter().map(|name| load_one(name, arguments, access)).collect()
}

fn load_one(name: &str, arguments: &ConvergenceArguments, access: &LoadOptions) -> Result<Scene, Failure> {
    let mut scene = load::load_with(Some(name.as_ref()), access)?;
    for warning in &scene.warnings {
        terminal::warn(warning);
    }
    match arguments.size {
        Some(size) => scene.film.size = size,
        None => verify::shrink(&mut scene, DEFAULT_SIDE),
    }
    scene.render.max_depth = arguments.max_depth.unwrap_or(scene.render.max_depth);
    settings::check(&scene)?;
    Ok(scene)
}
