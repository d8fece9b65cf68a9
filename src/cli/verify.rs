//! `gpt verify`.

use std::ffi::OsStr;
use std::fmt::Write;
use std::path::Path;

use gpt::choice::Choice;
use gpt::gpu::Device;
use gpt::load;
use gpt::plan::{Fault, PlanOptions};
use gpt::renderer::{DeviceChoice, RenderError};
use gpt::scene::Scene;
use gpt::verify::closed_forms::{self, ClosedForm, ClosedFormError};
use gpt::verify::{self, DEFAULT_SIDE, DEFAULT_SPP, Verdict, evidence, path, shares};
use serde::Serialize;

use super::arguments::VerifyArguments;
use super::exit::{Exit, Failure};
use super::frames::FrameArguments;
use super::sequence::bad_frame;
use super::typed::{CommandLine, Typed};
use super::{terminal, verified_drivers};

/// One line of the answer.
#[derive(Serialize)]
#[serde(untagged)]
enum Finding {
    ClosedForm(ClosedForm),
    Scene(Verdict),
}

impl Finding {
    fn agrees(&self) -> bool {
        match self {
            Self::ClosedForm(closed) => closed.agrees,
            Self::Scene(verdict) => verdict.agrees,
        }
    }

    fn name(&self) -> &str {
        match self {
            Self::ClosedForm(closed) => closed.closed_form,
            Self::Scene(verdict) => &verdict.scene,
        }
    }

    fn planted(&self) -> Option<Fault> {
        match self {
            Self::ClosedForm(closed) => closed.planted,
            Self::Scene(verdict) => verdict.planted,
        }
    }

    fn line(&self) -> String {
        match self {
            Self::ClosedForm(closed) => closed_form_line(closed),
            Self::Scene(verdict) => scene_line(verdict),
        }
    }
}

/// Verifies one scene, or the closed forms and all scenes that are built in, and prints the verdicts; or follows one path.
pub fn run(arguments: &VerifyArguments, typed: &Typed) -> Result<Exit, Failure> {
    let device_timeout = arguments.device_timeout;
    let film = arguments.film.storage_on(&arguments.device)?;
    let options = PlanOptions { fault: arguments.plant, film, device_timeout, ..arguments.traversal.options() };
    if arguments.device == DeviceChoice::Cpu {
        return verify_reference(arguments);
    }
    if let Some(pixel) = arguments.pixel {
        return follow(arguments, pixel, &options);
    }
    let mut findings = Findings { as_json: arguments.json, found: Vec::new() };
    // A scene that cannot be read is reported before a device is asked for.
    let named = arguments.scene.as_deref().map(|name| load(name, arguments, arguments.frame)).transpose()?;
    let device = Device::open_for(&arguments.device, &options)?;
    if let (Some(name), Some(scene)) = (&arguments.scene, named) {
        findings.add(verify_scene(&device, (&name.to_string_lossy(), arguments.frame), &scene, (arguments, typed), &options)?)?;
        was_planted(arguments, findings.planted())?;
        return findings.conclude();
    }
    let is_whole = arguments.size.is_none() && arguments.spp.is_none() && arguments.plant.is_none();
    let verdict = everything(&device, findings, (arguments, typed), &options);
    if is_whole && options.asks_for_ray_queries() {
        keep_verdict(&device, matches!(verdict, Ok(Exit::Done)));
    }
    verdict
}

/// Verifies the closed forms and all scenes that are built in.
fn everything(
    device: &Device,
    mut findings: Findings,
    (arguments, typed): (&VerifyArguments, &Typed),
    options: &PlanOptions,
) -> Result<Exit, Failure> {
    for index in 0..closed_forms::count() {
        findings.add(Finding::ClosedForm(closed_forms::check(index, device, options).map_err(failure)?))?;
    }
    for name in load::builtin_names() {
        let scene = load(OsStr::new(name), arguments, None)?;
        let first_frame = (!scene.animation.is_empty()).then(|| load(OsStr::new(name), arguments, Some(0))).transpose()?;
        for (scene, frame) in [Some((scene, None)), first_frame.map(|scene| (scene, Some(0)))].iter().flatten() {
            match verify_scene(device, (name, *frame), scene, (arguments, typed), options) {
                // Not every scene can be traversed in every way; the others still are.
                Err(Failure::Render(RenderError::DoesNotFit(why))) if options.asks_for_ray_queries() => {
                    terminal::warn(&format!("{name} is left out: {why}"));
                }
                outcome => findings.add(outcome?)?,
            }
        }
    }
    was_planted(arguments, findings.planted())?;
    findings.conclude()
}

