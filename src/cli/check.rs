//! `gpt check`.

use std::borrow::Cow;

use gpt::binary_tree::parts::KeptTrees;
use gpt::gpu::{Fitting, limits_for_plans, select_adapter};
use gpt::learn::Settled;
use gpt::load::{self, SceneError, printable};
use gpt::plan::host::{HostNeeds, host_memory};
use gpt::plan::{DeviceLimits, Memory, Plan, PlanError, PlanOptions};
use gpt::reference::Integrator;
use gpt::renderer::{Decision, DeviceChoice, RenderError};
use gpt::scene::{Guiding, ImportReport, LightChoice, ReportItem, Scene, SceneSummary};
use gpt::verify;
use serde::Serialize;

use super::arguments::CheckArguments;
use super::exit::{Exit, Failure};
use super::sequence::bad_frame;
use super::traversal::TraversalArguments;
use super::{reading, terminal};

/// Longer side in pixels of the picture by which the time is guessed.
const PROBE_SIDE: u32 = 16;
/// Most surfaces that its paths meet: in closed mirrors they would go on for ever.
const PROBE_DEPTH: u32 = 1000;

/// Seconds after which paths are given up. What is rendered does not depend on them.
const MOST_GUESSING: f64 = 3.0;

/// Most frames of a scene with keyframes that are looked at, but for one.
const MOST_FRAMES: f64 = 500.0;

/// The JSON that `--json` prints of a scene that can be read.
#[derive(Serialize)]
struct Report<'a> {
    valid: bool,
    errors: [Mistake<'a>; 0],
    warnings: &'a [String],
    /// Parts of an imported file that have no effect, and parts that something else stands in for.
    #[serde(flatten)]
    import: &'a ImportReport,
    #[serde(flatten)]
    summary: &'a SceneSummary,
    /// The device that the plan is for.
    device: &'a str,
    device_bytes: u64,
    /// The host's memory for a render on that device, within a factor of two, and on the CPU.
    host_bytes: u64,
    cpu_host_bytes: u64,
    /// That the CPU would take for the picture, by a few samples.
    cpu_seconds: f64,
    /// True where the estimate is a lower bound: paths meet so much that counting it was given up.
    cpu_seconds_is_least: bool,
    /// Why no trial run chose what the settings leave open, where paths take too much work for one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pilot_left_out: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    plan: Option<PlanReport<'a>>,
}

#[derive(Serialize)]
struct PlanReport<'a> {
    decisions: &'a [Decision],
    compiled_in: Vec<&'static str>,
}

/// The JSON that `--json` prints of a scene that cannot be read.
#[derive(Serialize)]
struct Refusal<'a> {
    valid: bool,
    errors: Vec<Mistake<'a>>,
}

#[derive(Serialize)]
struct Mistake<'a> {
    file: &'a str,
    line: Option<usize>,
    column: Option<usize>,
    key: Option<&'a str>,
    message: &'a str,
    help: Option<&'a str>,
}

impl<'a> From<&'a SceneError> for Mistake<'a> {
    fn from(error: &'a SceneError) -> Self {
        Self {
            file: error.file(),
            line: error.line(),
            column: error.column(),
            key: error.key(),
            message: error.message(),
            help: error.help_text(),
        }
    }
}

