//! The scenes of a folder.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use gpt::picture_test::TestSettings;

use crate::cli::exit::Failure;
use crate::cli::test_arguments::TestArguments;
use crate::cli::typed::{CommandLine, Typed};

/// The folder of golden pictures, below the folder of the scenes.
const GOLDEN: &str = "golden";

/// A scene and where its golden picture is.
#[derive(Debug)]
pub struct Job {
    pub name: String,
    pub file: PathBuf,
    pub golden: PathBuf,
    /// The command that tests it once more, as it was tested among the others.
    pub again: CommandLine,
    /// The words that were typed about the device, for commands that render on it.
    pub on_device: Vec<OsString>,
}

impl Job {
    /// How a person makes its golden picture.
    pub fn bless_command(&self) -> String {
        self.again.clone().with_flag("--bless").to_string()
    }
}

/// Flags that the test of one scene does not repeat: they say what is done with its outcome, or the probability of false alarms, which is shared
/// by all scenes of a run.
const NOT_OF_ONE_SCENE: [&str; 7] = ["bless", "update", "json", "junit", "html", "quiet", "false_alarms"];
const OF_THE_DEVICE: [&str; 3] = ["device", "require_device", "device_timeout"];

fn command_again((arguments, typed): (&TestArguments, &Typed), name: &str, scenes: usize) -> CommandLine {
    let command = CommandLine::new("test").with(&arguments.folder).with(name);
    let command = command.with_options(typed.options_but(&NOT_OF_ONE_SCENE));
    let (of_one, usual) = (arguments.settings(scenes).false_alarms, TestSettings::default().false_alarms);
    if (of_one - usual).abs() < 1e-12 { command } else { command.with_option("--false-alarms", of_one.to_string()) }
}

/// The tests that are asked for, in the order of their names.
///
/// # Errors
/// A folder that cannot be read or has no scenes, and names that it does not have.
pub fn jobs(arguments: &TestArguments, typed: &Typed) -> Result<Vec<Job>, Failure> {
    let folder = &arguments.folder;
    let unreadable = |error: std::io::Error| Failure::BadScene(format!("cannot read the folder {}: {error}", folder.display()));
    let mut jobs = Vec::new();
    let on_device = typed.options_of(&OF_THE_DEVICE);
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let file = entry.map_err(unreadable)?.path();
        let is_scene = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) && file.is_file();
        if let (true, Some(stem)) = (is_scene, file.file_stem()) {
            let name = stem.to_string_lossy().into_owned();
            let golden = folder.join(GOLDEN).join(format!("{name}.exr"));
            let again = CommandLine::new("test");
            jobs.push(Job { name, golden, file, again, on_device: on_device.clone() });
        }
    }
    jobs.sort_by(|a, b| a.name.cmp(&b.name));
    if jobs.is_empty() {
        return Err(Failure::BadScene(format!(
            "{}: there is no scene file (.toml) in this folder; a scene of another program is named by one, with [[import]]",
            folder.display()
        )));
    }
    check_names(arguments, &jobs, folder)?;
    if !arguments.scenes.is_empty() {
        jobs.retain(|job| arguments.scenes.contains(&job.name));
    }
    let count = jobs.len();
    for job in &mut jobs {
        job.again = command_again((arguments, typed), &job.name, count);
    }
    Ok(jobs)
}

fn check_names(arguments: &TestArguments, jobs: &[Job], folder: &Path) -> Result<(), Failure> {
    match arguments.scenes.iter().find(|name| jobs.iter().all(|job| job.name != **name)) {
        None => Ok(()),
        Some(unknown) => {
            let names: Vec<&str> = jobs.iter().map(|job| job.name.as_str()).collect();
            let help = Some(format!("its scenes are {}", names.join(", ")));
            Err(Failure::Usage { message: format!("{} has no scene `{unknown}`", folder.display()), help })
        }
    }
}
