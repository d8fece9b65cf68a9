//! From a scene back to a scene file: what a program made or read can be looked at, changed and rendered again.
//!
//! Meshes and pictures that came from files are named, those that did not lie in files beside the scene file. Reading it again gives a scene
//! that renders the same picture, bit for bit.

mod animation;
mod material;
mod needed;
mod settings;
mod shape;
mod texture;

use std::fs;
use std::path::{Path, PathBuf};

use crate::load::file::write_light;
use crate::load::file::writer::{Names, SideFiles, Writer};
use crate::output::{AtomicFile, OutputError};
use crate::scene::{Motion, Scene};
use needed::Needed;

/// Writes the scene as a TOML file, and in the folder `NAME.files` beside it the meshes and pictures that come from no file. All files that
/// were written, the scene file last.
///
/// # Errors
/// Files that cannot be written, and what no scene file can say, in a sentence.
pub fn save_scene(scene: &Scene, path: &Path) -> Result<Vec<PathBuf>, OutputError> {
    let of_keyframes = |motion: &Motion| motion.rest != 0.0 || motion.reached != 1.0;
    if scene.shapes.iter().filter_map(|shape| shape.motion.as_ref()).any(of_keyframes) {
        let what = "a frame of keyframes cannot be written; the scene that has them can".to_owned();
        return Err(OutputError::Encode { path: path.to_owned(), what });
    }
    let (text, files) = scene_text(scene, path);
    let mut written = write_files(files)?;
    AtomicFile::write(path, text.as_bytes())?;
    written.push(path.to_owned());
    Ok(written)
}

/// The text of the scene file that would lie at `path`.
fn scene_text(scene: &Scene, path: &Path) -> (String, SideFiles) {
    let needed = Needed::of(scene);
    let animation = &scene.animation;
    let mut writer = Writer {
        scene,
        textures: Names::unique(scene.textures.iter().map(|texture| texture.name.as_str()), "texture"),
        materials: Names::unique(scene.materials.iter().map(|material| material.name.as_str()), "material"),
        groups: Names::unique(scene.groups.iter().map(|group| group.name.as_str()), "group"),
        nodes: Names::unique(animation.nodes.iter().map(|node| node.name.as_str()), "node"),
        files: SideFiles::beside(path),
    };
    let mut text = settings::settings(scene);
    // The camera's table is the last.
    let of_camera = animation.camera.as_ref();
    text += &of_camera.map_or_else(String::new, |track| animation::camera(track, scene.camera.projection, &writer.nodes));
    text += &animation::animation(animation, &writer.nodes);
    for id in needed.textures() {
        text.push_str(&texture::texture(id, &mut writer));
    }
    for id in needed.materials() {
        text.push_str(&material::material(id, &writer));
    }
    for (index, shape) in scene.shapes.iter().enumerate() {
        text.push_str(&shape::shape("[[shape]]", shape, &mut writer));
        let tracks = animation.shapes.iter().filter(|track| track.shape == index);
        tracks.for_each(|track| text.push_str(&animation::shape(track, &writer.nodes)));
    }
    for (index, group) in scene.groups.iter().enumerate() {
        text.push_str(&shape::group(index, group, &mut writer));
    }
    for instances in &scene.instances {
        text.push_str(&shape::instances(instances, &mut writer));
    }
    for (index, light) in scene.lights.iter().enumerate() {
        let keys = write_light(light, &mut writer);
        text.push_str(&format!("\n[[light]]\ntype = \"{}\"\n{keys}", light.kind_name()));
        let tracks = animation.lights.iter().filter(|track| track.light == index);
        tracks.for_each(|track| text.push_str(&animation::light(track, light, &writer.nodes)));
    }
    (text, writer.files)
}

/// Writes the files that lie beside the scene file; their paths.
fn write_files(files: SideFiles) -> Result<Vec<PathBuf>, OutputError> {
    let write = |(path, content): (PathBuf, Vec<u8>)| {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(|source| OutputError::Write { path: folder.to_owned(), source })?;
        }
        AtomicFile::write(&path, &content).map(|()| path)
    };
    files.into_files().into_iter().map(write).collect()
}

#[cfg(test)]
mod tests;
