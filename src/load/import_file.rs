//! Scenes of other programs, by the endings of their names.

use std::path::{Path, PathBuf};

use glam::DVec3;

use super::access::LoadOptions;
use super::error::{SceneError, show};
use super::files::Files;
use super::framing::{FIELD_OF_VIEW, GROUND, LIGHT, SKY, Stage};
use super::import::{Description, Entry, FileReference, HeldContent, Keys, Text, write_ply};
use super::{gltf, mitsuba};
use crate::scene::ImportReport;

/// How a scene of another program is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImportFormat {
    Mitsuba,
    Gltf,
}

impl ImportFormat {
    /// By the ending of the file's name; None where it is no scene's.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_string_lossy().to_ascii_lowercase().as_str() {
            "xml" => Some(Self::Mitsuba),
            "gltf" | "glb" => Some(Self::Gltf),
            _ => None,
        }
    }
}

/// Reads a scene of another program. What has no camera or no light is framed and lit as a bare model is.
pub fn load(files: &Files, path: &Path, options: &LoadOptions) -> Result<Description, SceneError> {
    let mut description = read(files, path, options)?;
    frame(&mut description, &show(path))?;
    Ok(description)
}

/// Reads a scene of another program as it stands in its file.
pub fn read(files: &Files, path: &Path, options: &LoadOptions) -> Result<Description, SceneError> {
    let name = show(path);
    let description = match ImportFormat::of(path) {
        Some(ImportFormat::Mitsuba) => {
            if let Some(variant) = &options.variant {
                let message = format!("there is no variant `{variant}`: a scene of Mitsuba has no variants of materials");
                return Err(SceneError::in_file(name, message));
            }
            let options = mitsuba::Options { definitions: options.definitions.clone(), camera: options.camera.clone() };
            mitsuba::load(files, path, &options)?
        }
        Some(ImportFormat::Gltf) => gltf::load(files, path, options.camera.as_deref(), options.variant.as_deref())?,
        None => {
            return Err(SceneError::in_file(
                name,
                "cannot be imported: it is neither glTF (.gltf, .glb) nor a Mitsuba scene (.xml)",
            ));
        }
    };
    let is_bare = description.shapes.is_empty() && description.instances.is_empty();
    // A camera and surroundings make a picture without surfaces.
    if is_bare && description.lights.is_empty() && description.camera.is_none() {
        return Err(SceneError::in_file(
            name,
            "there is nothing to render in the scene: it has no surfaces, no lights and no camera",
        ));
    }
    Ok(description)
}

/// A scene file and the files that it names beside those on disk.
#[derive(Debug)]
pub struct WrittenScene {
    /// TOML
    pub text: String,
    /// Where they are to be written, with their contents.
    pub files: Vec<(PathBuf, Vec<u8>)>,
    /// What is not exact.
    pub report: ImportReport,
}

/// An imported scene as a scene file that is to be written to `target`, and that renders the same picture.
pub fn as_scene_file(path: &Path, target: &Path, options: &LoadOptions) -> Result<WrittenScene, SceneError> {
    let description = load(&options.access()?.files, path, options)?;
    let folder = target.parent().unwrap_or(Path::new(""));
    let stem = target.file_stem().map_or_else(|| "scene".to_owned(), |stem| stem.to_string_lossy().into_owned());
    let beside = PathBuf::from(format!("{stem}-files"));
    let file_name = |file: &FileReference| match file {
        FileReference::Disk(path) => relative_to(folder, path),
        FileReference::Held(index) => {
            beside.join(description.held.get(*index).map_or("", |(name, _)| name)).to_string_lossy().replace('\\', "/")
        }
    };
    let mut text = Text { text: format!("# Imported from {}.\n", show(path).replace('\n', " ")), origins: Vec::new() };
    text.push(&description, &file_name);
    let contents = description.held.iter().map(|(name, content)| {
        let bytes = match content {
            HeldContent::Mesh(mesh) => write_ply(mesh),
            HeldContent::Bytes(bytes) => bytes.to_vec(),
        };
        (folder.join(&beside).join(name), bytes)
    });
    Ok(WrittenScene { files: contents.collect(), text: text.text, report: description.report })
}

/// A path as a file in the folder names it: relative where it lies within, else from the root.
fn relative_to(folder: &Path, path: &Path) -> String {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let real = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| absolute(path));
    let (folder, path) = (real(folder), real(path));
    path.strip_prefix(&folder).unwrap_or(&path).to_string_lossy().replace('\\', "/")
}

/// Adds what a scene lacks: a camera, and light.
fn frame(description: &mut Description, name: &str) -> Result<(), SceneError> {
    let lit = description.has_light();
    if description.camera.is_some() && lit {
        return Ok(());
    }
    if description.camera.is_some() {
        // The camera may stand anywhere, even where a ground or a lamp would hide what it looks at.
        description.lights.push(sky());
        return Ok(());
    }
    let points = description.points();
    if points.is_empty() && lit {
        let keys = Keys::new().with("position", DVec3::ZERO).with("look_at", DVec3::NEG_Z).with("vfov", FIELD_OF_VIEW);
        description.camera = Some(Entry { keys, ..Entry::default() });
        return Ok(());
    }
    let stage = Stage::around(&points, name)?;
    let camera = &stage.camera;
    let keys = Keys::new().with("position", camera.position).with("look_at", camera.look_at).with("vfov", FIELD_OF_VIEW);
    description.camera = Some(Entry { keys, ..Entry::default() });
    if lit {
        return Ok(());
    }
    description.lights.push(sky());
    let (ground, light) = (stage.ground, stage.light);
    let plane = Keys::of_type("plane").with("point", ground.point).with("normal", DVec3::Y);
    let rectangle =
        Keys::of_type("rectangle").with("corner", light.corner).with("edge_u", light.edge_u).with("edge_v", light.edge_v);
    description.add_surface("(ground)", Keys::of_type("diffuse").with("reflectance", GROUND), plane);
    description.add_surface("(light)", Keys::of_type("emissive").with("radiance", LIGHT), rectangle);
    Ok(())
}

fn sky() -> Entry {
    Entry { keys: Keys::of_type("environment").with("radiance", SKY), ..Entry::default() }
}
