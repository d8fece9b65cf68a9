//! Scenes from scene files with what they import, from imported files, and from models.

use std::borrow::Cow;
use std::path::Path;

use super::access::{Access, LoadOptions};
use super::error::{SceneError, show};
use super::file::import::ImportEntry;
use super::file::syntax::SceneFile;
use super::file::{Document, did_you_mean_name, resolve, resolve_model, resolve_transform, stem};
use super::formats;
use super::import::Description;
use super::import_file::{self, ImportFormat};
use crate::scene::{ImportReport, Scene};

/// Reads a scene from TOML text. `name` is what errors call it and what the scene's name is taken from; paths in the text are
/// relative to `folder`.
pub fn load_toml_str(text: &str, name: &str, folder: &Path) -> Result<Scene, SceneError> {
    load_toml(text, name, folder, Access::default())
}

/// [`load_toml_str`] with this access to other files.
pub fn load_toml(text: &str, name: &str, folder: &Path, access: Access) -> Result<Scene, SceneError> {
    let document = Document::new(name, text);
    let mut file: SceneFile = document.read_whole()?;
    let imported = expand(&document, &mut file, folder, &access)?;
    if file.camera.is_none() {
        return Err(document.error(&(0..text.len()).into(), "the key `camera` is missing"));
    }
    load_file(document, file, folder, imported, access)
}

/// Reads a scene that was imported.
pub fn load_description(description: Description, name: &str, access: Access) -> Result<Scene, SceneError> {
    let warnings = description.warnings(name, access.strict)?;
    let imported = Imported { report: description.report, warnings };
    load_file(Document::new(name, ""), description.file, Path::new(""), imported, access)
}

/// Reads a model file alone: its meshes in a scene without a camera of its own and without lights. They have their own materials, or the last
/// one of a scene file's text: `materials` are what errors call that file, its text, and the folder that paths in it are relative to.
pub fn load_model(
    path: &Path,
    smooth: Option<bool>,
    materials: Option<(&str, &str, &Path)>,
    access: Access,
) -> Result<Scene, SceneError> {
    let materials = materials.map(|(name, text, folder)| (Document::new(name, text), folder));
    resolve_model(path, smooth, materials, access)
}

/// Reports of the imports.
#[derive(Default)]
struct Imported {
    report: ImportReport,
    warnings: Vec<String>,
}

fn load_file<'a>(
    document: Document<'a>,
    file: SceneFile,
    folder: &'a Path,
    imported: Imported,
    access: Access,
) -> Result<Scene, SceneError> {
    let name = document.name;
    let mut scene = resolve(document.without_tree(), folder, file, access)?;
    scene.name = stem(name);
    if !scene.has_light() {
        let message = "nothing in the scene gives light, so the picture would be black";
        return Err(
            SceneError::in_file(name, message).with_help("add a [[light]], or a material of type \"emissive\" that a shape uses")
        );
    }
    scene.warnings.splice(0..0, imported.warnings);
    let of_boundaries = scene.boundary_warnings();
    scene.warnings.extend(of_boundaries);
    scene.import_report = imported.report;
    Ok(scene)
}

/// Adds the entries of all that a file imports to its own.
fn expand(document: &Document<'_>, file: &mut SceneFile, folder: &Path, access: &Access) -> Result<Imported, SceneError> {
    let imports = std::mem::take(&mut file.import);
    let mut imported = Imported::default();
    let has_camera = file.camera.is_some();
    let mut environment_is_open = !file.light.iter().any(|light| light.value.is_environment());
    for (index, entry) in imports.iter().enumerate() {
        let mut description = read(document, access, folder, entry)?;
        if let (Some(camera), true, true) = (&entry.camera, has_camera, description.file.camera.is_some()) {
            let message = "the scene has a [camera], and a camera of an imported file would take its place";
            return Err(document.error(&camera.place, message).with_help("leave out one of them"));
        }
        if let Some(written) = &entry.transform {
            let map = resolve_transform(document, written)?.to_affine();
            description.transform_by(&map, &written.place).map_err(|message| document.error(&written.place, message))?;
        }
        environment_is_open = description.keep_environment(environment_is_open);
        description.prefix_names(&format!("{}/", prefix(&imports, index)));
        replace_materials(document, entry, &format!("{}/", prefix(&imports, index)), &mut description)?;
        if let Some(receiver) = &entry.receiver {
            description.set_receiver(receiver);
        }
        imported.warnings.extend(description.warnings(&entry.file.value, access.strict)?);
        let SceneFile { camera, node, texture, medium, material, shape, group, instance, light, meter, .. } = description.file;
        file.camera = file.camera.take().or(camera);
        file.node.extend(node);
        file.texture.extend(texture);
        file.medium.extend(medium);
        file.material.extend(material);
        file.shape.extend(shape);
        file.group.extend(group);
        file.instance.extend(instance);
        file.light.extend(light);
        file.meter.extend(meter);
        imported.report.append(description.report);
    }
    Ok(imported)
}

fn read(document: &Document<'_>, access: &Access, folder: &Path, entry: &ImportEntry) -> Result<Description, SceneError> {
    let path = folder.join(&entry.file.value);
    if ImportFormat::of(&path).is_none() {
        let error = document.error(&entry.file.place, "an imported file ends in .gltf, .glb, .xml or .pbrt");
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

/// The name of an imported file, by which its names are told apart, and a number where it is imported again.
fn prefix(imports: &[ImportEntry], index: usize) -> Cow<'_, str> {
    let stem = |entry: &ImportEntry| stem(&entry.file.value);
    let own = stem(&imports[index]);
    match imports[..index].iter().filter(|entry| stem(entry) == own).count() {
        0 => own.into(),
        earlier => format!("{own} ({})", earlier + 1).into(),
    }
}

fn replace_materials(
    document: &Document<'_>,
    entry: &ImportEntry,
    prefix: &str,
    description: &mut Description,
) -> Result<(), SceneError> {
    for (theirs, ours) in &entry.materials {
        if !description.replace_material(&format!("{prefix}{theirs}"), ours) {
            let names = description.file.material.iter().filter_map(|material| material.name().strip_prefix(prefix));
            let help = did_you_mean_name(theirs, &names.collect::<Vec<_>>()).unwrap_or_default();
            let message = format!("{} has no material named `{theirs}`", entry.file.value);
            return Err(document.error(&ours.place, message).with_help(help));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str =
        "[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\nvfov = 40\n[[light]]\ntype = \"environment\"\nradiance = 1\n";

    #[test]
    fn a_newer_version_of_the_format_is_refused_before_its_keys() {
        let load = |head: &str| load_toml_str(&format!("{head}\n{SCENE}"), "a.toml", Path::new(""));
        assert!(load("").is_ok() && load("version = 1").is_ok());
        let error = load("version = 2\nunheard_of = true").expect_err("it is newer");
        assert_eq!((error.line(), error.key()), (Some(1), Some("version")));
        assert!(error.message().contains("version 2") && error.message().contains("take a newer gpt"), "{error}");
        assert_eq!(error.others().len(), 0, "other keys of another version are not judged");
        for head in ["version = 0", "version = -1", "version = \"1\""] {
            assert!(load(head).is_err(), "{head}");
        }
        assert!(load("unheard_of = true").is_err(), "the control");
    }

    #[test]
    fn a_camera_is_missed_where_no_import_brings_one() {
        let error = load_toml_str("[film]\nsize = [4, 4]\n", "a.toml", Path::new("")).expect_err("it has none");
        assert_eq!(error.message(), "the key `camera` is missing");
    }
}
