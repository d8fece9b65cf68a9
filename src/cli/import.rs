//! `gpt import`.

use std::path::Path;

use gpt::load::{self, SceneError, SceneSource};
use gpt::output::AtomicFile;
use gpt::scene_writer;
use rayon::prelude::*;

use super::arguments::ImportArguments;
use super::exit::{Exit, Failure};
use super::{outputs, reading, terminal};

/// Writes a scene of another program, or a model, as a scene file, with the meshes and pictures that it embeds beside it.
pub fn run(arguments: &ImportArguments) -> Result<Exit, Failure> {
    let target = arguments.output.clone();
    outputs::check([target.as_path()], [arguments.scene.as_path()])?;
    if target.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("toml")) {
        return Err(Failure::usage(format!("{} does not end in .toml, as a scene file does", target.display())));
    }
    let options = arguments.access.options(arguments.strict);
    if let Ok(SceneSource::Model(_)) = SceneSource::parse(Some(arguments.scene.as_os_str())) {
        // The scene that `gpt render` makes of a model: framed, with a ground and a lamp.
        let scene = load::load_with(Some(arguments.scene.as_os_str()), &options)?;
        scene_writer::save_scene_beside(&scene, &target, &options.log)?;
        return Ok(Exit::Done);
    }
    let written =
        reading::shown(false, &options.progress, || load::as_scene_file(Path::new(&arguments.scene), &target, &options))?;
    if let Some(summary) = written.report.summary() {
        if arguments.strict {
            return Err(SceneError::in_file(arguments.scene.display(), summary).into());
        }
        terminal::warn(&summary);
    }
    // All of them, before the first is written.
    let paths = || written.files.iter().map(|(path, _)| path.as_path()).chain([target.as_path()]);
    outputs::check(paths().filter(|path| path.exists() || *path == target), None)?;
    outputs::check_unread(paths(), &options.log)?;
    for folder in written.files.iter().filter_map(|(path, _)| path.parent()) {
        std::fs::create_dir_all(folder).map_err(|error| Failure::Other(format!("{}: {error}", folder.display())))?;
    }
    // Side by side: a disk takes some time to say that a file is safe, however small it is.
    written.files.par_iter().try_for_each(|(path, bytes)| AtomicFile::write(path, bytes))?;
    AtomicFile::write(&target, written.text.as_bytes())?;
    Ok(Exit::Done)
}
