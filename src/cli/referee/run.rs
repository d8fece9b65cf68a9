//! `gpt referee run`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use gpt::compare::sidak;
use gpt::output::{AtomicFile, Image};
use gpt::referee::causes::causes_of;
use gpt::referee::{Seeds, Test, judge, suite};
use serde::Serialize;

use super::arguments::RunArguments;
use super::chosen::chosen;
use super::report::{Shown, TestReport, Verdict, counts};
use super::runner::{self, NoPicture, Picture, Runner, Wanted};
use super::{badge, junit, page};
use crate::cli::exit::{Exit, Failure};
use crate::cli::{interrupt, outputs, terminal};

/// Tests of each family that `--quick` takes.
const QUICK_TESTS: usize = 3;

/// The JSON that `--json` prints. Its keys stay as they are; new ones may be added.
#[derive(Serialize)]
struct Report<'a> {
    suite: &'static str,
    renderer: &'a str,
    command: Option<String>,
    spp: u32,
    runs: u32,
    false_alarms: f64,
    seconds: f64,
    right: bool,
    tests: &'a [TestReport],
}

/// Renders the suite, judges it and reports.
pub fn run(arguments: &RunArguments) -> Result<Exit, Failure> {
    let started = Instant::now();
    let tests = taken(arguments)?;
    let reports_to = [&arguments.junit, &arguments.html, &arguments.badge];
    let files = reports_to.into_iter().flatten().map(PathBuf::as_path);
    outputs::check(files, arguments.exceptions.as_deref())?;
    let exceptions = exceptions(arguments.exceptions.as_deref(), &tests)?;
    interrupt::install()?;
    let temporary = tempfile::tempdir().map_err(|error| Failure::Other(format!("a temporary folder: {error}")))?;
    let folder = arguments.keep.as_deref().unwrap_or(temporary.path());
    let runner = Runner::of(arguments, temporary.path())?;
    let name = runner
        .as_ref()
        .map_or_else(|| arguments.name.clone().unwrap_or_else(|| "pictures".to_owned()), |runner| runner.name.clone());
    let spp = if arguments.quick { arguments.spp.min(64) } else { arguments.spp };
    let level = sidak(arguments.false_alarms, tests.len());
    let mut rendered = Vec::with_capacity(tests.len());
    for test in &tests {
        if !arguments.quiet {
            terminal::note(&format!("{} …", test.name));
        }
        let start = Instant::now();
        let pictures = pictures(test, (arguments, runner.as_ref()), spp, &folder.join(test.file_name()))?;
        if interrupt::requested() {
            return Err(Failure::Interrupted);
        }
        rendered.push((pictures, start.elapsed().as_secs_f64()));
    }
    // If seeds count in any test, pictures that are equal have no noise.
    let seeds = if rendered.iter().any(|(rendered, _)| rendered.differ()) { Seeds::Known } else { Seeds::Unknown };
    let mut reports = Vec::with_capacity(tests.len());
    for (test, (rendered, seconds)) in tests.iter().zip(rendered) {
        let mut report = TestReport::new(test);
        match rendered {
            Rendered::Pictures(pictures) => judge_pictures(test, &pictures, (seeds, level), &mut report)?,
            Rendered::NotSupported(reason) => (report.verdict, report.reason) = (Verdict::NotSupported, Some(reason)),
            Rendered::Failed(reason) => report.reason = Some(reason),
        }
        if let Some(reason) = exceptions.get(test.name).filter(|_| report.verdict.is_wrong()) {
            report.reason = Some(reason.clone());
            report.verdict = Verdict::Excepted;
        }
        report.seconds = seconds;
        if !arguments.json {
            terminal::answer(&format!("{}\n", report.line()))?;
        }
        reports.push(report);
    }
    let seconds = started.elapsed().as_secs_f64();
    if let Some(path) = &arguments.junit {
        AtomicFile::write(path, junit::xml(&name, &reports, seconds).as_bytes())?;
    }
    if let Some(path) = &arguments.html {
        AtomicFile::write(path, page::page(&name, &reports, arguments.false_alarms).as_bytes())?;
    }
    if let Some(path) = &arguments.badge {
        AtomicFile::write(path, badge::svg(&reports).as_bytes())?;
    }
    let right = !reports.iter().any(|report| report.verdict.is_wrong());
    if arguments.json {
        terminal::answer_json(&Report {
            suite: suite::VERSION,
            renderer: &name,
            command: runner.as_ref().map(Runner::command),
            spp,
            runs: arguments.runs,
            false_alarms: arguments.false_alarms,
            seconds,
            right,
            tests: &reports,
        })?;
    } else {
        terminal::answer(&format!("{name}: {} ({seconds:.0} s)\n", counts(&reports)))?;
    }
    Ok(if right { Exit::Done } else { Exit::Difference })
}