/// Loads the scene, which validates all of it, and prints what is in it and what it takes.
pub fn run(arguments: &CheckArguments) -> Result<Exit, Failure> {
    let Some(name) = arguments.scene.as_deref().filter(|_| !arguments.schema) else {
        terminal::answer(load::json_schema())?;
        return Ok(Exit::Done);
    };
    let options = arguments.access.options(arguments.strict);
    let mut scene = match reading::shown(false, &options.progress, || load::load_with(Some(name), &options)) {
        Ok(scene) => scene,
        Err(error) => {
            if arguments.json {
                let errors = std::iter::once(&error).chain(error.others()).map(Mistake::from).collect();
                terminal::answer_json(&Refusal { valid: false, errors })?;
            }
            return Err(error.into());
        }
    };
    let of_precision = scene.precision_warnings();
    scene.warnings.extend(of_precision);
    for warning in &scene.warnings {
        terminal::warn(warning);
    }
    check_frames(&scene)?;
    let options = PlanOptions { film: arguments.film.storage(), ..arguments.traversal.options() };
    let (device, limits) = usual_device(&options)?;
    let planned = if arguments.plan { Cow::Borrowed(&scene) } else { without_guide(&scene) };
    let (plan, settled) = usual_plan(&planned, &limits, &options)?;
    let summary = SceneSummary::of(&scene);
    let exit = if arguments.strict && !scene.import_report.is_empty() { Exit::Input } else { Exit::Done };
    let time = guess_time(&settled.scene)?;
    let host = host_needs(&scene, false);
    if arguments.json {
        let compiled_in = plan.switches.enabled.iter().copied().collect();
        terminal::answer_json(&Report {
            valid: true,
            errors: [],
            warnings: &scene.warnings,
            import: &scene.import_report,
            summary: &summary,
            device: &device,
            device_bytes: plan.memory.total(),
            host_bytes: host.total(),
            cpu_host_bytes: host_needs(&scene, true).total(),
            cpu_seconds: time.seconds,
            cpu_seconds_is_least: time.is_least,
            pilot_left_out: settled.because.left_out.as_deref(),
            plan: arguments.plan.then(|| PlanReport { decisions: &plan.decisions, compiled_in }),
        })?;
        return Ok(exit);
    }
    let warnings = match scene.warnings.len() {
        0 => String::new(),
        1 => ", with a warning".to_owned(),
        count => format!(", with {count} warnings"),
    };
    let least = if time.is_least { "more than " } else { "" };
    let time = format!("{least}{}", in_words(time.seconds));
    let trial_run = settled
        .because
        .left_out
        .as_ref()
        .map_or_else(String::new, |why| format!("trial run  left out, so that settings are the usual ones: {why}\n"));
    let answer = format!(
        "valid{warnings}\n{summary}memory     {} on {device}\nhost       {host}, by estimate\ntime       {time} on the CPU, by a few samples; a graphics card takes a fraction\n{trial_run}",
        plan.memory
    );
    terminal::answer(&answer)?;
    terminal::answer(&listed(&scene.import_report))?;
    if arguments.plan {
        terminal::answer(&format!("\nplan for {device}\n{plan}\n"))?;
    }
    Ok(exit)
}

/// Looks at the scene where its keyframes begin and end and at frames in between.
fn check_frames(scene: &Scene) -> Result<(), Failure> {
    let Some([first, last]) = scene.animation.frames() else { return Ok(()) };
    let steps = (last - first).ceil().clamp(1.0, MOST_FRAMES);
    let mut step = 0.0;
    while step <= steps {
        let frame = first + (last - first) * step / steps;
        scene.at_frame(frame).map_err(|error| bad_frame(scene, &error))?;
        step += 1.0;
    }
    Ok(())
}

/// The losses of an import, a line for each kind; empty where the import is exact.
fn listed(report: &ImportReport) -> String {
    let mut text = String::new();
    for (heading, items) in [("dropped", &report.dropped), ("approximated", &report.approximated)] {
        if items.is_empty() {
            continue;
        }
        text.push_str(&format!("\n{heading}\n"));
        for ReportItem { what, place, count, instead } in items {
            let times = if *count > 1 { format!(" ({count} times)") } else { String::new() };
            text.push_str(&format!("  {what}{times}: {instead} [{place}]\n"));
        }
    }
    printable(&text)
}

/// The host's memory for a render of the whole picture.
pub fn host_needs(scene: &Scene, on_cpu: bool) -> Memory {
    let pixels = scene.film.size.map(u64::from).iter().product();
    host_memory(scene, &HostNeeds { pixels, on_cpu, ..HostNeeds::default() })
}

