//! From a scene back to a scene file: what a program made or read can be looked at, changed and rendered again.
//!
//! Meshes and pictures that came from files are named, those that did not lie in files beside the scene file. Reading it again gives a scene
//! that renders the same picture, bit for bit.

mod animation;
mod material;
mod mitsuba;
mod needed;
mod scene_file;
mod settings;
mod shape;
mod texture;

use std::fs;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::atomic_file::AtomicFile;
use crate::file_log::FileLog;
use crate::output_error::OutputError;
use crate::scene::{ImportReport, Motion, Scene};
pub use mitsuba::as_mitsuba;
use scene_file::scene_text;

/// A scene as text, and the files that the text names beside those on disk.
#[derive(Debug)]
pub struct WrittenScene {
    /// TOML, or XML of Mitsuba.
    pub text: String,
    /// Paths of the files beside it, with their contents.
    pub files: Vec<(PathBuf, Vec<u8>)>,
    /// Differences between the text and the scene.
    pub report: ImportReport,
}

impl WrittenScene {
    /// Writes the files and, last of all, the text; the paths of all that were written.
    ///
    /// # Errors
    /// Files that cannot be written, and those that `read` names: an output never replaces an input.
    pub fn write(self, path: &Path, read: &FileLog) -> Result<Vec<PathBuf>, OutputError> {
        let all = || self.files.iter().map(|(path, _)| path.as_path()).chain([path]);
        if let Some(path) = all().find(|path| read.has(path)).map(Path::to_owned) {
            return Err(OutputError::Input { path });
        }
        let write = |(path, content): (PathBuf, Vec<u8>)| {
            if let Some(folder) = path.parent() {
                fs::create_dir_all(folder).map_err(|source| OutputError::Write { path: folder.to_owned(), source })?;
            }
            AtomicFile::write(&path, &content).map(|()| path)
        };
        // Side by side: a disk takes some time to say that a file is safe, however small it is.
        let mut written = self.files.into_par_iter().map(write).collect::<Result<Vec<_>, _>>()?;
        AtomicFile::write(path, self.text.as_bytes())?;
        written.push(path.to_owned());
        Ok(written)
    }
}

/// The scene as a TOML file at `path`. Meshes and pictures that come from no file are to lie in the folder `NAME.files` beside it, and
/// other files are named by their paths relative to it.
///
/// # Errors
/// What no scene file can say, in a sentence.
pub fn as_scene_file(scene: &Scene, path: &Path) -> Result<WrittenScene, OutputError> {
    let of_keyframes = |motion: &Motion| motion.rest != 0.0 || motion.reached != 1.0;
    if scene.shapes.iter().filter_map(|shape| shape.motion.as_ref()).any(of_keyframes) {
        let what = "a frame of keyframes cannot be written; the scene that has them can".to_owned();
        return Err(OutputError::Encode { path: path.to_owned(), what });
    }
    let (text, files) = scene_text(scene, path);
    Ok(WrittenScene { text, files: files.into_files(), report: scene.import_report.clone() })
}

/// Writes the scene as [`save_scene_beside`] does, whatever it was read from.
///
/// # Errors
/// The errors of [`save_scene_beside`].
pub fn save_scene(scene: &Scene, path: &Path) -> Result<Vec<PathBuf>, OutputError> {
    save_scene_beside(scene, path, &FileLog::default())
}

/// Writes the scene as [`as_scene_file`] makes it. All files that were written, the scene file last.
///
/// # Errors
/// Files that cannot be written, files that were read, and what no scene file can say, in a sentence.
pub fn save_scene_beside(scene: &Scene, path: &Path, read: &FileLog) -> Result<Vec<PathBuf>, OutputError> {
    as_scene_file(scene, path)?.write(path, read)
}

#[cfg(test)]
mod tests;
