//! `gpt check`.

use gpt::scene::{self, SceneSummary};

use super::arguments::CheckArguments;
use super::exit::{Exit, Failure};
use super::terminal;

/// Loads the scene, which validates all of it, and prints what is in it.
pub fn run(arguments: &CheckArguments) -> Result<Exit, Failure> {
    let Some(name) = arguments.scene.as_deref().filter(|_| !arguments.schema) else {
        terminal::answer(&scene::json_schema())?;
        return Ok(Exit::Done);
    };
    let scene = scene::load(Some(name))?;
    for warning in &scene.warnings {
        terminal::warn(warning);
    }
    let summary = SceneSummary::of(&scene);
    if arguments.json {
        terminal::answer_json(&summary)?;
    } else {
        terminal::answer(&summary.to_string())?;
    }
    Ok(Exit::Done)
}
