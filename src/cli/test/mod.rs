//! `gpt test`: a picture test that knows noise.

mod folder;
mod junit;
mod page;
mod report;
mod scene;

use std::path::{Path, PathBuf};
use std::time::Instant;

use gpt::load::FileLog;
use gpt::output::AtomicFile;
use serde::Serialize;

use super::exit::{Exit, Failure};
use super::test_arguments::TestArguments;
use super::typed::Typed;
use super::{interrupt, outputs, terminal};
use report::{SceneReport, TestOutcome};

/// No report replaces another, a scene, or one of the pictures.
fn check_reports(arguments: &TestArguments, jobs: &[folder::Job]) -> Result<(), Failure> {
    let reports = [arguments.html.as_deref(), arguments.junit.as_deref()].into_iter().flatten();
    let candidates = arguments.candidate_dir.iter().flat_map(|folder| std::fs::read_dir(folder).into_iter().flatten().flatten());
    let candidates: Vec<PathBuf> = candidates.map(|entry| entry.path()).collect();
    let of_jobs = jobs.iter().flat_map(|job| [job.file.as_path(), job.golden.as_path()]);
    outputs::check(reports, of_jobs.chain(candidates.iter().map(PathBuf::as_path)))
}

/// The page that is written where nobody asked for one and something differs.
const DEFAULT_PAGE: &str = "gpt-test.html";

/// The JSON that `--json` prints. Its keys stay as they are; new ones may be added.
#[derive(Serialize)]
struct Report<'a> {
    folder: String,
    agrees: bool,
    change: f64,
    power: f64,
    false_alarms: f64,
    tile: u32,
    seconds: f64,
    html: Option<String>,
    junit: Option<String>,
    scenes: &'a [SceneReport],
}

/// Tests each scene of a folder, and reports.
pub fn run(arguments: &TestArguments, typed: &Typed) -> Result<Exit, Failure> {
    let started = Instant::now();
    let jobs = folder::jobs(arguments, typed)?;
    check_reports(arguments, &jobs)?;
    interrupt::install()?;
    let settings = arguments.settings(jobs.len());
    let mut reports = Vec::with_capacity(jobs.len());
    let read = FileLog::default();
    for job in &jobs {
        if !arguments.quiet {
            terminal::note(&format!("{} …", job.name));
        }
        let report = scene::test(job, arguments, &settings, &read);
        if report.is_interrupted() {
            return Err(Failure::Interrupted);
        }
        if !arguments.json {
            terminal::answer(&report.line())?;
        }
        reports.push(report);
    }
    let exit = exit(&reports);
    let seconds = started.elapsed().as_secs_f64();
    let html = write_page(arguments, &reports, exit, &read)?;
    if let Some(path) = &arguments.junit {
        outputs::check_unread([path.as_path()], &read)?;
        AtomicFile::write(path, junit::xml(&arguments.folder, &reports, seconds).as_bytes())?;
    }
    if arguments.json {
        let shown = |path: &Path| path.display().to_string();
        terminal::answer_json(&Report {
            folder: shown(&arguments.folder),
            agrees: exit == Exit::Done,
            change: arguments.change,
            power: arguments.power,
            false_alarms: arguments.false_alarms,
            tile: arguments.tile,
            seconds,
            html: html.as_deref().map(shown),
            junit: arguments.junit.as_deref().map(shown),
            scenes: &reports,
        })?;
    } else {
        terminal::answer(&conclusion(&reports, html.as_deref()))?;
    }
    Ok(exit)
}

/// The page, where it is asked for or something differs; where it is.
fn write_page(
    arguments: &TestArguments,
    reports: &[SceneReport],
    exit: Exit,
    read: &FileLog,
) -> Result<Option<PathBuf>, Failure> {
    let path = match (&arguments.html, exit) {
        (Some(path), _) => path.clone(),
        (None, Exit::Difference) => PathBuf::from(DEFAULT_PAGE),
        (None, _) => return Ok(None),
    };
    outputs::check_unread([path.as_path()], read)?;
    AtomicFile::write(&path, page::page(arguments, reports).as_bytes())?;
    Ok(Some(path))
}

/// A difference is the answer, whatever else went wrong; then the first failure.
fn exit(reports: &[SceneReport]) -> Exit {
    if reports.iter().any(|report| report.verdict == TestOutcome::Differs) {
        return Exit::Difference;
    }
    reports.iter().find_map(SceneReport::failed_with).unwrap_or(Exit::Done)
}

/// The last line.
fn conclusion(reports: &[SceneReport], html: Option<&Path>) -> String {
    let named = |verdict: TestOutcome| -> Vec<&str> {
        reports.iter().filter(|report| report.verdict == verdict).map(|report| report.scene.as_str()).collect()
    };
    let [differ, failed] = [TestOutcome::Differs, TestOutcome::Failed].map(named);
    let mut words = Vec::new();
    if !differ.is_empty() {
        words.push(format!("{} of {} differ: {}", differ.len(), reports.len(), differ.join(", ")));
    }
    if !failed.is_empty() {
        words.push(format!("{} could not be tested: {}", failed.len(), failed.join(", ")));
    }
    let shown = html.map_or_else(String::new, |path| format!("{} shows them\n", path.display()));
    if words.is_empty() {
        let green = terminal::coloured(terminal::GREEN, "GREEN");
        let made = named(TestOutcome::Made).len();
        let agree = reports.len() - made;
        let words = [(agree, "agree"), (made, "made")].into_iter().filter(|(count, _)| *count > 0);
        let words: Vec<String> = words.map(|(count, word)| format!("{count} {word}")).collect();
        return format!("{shown}{green}: {}\n", words.join(", "));
    }
    format!("{shown}{}: {}\n", terminal::coloured(terminal::RED, "RED"), words.join("; "))
}
