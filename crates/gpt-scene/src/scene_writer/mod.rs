//! From a scene back to a scene file: what a program made or read can be looked at, changed and rendered again. And from a scene to one of another
//! program: `mitsuba`, `pbrt`, `gltf`, of which `export_format` chooses.
//!
//! Meshes and pictures that came from files are named, those that did not lie in files beside the scene file. Reading it again gives a scene
//! that renders the same picture, bit for bit.
//!
//! `losses` names what the formats of other programs cannot say. Modules that several of them need: `inputs` and `weights`, functions of texels; `pictures`,
//! those that are made of others; `surroundings`, the media on both sides of shapes; `emission`, the light of blends.

mod animation;
mod camera;
mod emission;
mod export_format;
mod flat_camera;
mod gltf;
mod inputs;
mod losses;
mod material;
mod mitsuba;
mod needed;
mod pbrt;
mod pictures;
mod scene_file;
mod settings;
mod shape;
mod surroundings;
mod texture;
mod weights;
mod written;

use std::path::{Path, PathBuf};

use crate::file_log::FileLog;
use crate::output_error::OutputError;
use crate::scene::{Motion, Scene};
pub use export_format::ExportFormat;
pub use gltf::as_gltf;
pub use mitsuba::as_mitsuba;
pub use pbrt::as_pbrt;
use scene_file::scene_text;
pub use written::WrittenScene;

/// The scene as a TOML file at `path`. Meshes and pictures that come from no file are to lie in the folder `NAME.files` beside it, and
/// other files are named by their paths relative to it.
///
/// # Errors
/// Properties of the scene that no scene file can express, in a sentence.
pub fn as_scene_file(scene: &Scene, path: &Path) -> Result<WrittenScene, OutputError> {
    let of_keyframes = |motion: &Motion| motion.rest != 0.0 || motion.reached != 1.0;
    if scene.shapes.iter().filter_map(|shape| shape.motion.as_ref()).any(of_keyframes) {
        let what = "a frame of keyframes cannot be written; the scene that has them can".to_owned();
        return Err(OutputError::Encode { path: path.to_owned(), what });
    }
    let (text, files) = scene_text(scene, path, true);
    Ok(WrittenScene { content: text.into_bytes(), files: files.into_files(), report: scene.import_report.clone() })
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
