//! Scene files: from TOML text to a [`Scene`].
//!
//! `document` reads the text into the types of `syntax`, which know every key and range; `resolve` looks up names and reads the
//! files that are named. Each complains about the place where the mistake is written.

pub(super) mod colour;
mod document;
mod import;
pub(super) mod instance;
pub(super) mod keyframes;
pub(super) mod light;
mod lit_instances;
pub(super) mod material;
mod nested;
pub(super) mod node;
mod reader;
pub(super) mod reference;
mod resolve;
mod resolver;
mod schema;
pub(super) mod shape;
pub(super) mod syntax;
pub(super) mod value;
mod wording;
pub(crate) mod writer;

use std::path::Path;

use document::Document;
pub(super) use document::stem;
#[cfg(test)]
pub use light::delta_examples as delta_light_examples;
pub(crate) use light::write_light;
pub use light::{examples as light_examples, examples_of as light_examples_of, strength_key};
pub use material::examples as material_examples;
pub(crate) use material::write_kind;
pub use schema::{json_schema, make_json_schema};
pub use shape::examples as shape_examples;
pub(crate) use shape::write_geometry;
use syntax::SceneFile;
pub(super) use wording::did_you_mean;

use crate::load::access::Access;
use crate::load::error::SceneError;
use crate::load::import::{Description, Text};
use crate::scene::Scene;

/// Reads a scene from TOML text. `name` is what errors call it and what the scene's name is taken from; paths in the text are
/// relative to `folder`.
pub fn load_toml_str(text: &str, name: &str, folder: &Path) -> Result<Scene, SceneError> {
    load_toml(text, name, folder, Access::default())
}

/// As [`load_toml_str`], with this access to other files.
pub(super) fn load_toml(text: &str, name: &str, folder: &Path, access: Access) -> Result<Scene, SceneError> {
    load_document(Document::new(name, text, &[]), folder, access)
}

/// Reads a document with what it imports.
fn load_document<'a>(document: Document<'a>, folder: &'a Path, mut access: Access) -> Result<Scene, SceneError> {
    match import::expand(&document, &mut access, folder)? {
        None => load_whole(document, folder, access),
        Some(expanded) => {
            let mut scene = load_whole(document.with_imports(&expanded.text), folder, access)?;
            scene.warnings.splice(0..0, expanded.warnings);
            scene.import_report = expanded.report;
            Ok(scene)
        }
    }
}

/// Reads a scene that was imported.
pub(super) fn load_description(description: Description, name: &str, mut access: Access) -> Result<Scene, SceneError> {
    let mut text = Text::default();
    text.push(&description, &|file| description.held_path(file).to_string_lossy().into_owned());
    description.hold_in(&mut access.files, Path::new(""));
    let warnings = description.warnings(name, access.strict)?;
    let mut scene = load_whole(Document::new(name, &text.text, &text.origins), Path::new(""), access)?;
    scene.warnings.splice(0..0, warnings);
    scene.import_report = description.report;
    Ok(scene)
}

fn load_whole<'a>(document: Document<'a>, folder: &'a Path, access: Access) -> Result<Scene, SceneError> {
    let name = document.name;
    let file: SceneFile = document.read_whole()?;
    if file.camera.is_none() {
        return Err(document.error(&(0..document.text.len()).into(), "the key `camera` is missing"));
    }
    let mut scene = resolve::resolve(document.without_tree(), folder, file, access)?;
    scene.name = stem(name);
    if !scene.has_light() {
        let message = "nothing in the scene gives light, so the picture would be black";
        return Err(
            SceneError::in_file(name, message).with_help("add a [[light]], or a material of type \"emissive\" that a shape uses")
        );
    }
    Ok(scene)
}

/// Reads a model file alone: its meshes in a scene without a camera of its own and without lights. They have their own materials, or the last
/// one of a scene file's text: `materials` are what errors call that file, its text, and the folder that paths in it are relative to.
pub(super) fn load_model(
    path: &Path,
    smooth: Option<bool>,
    materials: Option<(&str, &str, &Path)>,
    access: Access,
) -> Result<Scene, SceneError> {
    let materials = materials.map(|(name, text, folder)| (Document::new(name, text, &[]), folder));
    resolve::resolve_model(path, smooth, materials, access)
}