/// Ray queries that passed are the default from then on, and those that did not, or lost the device, no longer are.
fn keep_verdict(device: &Device, passed: bool) {
    let Some(file) = verified_drivers::file() else { return };
    match verified_drivers::keep(&file, &device.driver, passed) {
        // A software device walks nodes faster.
        Ok(true) if device.limits.software => {}
        Ok(true) if passed => {
            terminal::note(&format!(
                "ray queries are the default on {} from now on; {} keeps that",
                device.driver,
                file.display()
            ));
        }
        Ok(true) => terminal::note(&format!("ray queries are no longer the default on {}", device.driver)),
        Ok(false) => {}
        Err(why) => terminal::warn(&format!("that ray queries were verified cannot be kept in {}: {why}", file.display())),
    }
}

/// The reference is what every device is compared with. By itself it can be compared with closed forms.
fn verify_reference(arguments: &VerifyArguments) -> Result<Exit, Failure> {
    if arguments.scene.is_some() || arguments.pixel.is_some() || arguments.plant.is_some() {
        return Err(Failure::usage(
            "with --device cpu there are no two devices to compare: scenes are verified on a graphics device, against the CPU; \
             `gpt devices` lists those there are, and `gpt verify --device cpu` alone holds the CPU against closed forms",
        ));
    }
    let mut findings = Findings { as_json: arguments.json, found: Vec::new() };
    for index in 0..closed_forms::count() {
        findings.add(Finding::ClosedForm(closed_forms::check_reference(index).map_err(failure)?))?;
    }
    findings.conclude()
}

/// The findings so far: printed as they come, or all of them as JSON in the end.
struct Findings {
    as_json: bool,
    found: Vec<Finding>,
}

impl Findings {
    fn add(&mut self, finding: Finding) -> Result<(), Failure> {
        if !self.as_json {
            terminal::answer(&finding.line())?;
        }
        self.found.push(finding);
        Ok(())
    }

    /// True if a fault was compiled in.
    fn planted(&self) -> bool {
        self.found.iter().any(|finding| finding.planted().is_some())
    }

    /// Ends the output: with the verdict in one line, or as JSON.
    fn conclude(self) -> Result<Exit, Failure> {
        let differing: Vec<&str> = self.found.iter().filter(|finding| !finding.agrees()).map(Finding::name).collect();
        if self.as_json {
            terminal::answer_json(&self.found)?;
        } else {
            let count = self.found.len();
            let (colour, text) = match differing.len() {
                0 => (
                    terminal::GREEN,
                    format!("GREEN: {}", if count == 1 { "it agrees".into() } else { format!("all {count} agree") }),
                ),
                wrong => (terminal::RED, format!("RED: {wrong} of {count} differ: {}", differing.join(", "))),
            };
            terminal::answer(&format!("{}\n", terminal::coloured(colour, &text)))?;
        }
        Ok(if differing.is_empty() { Exit::Done } else { Exit::Difference })
    }
}

fn failure(error: ClosedFormError) -> Failure {
    match error {
        ClosedFormError::Scene(error) => error.into(),
        ClosedFormError::Render(error) => error.into(),
    }
}

/// A fault that found nothing to act on proves nothing.
fn was_planted(arguments: &VerifyArguments, planted: bool) -> Result<(), Failure> {
    match arguments.plant {
        Some(fault) if !planted => {
            Err(Failure::usage(format!("the scene has nothing for the fault `{}` to act on", fault.name())))
        }
        _ => Ok(()),
    }
}

/// Prints one path on both devices.
fn follow(arguments: &VerifyArguments, [x, y]: [u32; 2], options: &PlanOptions) -> Result<Exit, Failure> {
    let name = arguments.scene.as_deref().unwrap_or(OsStr::new("cornell"));
    let scene = load(name, arguments, arguments.frame)?;
    let [width, height] = scene.film.size;
    if x >= width || y >= height {
        return Err(Failure::usage(format!(
            "there is no pixel {x},{y} in a picture of {width}x{height}: columns and rows count from 0; --size sets the size"
        )));
    }
    let device = Device::open_for(&arguments.device, options)?;
    let comparison = path::compare_path(&device, &scene, [x, y], arguments.sample, options)?;
    if arguments.json {
        terminal::answer_json(&comparison)?;
    } else {
        terminal::answer(&comparison.to_string())?;
    }
    was_planted(arguments, comparison.planted.is_some())?;
    Ok(if comparison.agrees { Exit::Done } else { Exit::Difference })
}

