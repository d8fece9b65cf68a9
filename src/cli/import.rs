//! `gpt import`.

use gpt::load::{SceneError, SceneSource};
use gpt::scene_writer;

use super::arguments::ImportArguments;
use super::exit::{Exit, Failure};
use super::{outputs, reading, terminal};

/// Writes a scene of another program, or a model, as a scene file, with the meshes and pictures that it embeds beside it.
pub fn run(arguments: &ImportArguments) -> Result<Exit, Failure> {
    let target = arguments.output.as_path();
    outputs::check([target], [arguments.scene.as_path()])?;
    if target.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("toml")) {
        return Err(Failure::usage(format!("{} does not end in .toml, as a scene file does", target.display())));
    }
    let options = arguments.access.options(arguments.strict);
    let source = SceneSource::parse(Some(arguments.scene.as_os_str()))?;
    if !matches!(source, SceneSource::Import(_) | SceneSource::Model(_)) {
        let message = "cannot be imported: it is neither glTF (.gltf, .glb) nor a scene of Mitsuba (.xml) or pbrt (.pbrt) nor a model (.obj, .ply)";
        return Err(SceneError::in_file(arguments.scene.display(), message).into());
    }
    // A model becomes the scene that `gpt render` makes: framed, with a ground and a light.
    let scene = reading::shown(false, &options.progress, || source.load(&options))?;
    scene.warnings.iter().for_each(|warning| terminal::warn(warning));
    let written = scene_writer::as_scene_file(&scene, target)?;
    if let Some(summary) = written.report.summary() {
        if arguments.strict {
            return Err(SceneError::in_file(arguments.scene.display(), summary).into());
        }
        terminal::warn(&summary);
    }
    // All of them, before the first is written.
    let beside = written.files.iter().map(|(path, _)| path.as_path()).filter(|path| path.exists());
    outputs::check(beside.chain([target]), None)?;
    written.write(target, &options.log)?;
    Ok(Exit::Done)
}
