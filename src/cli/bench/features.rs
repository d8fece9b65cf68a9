//! `gpt bench features`.

use gpt::bench::feature_rooms::{Feature, features};
use gpt::bench::features::{FeatureCost, FeatureOptions, measure};
use gpt::bench::machine::Machine;
use gpt::bench::report::{features_csv, features_page, features_text};
use gpt::bench::subject::{BenchError, Devices};
use gpt::load::FileLog;
use gpt::plan::PlanOptions;
use serde::Serialize;

use super::arguments::FeatureArguments;
use super::output::{OnlyStops, Results, command};
use crate::cli::exit::{Exit, Failure};
use crate::cli::{interrupt, terminal};

/// The content of the JSON file.
#[derive(Serialize)]
struct File<'a> {
    machine: &'a Machine,
    features: &'a [FeatureCost],
}

/// Measures feature after feature and writes the results.
pub fn run(arguments: &FeatureArguments, plan: &PlanOptions) -> Result<Exit, Failure> {
    let wanted = wanted(&arguments.features)?;
    let options =
        FeatureOptions { device: arguments.device.clone(), size: arguments.size, spp: arguments.spp, rounds: arguments.rounds };
    let results = Results::prepare(&arguments.output, "features", &FileLog::default())?;
    interrupt::install()?;
    let mut devices = Devices::for_plans(plan);
    let mut costs: Vec<FeatureCost> = Vec::new();
    for (index, feature) in wanted.iter().enumerate() {
        results.say(&format!("{} ({} of {})", feature.name, index + 1, wanted.len()));
        match measure(feature, &options, &mut devices, &OnlyStops) {
            Err(BenchError::Interrupted) if !costs.is_empty() => break,
            outcome => {
                let cost = outcome?;
                terminal::answer(&features_text(&cost))?;
                costs.push(cost);
            }
        }
    }
    let machine = Machine::here(&devices.names(), command());
    results.write(&File { machine: &machine, features: &costs }, &features_csv(&costs)?, &features_page(&costs, &machine)?)?;
    Ok(if interrupt::requested() { Exit::Interrupted } else { Exit::Done })
}

/// The features of these names, or all.
fn wanted(names: &[String]) -> Result<Vec<Feature>, Failure> {
    let all = features();
    let known: Vec<&str> = all.iter().map(|feature| feature.name).collect();
    if let Some(unknown) = names.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(Failure::Usage {
            message: format!("there is no feature `{unknown}`"),
            help: Some(format!("features: {}", known.join(", "))),
        });
    }
    Ok(all.into_iter().filter(|feature| names.is_empty() || names.iter().any(|name| name == feature.name)).collect())
}
