//! `gpt referee`: what a renderer gets wrong, test by test.

mod arguments;
mod badge;
mod chosen;
mod export;
mod forms;
mod junit;
mod page;
mod report;
mod run;
mod runner;

use gpt::referee::Test;
use serde::Serialize;

use super::exit::{Exit, Failure};
use super::terminal;
pub use arguments::RefereeArguments;
use arguments::{ListArguments, RefereeAction};
use chosen::chosen;

/// Does what the arguments say.
pub fn run(arguments: &RefereeArguments) -> Result<Exit, Failure> {
    match &arguments.action {
        RefereeAction::List(arguments) => list(arguments),
        RefereeAction::Export(arguments) => export::run(arguments),
        RefereeAction::Run(arguments) => run::run(arguments),
    }
}

#[derive(Serialize)]
struct Entry {
    name: &'static str,
    about: &'static str,
    decides: &'static str,
    mistakes: Vec<&'static str>,
}

fn list(arguments: &ListArguments) -> Result<Exit, Failure> {
    let tests = chosen(&arguments.tests)?;
    if arguments.json {
        let mistakes = |test: &Test| test.variants.iter().map(|variant| variant.cause).collect();
        let entry = |test: &Test| Entry { name: test.name, about: test.about, decides: test.decides, mistakes: mistakes(test) };
        terminal::answer_json(&tests.iter().map(entry).collect::<Vec<_>>())?;
        return Ok(Exit::Done);
    }
    for test in &tests {
        terminal::answer(&format!("{}\n    {}\n    Decides: {}\n", test.name, test.about, test.decides))?;
    }
    Ok(Exit::Done)
}
