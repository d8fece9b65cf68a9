//! The files that a command is told to write, before it does anything: each once, and none that it is told to read.
//!
//! Other files that it reads, such as textures of a scene, are known once it has done so; they are then refused as they are opened for writing
//! ([`gpt::output::protect_inputs`]).

use std::path::Path;

use gpt::output::{FileIdentity, OutputError, STDOUT, check_target};

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
    outputs.iter().filter(|path| !is_stdout(path)).try_for_each(|path| Ok(check_target(path)?))
}

/// The file that a path means; None is standard output.
fn meant(path: &Path) -> Option<FileIdentity> {
    (!is_stdout(path)).then(|| FileIdentity::of(path))
}

/// True where the path means standard output.
pub fn is_stdout(path: &Path) -> bool {
    path == Path::new(STDOUT)
}