/// The device that `--device auto` takes, and what it needs of its memory for the scene.
pub fn device_memory(scene: &Scene) -> Result<(String, u64), Failure> {
    let options = TraversalArguments::default().options();
    let (device, limits) = usual_device(&options)?;
    let scene = without_guide(scene);
    let (plan, _) = usual_plan(&scene, &limits, &options)?;
    Ok((device, plan.memory.total()))
}

/// The scene without a guide that nobody asked for: to learn whether it pays takes seconds, and it takes 18 MiB at most.
fn without_guide(scene: &Scene) -> Cow<'_, Scene> {
    let mut scene = Cow::Borrowed(scene);
    if scene.render.guiding == Guiding::Auto {
        scene.to_mut().render.guiding = Guiding::Off;
    }
    scene
}

/// The device that `--device auto` takes; without an adapter, one that has just what WebGPU promises.
fn usual_device(options: &PlanOptions) -> Result<(String, DeviceLimits), Failure> {
    let Ok(adapter) = select_adapter(&DeviceChoice::Auto) else {
        return Ok(("a device with the limits that WebGPU promises".to_owned(), DeviceLimits::default()));
    };
    let limits = limits_for_plans(&adapter, options).map_err(RenderError::from)?;
    Ok((adapter.get_info().name, limits))
}

/// The plan of a render, and the scene with complete settings.
fn usual_plan<'a>(scene: &'a Scene, limits: &DeviceLimits, options: &'a PlanOptions) -> Result<(Plan, Settled<'a>), Failure> {
    let mut trees = KeptTrees::default();
    let mut fitting = Fitting::new(scene, Some(limits), options, &mut trees)?;
    loop {
        let Fitting { settled, packed, options, .. } = &fitting;
        match Plan::new(&settled.scene, packed, limits, options) {
            Err(PlanError::DoesNotFit(_)) if fitting.gives_something_up(&mut trees)? => {}
            plan => return Ok((plan.map_err(RenderError::from)?, fitting.settled)),
        }
    }
}

/// The time of the picture on the CPU, as far as a few paths tell.
#[derive(Debug, Clone, Copy)]
pub struct GuessedTime {
    pub seconds: f64,
    /// Paths take longer than anybody waits for a guess.
    pub is_least: bool,
}

/// The time that the CPU would take, by one sample of each pixel of a small picture; too little where paths meet more than a thousand surfaces.
pub fn guess_time(scene: &Scene) -> Result<GuessedTime, Failure> {
    let mut small = scene.clone();
    verify::shrink(&mut small, PROBE_SIDE);
    small.render.spp = 1;
    // 0 sets no bound.
    small.render.max_depth = if small.render.max_depth == 0 { PROBE_DEPTH } else { small.render.max_depth.min(PROBE_DEPTH) };
    small.render.guiding = Guiding::Off;
    if small.render.light_choice == LightChoice::Cells {
        small.render.light_choice = LightChoice::Tree;
    }
    let pixels = |scene: &Scene| scene.film.size.map(f64::from).iter().product::<f64>();
    let of_path = Integrator::new(&small)?.time_of_path(pixels(&small) as u32, MOST_GUESSING);
    let seconds = of_path.seconds * pixels(scene) * f64::from(scene.render.spp);
    Ok(GuessedTime { seconds, is_least: of_path.is_least })
}

fn in_words(seconds: f64) -> String {
    match seconds {
        few if few < 2.0 => "a second or two".to_owned(),
        few if few < 120.0 => format!("about {few:.0} s"),
        more if more < 7200.0 => format!("about {:.0} min", more / 60.0),
        many => format!("about {:.0} h", many / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_given_roughly() {
        let words = [0.3, 40.0, 600.0, 86_400.0].map(in_words);
        assert_eq!(words, ["a second or two", "about 40 s", "about 10 min", "about 24 h"]);
    }
}
