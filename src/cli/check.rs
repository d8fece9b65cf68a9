//! `gpt check`.

use gpt::gpu::select_adapter;
use gpt::load;
use gpt::packed::{PackError, PackedScene};
use gpt::plan::{DeviceLimits, Plan};
use gpt::renderer::{DeviceChoice, RenderError};
use gpt::scene::SceneSummary;

use super::arguments::CheckArguments;
use super::exit::{Exit, Failure};
use super::terminal;

/// Loads the scene, which validates all of it, and prints what is in it.
pub fn run(arguments: &CheckArguments) -> Result<Exit, Failure> {
    let Some(name) = arguments.scene.as_deref().filter(|_| !arguments.schema) else {
        terminal::answer(&load::json_schema())?;
        return Ok(Exit::Done);
    };
    let scene = load::load_with(Some(name), &arguments.access.options(arguments.strict))?;
    for warning in &scene.warnings {
        terminal::warn(warning);
    }
    let summary = SceneSummary::of(&scene);
    if arguments.json {
        terminal::answer_json(&summary)?;
        return Ok(Exit::Done);
    }
    terminal::answer(&summary.to_string())?;
    let does_not_fit = |error: PackError| RenderError::DoesNotFit(error.to_string());
    let options = arguments.traversal.options();
    let packed = PackedScene::for_traversal(&scene, options.packed_traversal()).map_err(does_not_fit)?;
    // Without an adapter the plan is the one for a device that has just what WebGPU promises.
    let (device, limits) = match select_adapter(&DeviceChoice::Auto) {
        Ok(adapter) => (adapter.get_info().name, DeviceLimits::of(&adapter)),
        Err(_) => ("a device with the limits that WebGPU promises".to_owned(), DeviceLimits::default()),
    };
    let plan = Plan::new(&scene, &packed, &limits, &options).map_err(RenderError::from)?;
    terminal::answer(&format!("\nplan for {device}\n{plan}\n"))?;
    Ok(Exit::Done)
}
