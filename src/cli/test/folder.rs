//! The scenes of a folder.

use std::path::{Path, PathBuf};

use super::arguments::TestArguments;
use crate::cli::exit::Failure;
use crate::cli::shell::{quoted, quoted_path};

/// Where golden pictures are, below the folder of the scenes.
const GOLDEN: &str = "golden";

/// A scene and where its golden picture is.
#[derive(Debug)]
pub struct Job {
    pub name: String,
    pub file: PathBuf,
    pub golden: PathBuf,
}

/// How a person makes the golden picture of a scene.
pub fn bless_command(job: &Job, folder: &Path) -> String {
    format!("gpt test {} {} --bless", quoted_path(folder), quoted(&job.name))
}

/// What is to be tested, in the order of the names.
///
/// # Errors
/// A folder that cannot be read or has no scenes, and names that it does not have.
pub fn jobs(arguments: &TestArguments) -> Result<Vec<Job>, Failure> {
    let folder = &arguments.folder;
    let unreadable = |error: std::io::Error| Failure::BadScene(format!("cannot read the folder {}: {error}", folder.display()));
    let mut jobs = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let file = entry.map_err(unreadable)?.path();
        let is_scene = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) && file.is_file();
        if let (true, Some(stem)) = (is_scene, file.file_stem()) {
            let name = stem.to_string_lossy().into_owned();
            let golden = folder.join(GOLDEN).join(format!("{name}.exr"));
            jobs.push(Job { name, golden, file });
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
