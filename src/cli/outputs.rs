//! The files that a command is told to write, before it does anything: each once, and none that it is told to read.
//!
//! Other files that it reads, such as textures of a scene, are known once it has read the scene, and are checked then ([`check_unread`]).

use std::collections::BTreeSet;
use std::path::Path;

use gpt::load::FileLog;
use gpt::output::{FileIdentity, OutputError, STDOUT, check_target, folder_of, follow_links, remove_left_over};

use super::exit::Failure;

/// Checks that all of these can be written beside each other, and beside the files that are read.
///
/// # Errors
/// Usage errors where one file is named twice, in whatever way, and where one is read; missing folders.
pub fn check<'a>(outputs: impl IntoIterator<Item = &'a Path>, inputs: impl IntoIterator<Item = &'a Path>) -> Result<(), Failure> {
    let outputs: Vec<&Path> = outputs.into_iter().collect();
    let mut targets: Vec<_> = outputs.iter().map(|path| (meant(path), *path)).collect();
    targets.sort();
    if let Some(pair) = targets.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        return Err(match [pair[0].1, pair[1].1].map(|path| path.display().to_string()) {
            [a, b] if a == b => Failure::usage(format!("{a} is named twice")),
            [a, b] => Failure::usage(format!("one file is named twice, as {a} and as {b}")),
        });
    }
    for input in inputs {
        let input = FileIdentity::of(input);
        if let Some((_, path)) = targets.iter().find(|(target, _)| target.as_ref() == Some(&input)) {
            return Err(OutputError::Input { path: path.to_path_buf() }.into());
        }
    }
    let mut folders = BTreeSet::new();
    for path in outputs.into_iter().filter(|path| !is_stdout(path)) {
        check_target(path)?;
        folders.extend(follow_links(path).ok().map(|target| folder_of(&target).to_owned()));
    }
    // Killed processes may have left something there.
    folders.iter().for_each(|folder| remove_left_over(folder));
    Ok(())
}

/// Checks that none of these files was read for a scene.
///
/// # Errors
/// The first that was.
pub fn check_unread<'a>(outputs: impl IntoIterator<Item = &'a Path>, read: &FileLog) -> Result<(), Failure> {
    match outputs.into_iter().find(|path| !is_stdout(path) && read.has(path)) {
        Some(path) => Err(OutputError::Input { path: path.to_owned() }.into()),
        None => Ok(()),
    }
}

/// The file that a path means; None is standard output.
fn meant(path: &Path) -> Option<FileIdentity> {
    (!is_stdout(path)).then(|| FileIdentity::of(path))
}

/// True where the path means standard output.
pub fn is_stdout(path: &Path) -> bool {
    path == Path::new(STDOUT)
}