fn load(name: &OsStr, arguments: &VerifyArguments, frame: Option<u32>) -> Result<Scene, Failure> {
    let mut scene = load::load_with(Some(name), &arguments.access.options(false))?;
    let wanted = FrameArguments { frame, ..FrameArguments::default() };
    if let Some(frame) = wanted.times(&scene.animation)?.first().and_then(|time| time.frame()) {
        scene = scene.at_frame(frame).map_err(|error| bad_frame(&scene, &error))?;
        scene.name = format!("{}, frame {frame}", scene.name);
    }
    match arguments.size {
        Some(size) => scene.film.size = size,
        None => verify::shrink(&mut scene, DEFAULT_SIDE),
    }
    scene.render.spp = arguments.spp.unwrap_or(DEFAULT_SPP);
    scene.render.seed = arguments.seed.unwrap_or(scene.render.seed);
    Ok(scene)
}

fn verify_scene(
    device: &Device,
    (name, frame): (&str, Option<u32>),
    scene: &Scene,
    (arguments, typed): (&VerifyArguments, &Typed),
    options: &PlanOptions,
) -> Result<Finding, Failure> {
    let share = if arguments.size.is_none() { shares::of_builtin(name) } else { None };
    let verdict = verify::verify_on(device, scene, options, share)?;
    if !verdict.agrees {
        leave_evidence(&arguments.evidence, scene, &verdict, &path_command((name, frame), scene, &verdict, typed));
    }
    Ok(Finding::Scene(verdict))
}

fn word(agrees: bool) -> &'static str {
    if agrees { "agrees " } else { "DIFFERS" }
}

fn closed_form_line(closed: &ClosedForm) -> String {
    let show = |values: [f64; 3]| {
        let [r, g, b] = values.map(|value| format!("{value:.5}"));
        if r == g && g == b { r } else { format!("{r} {g} {b}") }
    };
    let error = closed.standard_error.iter().fold(0.0_f64, |largest, x| largest.max(*x));
    format!(
        "{:<18} {}  expected {}  found {} ± {error:.1e}  ({})\n",
        closed.closed_form,
        word(closed.agrees),
        show(closed.expected),
        show(closed.found),
        closed.formula
    )
}

fn scene_line(verdict: &Verdict) -> String {
    let mut text = String::new();
    let _ = write!(
        text,
        "{:<18} {}  {:.4} % of {} paths match  rms {:.1e}  largest {:.1e}  not finite {}",
        verdict.scene,
        word(verdict.agrees),
        100.0 * verdict.matching_share(),
        verdict.paths,
        verdict.rms_difference,
        verdict.largest_difference,
        verdict.non_finite_samples
    );
    for missed in &verdict.missed {
        let _ = write!(text, "\n    {missed}");
    }
    for rejection in verdict.rejections.iter().take(5) {
        let _ = write!(text, "\n    {rejection}");
    }
    if verdict.rejections.len() > 5 {
        let _ = write!(text, "\n    and {} more regions", verdict.rejections.len() - 5);
    }
    text.push('\n');
    text
}

/// Options that the command for the worst path replaces by its own words, or leaves out.
const NOT_OF_THE_PATH: [&str; 5] = ["size", "seed", "frame", "json", "evidence"];

/// The command that prints the worst path. Stratified samplers draw by the number of samples, which is passed on where it was typed.
fn path_command((name, frame): (&str, Option<u32>), scene: &Scene, verdict: &Verdict, typed: &Typed) -> String {
    let [x, y, sample] = verdict.path_to_follow();
    let mut command = CommandLine::new("verify")
        .with(name)
        .with_options(typed.options_but(&NOT_OF_THE_PATH))
        .with_option("--size", format!("{}x{}", verdict.width, verdict.height))
        .with_option("--seed", scene.render.seed.to_string())
        .with_option("--pixel", format!("{x},{y}"))
        .with_option("--sample", sample.to_string());
    if let Some(frame) = frame {
        command = command.with_option("--frame", frame.to_string());
    }
    command.to_string()
}

/// Writes pictures, and says how to look further. Where they cannot be written the verdict stands all the same.
fn leave_evidence(folder: &Path, scene: &Scene, verdict: &Verdict, command: &str) {
    let made = std::fs::create_dir_all(folder).map_err(|error| error.to_string());
    match made.and_then(|()| evidence::write(folder, scene, verdict).map_err(|error| error.to_string())) {
        Ok(paths) => paths.iter().for_each(|path| terminal::warn(&format!("wrote {}", path.display()))),
        Err(why) => {
            terminal::warn(&format!("the pictures that show the difference cannot be kept in {}: {why}", folder.display()))
        }
    }
    let [x, y, sample] = verdict.path_to_follow();
    terminal::warn(&format!("the worst path is sample {sample} of the pixel at column {x}, row {y}: {command} follows it"));
}
