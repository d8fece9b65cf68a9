//! `gpt bench speed`.

use gpt::bench::growth::Growth;
use gpt::bench::machine::Machine;
use gpt::bench::report::{speed_csv, speed_page, speed_text};
use gpt::bench::speed::{SpeedOptions, SpeedTable, measure};
use gpt::bench::subject::{BenchError, Devices};
use gpt::load::{self, LoadOptions};
use gpt::plan::{PlanOptions, StageMode};
use gpt::scene::Scene;
use serde::Serialize;

use super::arguments::{SpeedArguments, StagesName};
use super::output::{OnlyStops, Results, command};
use crate::cli::exit::{Exit, Failure};
use crate::cli::{interrupt, terminal};

/// The content of the JSON file.
#[derive(Serialize)]
struct File<'a> {
    machine: &'a Machine,
    tables: &'a [SpeedTable],
}

/// Measures table after table and writes the results.
pub fn run(arguments: &SpeedArguments, plan: PlanOptions, access: &LoadOptions) -> Result<Exit, Failure> {
    let default = ["cornell", "spheres", "veach-mis"].map(str::to_owned);
    let names = if arguments.scenes.is_empty() { &default[..] } else { &arguments.scenes };
    let scenes: Result<Vec<Scene>, Failure> =
        names.iter().map(|name| Ok(load::load_with(Some(name.as_ref()), access)?)).collect();
    let scenes = scenes?;
    for warning in scenes.iter().flat_map(|scene| &scene.warnings) {
        terminal::warn(warning);
    }
    let film = arguments.film.storage_on(&arguments.device)?;
    let plan = PlanOptions { device_timeout: plan.device_timeout, film, ..arguments.traversal.options_on(&arguments.device)? };
    let options = SpeedOptions {
        device: arguments.device.clone(),
        stages: arguments.stages.map(|stages| match stages {
            StagesName::Fused => StageMode::Fused,
            StagesName::Wavefront => StageMode::Wavefront,
        }),
        plan,
        growths: if arguments.growth.is_empty() { Growth::ALL.to_vec() } else { arguments.growth.clone() },
        everything: arguments.all,
        size: arguments.size,
        spp: arguments.spp,
        depth: arguments.depth,
        rounds: arguments.rounds,
    };
    let results = Results::prepare(&arguments.output, "speed", &access.log)?;
    interrupt::install()?;
    let mut devices = Devices::for_plans(&options.plan);
    let mut tables: Vec<SpeedTable> = Vec::new();
    for growth in &options.growths {
        match measure(*growth, &scenes, &options, &mut devices, &OnlyStops, &mut |what| results.say(what)) {
            Err(BenchError::Interrupted) if !tables.is_empty() => break,
            outcome => {
                let table = outcome?;
                terminal::answer(&speed_text(&table))?;
                tables.push(table);
            }
        }
    }
    let machine = Machine::here(&devices.names(), command());
    results.write(&File { machine: &machine, tables: &tables }, &speed_csv(&tables)?, &speed_page(&tables, &machine)?)?;
    Ok(if interrupt::requested() { Exit::Interrupted } else { Exit::Done })
}
