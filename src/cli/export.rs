//! `gpt export`.

use std::path::Path;

use gpt::load::{self, SceneError};
use gpt::scene_writer::ExportFormat;

use super::arguments::ExportArguments;
use super::exit::{Exit, Failure};
use super::{outputs, terminal};

/// Writes a scene as one of another program, by the ending of the file, with what it embeds beside it.
pub fn run(arguments: &ExportArguments) -> Result<Exit, Failure> {
    let target = &arguments.output;
    outputs::check([target.as_path()], [Path::new(&arguments.scene)])?;
    let Some(format) = ExportFormat::of(target) else {
        let endings = "it ends neither in .xml (Mitsuba 3) nor in .pbrt (pbrt-v4) nor in .glb or .gltf (glTF 2.0)";
        return Err(Failure::usage(format!("{} cannot be written: {endings}", target.display())));
    };
    let options = arguments.access.options(arguments.strict);
    let scene = load::load_with(Some(&arguments.scene), &options)?;
    let name = Path::new(&arguments.scene).display().to_string();
    let written = format.write(&scene, &name, target)?;
    if let Some(summary) = written.report.summary() {
        if arguments.strict {
            return Err(SceneError::in_file(&name, summary).into());
        }
        let items = written.report.dropped.iter().chain(&written.report.approximated);
        items.for_each(|item| terminal::warn(&format!("{}: {}: {}", item.place, item.what, item.instead)));
    }
    let paths = || written.files.iter().map(|(path, _)| path.as_path()).chain([target.as_path()]);
    outputs::check(paths().filter(|path| path.exists() || path == target), None)?;
    written.write(target, &options.log)?;
    Ok(Exit::Done)
}
