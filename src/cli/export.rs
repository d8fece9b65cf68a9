//! `gpt export`.

use gpt::load::{self, SceneError};
use gpt::output::{AtomicFile, check_target};

use super::arguments::ExportArguments;
use super::exit::{Exit, Failure};
use super::terminal;

/// Writes a scene as one of Mitsuba, with what it embeds beside it.
pub fn run(arguments: &ExportArguments) -> Result<Exit, Failure> {
    let target = &arguments.output;
    check_target(target)?;
    if target.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("xml")) {
        return Err(Failure::usage(format!("{} does not end in .xml, as a scene of Mitsuba does", target.display())));
    }
    let stem = target.file_stem().map_or_else(|| "scene".to_owned(), |stem| stem.to_string_lossy().into_owned());
    let beside = format!("{stem}-files");
    let written = load::as_mitsuba(&arguments.scene, &arguments.access.options(arguments.strict), &beside)?;
    if let Some(summary) = written.report.summary() {
        if arguments.strict {
            return Err(SceneError::in_file(std::path::Path::new(&arguments.scene).display(), summary).into());
        }
        let items = written.report.dropped.iter().chain(&written.report.approximated);
        items.for_each(|item| terminal::warn(&format!("{}: {}: {}", item.place, item.what, item.instead)));
    }
    if !written.files.is_empty() {
        let folder = target.with_file_name(&beside);
        std::fs::create_dir_all(&folder).map_err(|error| Failure::Other(format!("{}: {error}", folder.display())))?;
        for (name, bytes) in &written.files {
            AtomicFile::write(&folder.join(name), bytes)?;
        }
    }
    AtomicFile::write(target, written.text.as_bytes())?;
    Ok(Exit::Done)
}
