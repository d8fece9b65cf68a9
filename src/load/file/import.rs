//! `[[import]]`: scenes of other programs within one of ours.
//!
//! An import becomes text of a scene file of its own, with names of its own: the lists of both are then read as one, however a person
//! wrote theirs.

use std::borrow::Cow;
use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::document::{self, Document};
use super::resolver::Resolver;
use super::shape::TransformEntry;
use super::value::Located;
use crate::load::access::{Access, LoadOptions};
use crate::load::error::{SceneError, show};
use crate::load::formats;
use crate::load::import::{Description, FileReference, Text};
use crate::load::import_file::{self, ImportFormat};
use crate::scene::{ImportReport, Transform};

/// A scene of another program: all of its shapes, materials and lights, besides those of this file. Its picture size and settings are left out.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "Import")]
pub struct ImportEntry {
    /// Path of a `.gltf`, `.glb` or Mitsuba `.xml` file, relative to the scene file.
    #[schemars(extend("pattern" = "\\.([gG][lL][tT][fF]|[gG][lL][bB]|[xX][mM][lL])$"))]
    pub file: Located<String>,
    /// The name of the file's camera that stands for `[camera]`; the first one where neither is written.
    pub camera: Option<Located<String>>,
    /// The name of the variant of a glTF's materials that is shown.
    pub variant: Option<Located<String>>,
    /// Steps applied in this order to all of it, or a matrix.
    pub transform: Option<Located<TransformEntry>>,
    /// The imported file's materials, by their names, that materials of this file take the place of.
    #[serde(default)]
    pub materials: BTreeMap<String, Located<String>>,
    /// What `$key` stands for in a Mitsuba file.
    #[serde(default)]
    pub define: BTreeMap<String, String>,
}

/// The part of a file that says what is imported.
#[derive(Deserialize)]
struct Imports {
    #[serde(default)]
    import: Vec<ImportEntry>,
}

/// All that a text imports.
pub struct Expanded {
    pub text: Text,
    pub report: ImportReport,
    pub warnings: Vec<String>,
}

/// Reads what the document imports, and puts what that brings along among the files. None where nothing is imported.
pub fn expand<'a>(
    document: &Document<'a>,
    access: &mut Access,
    folder: &'a std::path::Path,
) -> Result<Option<Expanded>, SceneError> {
    if !document.text.contains("import") {
        return Ok(None);
    }
    // A text that cannot be parsed is told about where it is read.
    let Ok(root) = document.root() else { return Ok(None) };
    if !root.contains_key("import") {
        return Ok(None);
    }
    let has_camera = root.contains_key("camera");
    let lights = root.get("light").and_then(|lights| lights.get_ref().as_array());
    let is_environment = |kind: &str| ["environment", "sky"].contains(&kind);
    let has_environment = lights.is_some_and(|lights| {
        let kinds = lights.iter().filter_map(|light| light.get_ref().get("type")?.get_ref().as_str());
        kinds.into_iter().any(is_environment)
    });
    let Imports { import } = document.read_key("import")?;
    let mut expanded = Expanded { text: Text::default(), report: ImportReport::default(), warnings: Vec::new() };
    expanded.text.text = document.room_for_imports();
    let mut camera_is_open = !has_camera;
    let mut environment_is_open = !has_environment;
    for (place, entry) in import.iter().enumerate() {
        let mut description = read(document, access, folder, entry)?;
        if camera_is_open && description.camera.is_some() {
            camera_is_open = false;
        } else if let (Some(camera), true) = (&entry.camera, has_camera) {
            let message = "the scene has a [camera], and a camera of an imported file would take its place";
            return Err(document.error(&camera.place, message).with_help("leave out one of them"));
        } else {
            description.camera = None;
        }
        description.film = Default::default();
        description.render = Default::default();
        if let Some(written) = &entry.transform {
            let transform: Transform = Resolver::new(document.clone(), folder, access.clone()).transform(written)?;
            description.place(&transform.to_affine());
        }
        environment_is_open = description.keep_environment(environment_is_open);
        replace_materials(document, entry, &mut description)?;
        description.prefix_names(&format!("{}/", prefix(&import, place)), |index| format!("{place}-{index}"));
        description.hold_in(&mut access.files, folder);
        let file_name = |file: &FileReference| match file {
            FileReference::Disk(path) => {
                std::path::absolute(path).unwrap_or_else(|_| path.clone()).to_string_lossy().into_owned()
            }
            held => description.held_path(held).to_string_lossy().into_owned(),
        };
        expanded.text.push(&description, &file_name);
        expanded.warnings.extend(description.warnings(&entry.file.value, access.strict)?);
        expanded.report.append(description.report);
    }
    Ok(Some(expanded))
}

fn read(
    document: &Document<'_>,
    access: &Access,
    folder: &std::path::Path,
    entry: &ImportEntry,
) -> Result<Description, SceneError> {
    let path = folder.join(&entry.file.value);
    if ImportFormat::of(&path).is_none() {
        let error = document.error(&entry.file.place, "an imported file ends in .gltf, .glb or .xml");
        return Err(match formats::advice(&path) {
            Some((_, advice)) => error.with_help(advice),
            None => error,
        });
    }
    if !access.files.exists(&path) {
        return Err(document.error(&entry.file.place, format!("there is no file {}", show(&path))));
    }
    let options = LoadOptions {
        definitions: entry.define.iter().map(|(key, value)| (key.clone(), value.clone())).collect(),
        camera: entry.camera.as_ref().map(|camera| camera.value.clone()),
        variant: entry.variant.as_ref().map(|variant| variant.value.clone()),
        ..LoadOptions::default()
    };
    import_file::read(&access.files, &path, &options)
}

/// Names of the file are told apart by its name, and by a number where it is imported again.
fn prefix(imports: &[ImportEntry], place: usize) -> Cow<'_, str> {
    let stem = |entry: &ImportEntry| document::stem(&entry.file.value);
    let own = stem(&imports[place]);
    match imports[..place].iter().filter(|entry| stem(entry) == own).count() {
        0 => own.into(),
        earlier => format!("{own} ({})", earlier + 1).into(),
    }
}

fn replace_materials(document: &Document<'_>, entry: &ImportEntry, description: &mut Description) -> Result<(), SceneError> {
    for (theirs, ours) in &entry.materials {
        if !description.replace_material(theirs, &ours.value) {
            let names: Vec<&str> = description.materials.iter().filter_map(|material| material.keys.text("name")).collect();
            let help = super::wording::did_you_mean_name(theirs, &names).unwrap_or_default();
            let message = format!("{} has no material named `{theirs}`", entry.file.value);
            return Err(document.error(&ours.place, message).with_help(help));
        }
    }
    Ok(())
}
