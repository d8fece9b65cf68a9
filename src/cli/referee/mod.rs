//! `gpt referee`: what a renderer gets wrong, test by test.

mod arguments;
mod badge;
mod export;
mod forms;
mod junit;
mod page;
mod report;
mod run;
mod runner;

use gpt::referee::{Test, all_tests};
use serde::Serialize;

use super::exit::{Exit, Failure};
use super::terminal;
pub use arguments::RefereeArguments;
use arguments::{ListArguments, RefereeAction};

/// Does what the arguments say.
pub fn run(arguments: &RefereeArguments) -> Result<Exit, Failure> {
    match &arguments.action {
        RefereeAction::List(arguments) => list(arguments),
        RefereeAction::Export(arguments) => export::run(arguments),
        RefereeAction::Run(arguments) => run::run(arguments),
    }
}

/// The tests of these names and families; all where none is named.
fn chosen(names: &[String]) -> Result<Vec<Test>, Failure> {
    let tests = all_tests();
    for name in names {
        if !tests.iter().any(|test| test.name == name || test.family() == name) {
            let message = format!("there is no test and no family `{name}`");
            return Err(Failure::Usage { message, help: Some("`gpt referee list` lists them".to_owned()) });
        }
    }
    let is_chosen = |test: &Test| names.is_empty() || names.iter().any(|name| test.name == name || test.family() == name);
    Ok(tests.into_iter().filter(is_chosen).collect())
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
