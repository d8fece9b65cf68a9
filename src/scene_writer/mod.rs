//! From a scene back to a scene file: what a program made or read can be looked at, changed and rendered again.
//!
//! Meshes and pictures that came from files are named, those that did not lie in files beside the scene file. Reading it again gives a scene
//! that renders the same picture, bit for bit.

mod light;
mod material;
mod names;
mod needed;
mod picture;
mod ply;
mod settings;
mod shape;
mod side_files;
mod texture;
mod value;
mod writer;

use std::path::{Path, PathBuf};

use crate::output::{AtomicFile, OutputError};
use crate::scene::Scene;
use names::Names;
use needed::Needed;
use side_files::SideFiles;
use writer::Writer;

/// Writes the scene as a TOML file, and in the folder `NAME.files` beside it the meshes and pictures that come from no file. All files that
/// were written, the scene file last.
///
/// # Errors
/// Files that cannot be written, and what no scene file can say, in a sentence.
pub fn save_scene(scene: &Scene, path: &Path) -> Result<Vec<PathBuf>, OutputError> {
    let (text, files) = scene_text(scene, path);
    let mut written = files.write()?;
    AtomicFile::write(path, text.as_bytes())?;
    written.push(path.to_owned());
    Ok(written)
}

/// The text of the scene file that would lie at `path`.
fn scene_text(scene: &Scene, path: &Path) -> (String, SideFiles) {
    let needed = Needed::of(scene);
    let mut writer = Writer {
        scene,
        textures: Names::unique(scene.textures.iter().map(|texture| texture.name.as_str()), "texture"),
        materials: Names::unique(scene.materials.iter().map(|material| material.name.as_str()), "material"),
        files: SideFiles::beside(path),
    };
    let mut text = settings::settings(scene);
    for id in needed.textures() {
        text.push_str(&writer.texture(id));
    }
    for id in needed.materials() {
        text.push_str(&writer.material(id));
    }
    for shape in &scene.shapes {
        text.push_str(&writer.shape(shape));
    }
    for light in &scene.lights {
        text.push_str(&writer.light(light));
    }
    (text, writer.files)
}

#[cfg(test)]
mod tests;
