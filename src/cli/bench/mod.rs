//! `gpt bench`.

mod arguments;
mod convergence;
mod features;
mod output;
mod speed;

use arguments::Bench;
pub use arguments::BenchArguments;
pub use output::{OnlyStops, command};

use super::exit::{Exit, Failure};

/// Does the measurement that was asked for.
pub fn run(arguments: &BenchArguments) -> Result<Exit, Failure> {
    match &arguments.bench {
        Bench::Convergence(arguments) => convergence::run(arguments),
        Bench::Speed(arguments) => speed::run(arguments),
        Bench::Features(arguments) => features::run(arguments),
    }
}
