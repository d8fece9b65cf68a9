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

use crate::file_log::FileLog;
use crate::output::{AtomicFile, OutputError};
use crate::scene::{Motion, Scene};
pub use mitsuba::{WrittenMitsuba, as_mitsuba};
use scene_file::scene_text;

/// Writes the scene as [`save_scene_beside`] does, whatever it was read from.
///
/// # Errors
/// The errors of [`save_scene_beside`].
pub fn save_scene(scene: &Scene, path: &Path) -> Result<Vec<PathBuf>, OutputError> {
    save_scene_beside(scene, path, &FileLog::default())
}

/// Writes the scene as a TOML file, and in the folder `NAME.files` beside it the meshes and pictures that come from no file. All files that
/// were written, the scene file last.
///
/// # Errors
/// Files that cannot be written, files that were read, and what no scene file can say, in a sentence.
pub fn save_scene_beside(scene: &Scene, path: &Path, read: &FileLog) -> Result<Vec<PathBuf>, OutputError> {
    let of_keyframes = |motion: &Motion| motion.rest != 0.0 || motion.reached != 1.0;
    if scene.shapes.iter().filter_map(|shape| shape.motion.as_ref()).any(of_keyframes) {
        let what = "a frame of keyframes cannot be written; the scene that has them can".to_owned();
        return Err(OutputError::Encode { path: path.to_owned(), what });
    }
    let (text, files) = scene_text(scene, path);
    let files = files.into_files();
    if let Some(path) = files.iter().map(|(path, _)| path.as_path()).chain([path]).find(|path| read.has(path)) {
        return Err(OutputError::Input { path: path.to_owned() });
    }
    let mut written = write_files(files)?;
    AtomicFile::write(path, text.as_bytes())?;
    written.push(path.to_owned());
    Ok(written)
}

/// Writes the files that lie beside the scene file; their paths.
fn write_files(files: Vec<(PathBuf, Vec<u8>)>) -> Result<Vec<PathBuf>, OutputError> {
    let write = |(path, content): (PathBuf, Vec<u8>)| {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(|source| OutputError::Write { path: folder.to_owned(), source })?;
        }
        AtomicFile::write(&path, &content).map(|()| path)
    };
    files.into_iter().map(write).collect()
}

#[cfg(test)]
mod tests;
