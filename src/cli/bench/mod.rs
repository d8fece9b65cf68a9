//! `gpt bench`.

mod arguments;
mod convergence;
mod features;
mod output;
mod speed;

use arguments::Bench;
pub use arguments::BenchArguments;
use gpt::plan::PlanOptions;
pub use output::{OnlyStops, command};

use super::exit::{Exit, Failure};
use super::traversal::TraversalArguments;

/// Does the measurement that was asked for.
pub fn run(arguments: &BenchArguments) -> Result<Exit, Failure> {
    let plan = PlanOptions { device_timeout: arguments.device_timeout, ..TraversalArguments::default().options() };
    let access = arguments.files.options(false);
    match &arguments.bench {
        Bench::Convergence(arguments) => convergence::run(arguments, &plan, &access),
        Bench::Speed(arguments) => speed::run(arguments, plan, &access),
        Bench::Features(arguments) => features::run(arguments, &plan),
    }
}