/// The tests that are wanted.
fn taken(arguments: &RunArguments) -> Result<Vec<Test>, Failure> {
    let mut tests = chosen(&arguments.tests)?;
    if arguments.quick {
        let mut counts = BTreeMap::new();
        tests.retain(|test| {
            let count = counts.entry(test.family()).or_insert(0);
            *count += 1;
            *count <= QUICK_TESTS
        });
    }
    Ok(tests)
}

/// Reasons by test.
fn exceptions(path: Option<&Path>, tests: &[Test]) -> Result<BTreeMap<String, String>, Failure> {
    let Some(path) = path else { return Ok(BTreeMap::new()) };
    let wrong = |what: String| Failure::BadScene(format!("{}: {what}", path.display()));
    let text = std::fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
    let exceptions: BTreeMap<String, String> = toml::from_str(&text).map_err(|error| wrong(error.to_string()))?;
    let all = chosen(&[])?;
    match exceptions.keys().find(|name| !all.iter().chain(tests).any(|test| test.name == **name)) {
        Some(name) => Err(wrong(format!("there is no test `{name}`"))),
        None => Ok(exceptions),
    }
}

/// The outcome of rendering a test.
enum Rendered {
    Pictures(Vec<Picture>),
    NotSupported(String),
    Failed(String),
}

impl Rendered {
    /// Two pictures of one test are not the same.
    fn differ(&self) -> bool {
        matches!(self, Self::Pictures(pictures) if pictures.iter().any(|picture| picture.pixels != pictures[0].pixels))
    }
}

fn pictures(
    test: &Test,
    (arguments, runner): (&RunArguments, Option<&Runner>),
    spp: u32,
    folder: &Path,
) -> Result<Rendered, Failure> {
    let Some(runner) = runner else {
        let Some(pictures) = &arguments.pictures else { return Ok(Rendered::Failed("there are no pictures".to_owned())) };
        return Ok(given(test, pictures));
    };
    let form = runner.form.write(test, folder)?;
    if !form.left_out.is_empty() {
        return Ok(Rendered::NotSupported(form.left_out.join("; ")));
    }
    let mut found = Vec::new();
    for number in 1..=arguments.runs {
        let output = folder.join(format!("picture-{number}.exr"));
        let wanted = Wanted { scene: &form.path, output: &output, size: test.size(), spp, seed: number };
        match runner.render(&wanted) {
            Ok(picture) => found.push(picture),
            Err(NoPicture::NotSupported(reason)) => return Ok(Rendered::NotSupported(reason)),
            Err(NoPicture::Failed(reason)) => return Ok(Rendered::Failed(reason)),
        }
    }
    Ok(Rendered::Pictures(found))
}

/// Pictures that were made before.
fn given(test: &Test, folder: &Path) -> Rendered {
    let of = |number: u32| {
        let suffix = if number == 1 { String::new() } else { format!("-{number}") };
        let named = |ending| folder.join(format!("{}{suffix}.{ending}", test.file_name()));
        ["exr", "hdr", "tif", "png", "jpg"].map(named).into_iter().find(|path| path.exists())
    };
    let mut found = Vec::new();
    for number in 1.. {
        let Some(path) = of(number) else { break };
        match runner::read(&path) {
            Ok(picture) => found.push(picture),
            Err(reason) => return Rendered::Failed(reason),
        }
    }
    if found.is_empty() { Rendered::NotSupported("there is no picture of it".to_owned()) } else { Rendered::Pictures(found) }
}

fn judge_pictures(
    test: &Test,
    pictures: &[Picture],
    (seeds, level): (Seeds, f64),
    report: &mut TestReport,
) -> Result<(), Failure> {
    let truth = test.true_picture().map_err(Failure::Other)?;
    let width = pictures[0].width;
    if let Some(other) =
        pictures.iter().find(|picture| picture.width != width || picture.pixels.len() != pictures[0].pixels.len())
    {
        report.reason = Some(format!("its pictures have different sizes: {width} and {} pixels wide", other.width));
        return Ok(());
    }
    let views: Vec<&[[f32; 3]]> = pictures.iter().map(|picture| picture.pixels.as_slice()).collect();
    let judgement = judge(&truth, width, &views, seeds, level);
    report.judged(&judgement);
    if report.verdict == Verdict::Differs {
        let causes = causes_of(test, &truth, (width, &views), (seeds, level));
        report.looks_like = causes.map_err(|error| Failure::Other(error.to_string()))?;
    }
    if let Some(tiles) = judgement.compared {
        let height = truth.height;
        let image = |pixels: Vec<[f32; 3]>| Image { width, height, pixels };
        report.shown = Some(Shown { truth: image(truth.mean), found: image(pictures[0].pixels.clone()), tiles });
    }
    Ok(())
}
