//! Sources of scenes: a file, a model, a name.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::access::{Access, LoadOptions};
use super::builtin::FOLDER;
use super::builtin_scenes::{builtin_names, builtin_text};
use super::error::{SceneError, show};
use super::files::MOST_SCENE_BYTES;
use super::model::ModelFormat;
use super::view::ModelView;
use super::{encoding, file, formats, framing, import_file, memory, presets, scene_file};
use crate::input;
use crate::scene::Scene;

/// The scene that a person named.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SceneSource {
    /// A scene that is part of the program, by its name.
    BuiltIn(&'static str),
    /// A scene file on the standard input (`-`).
    StandardInput,
    /// A scene file (`.toml`).
    File(PathBuf),
    /// A model (`.obj`, `.ply`), which is framed by itself.
    Model(PathBuf),
    /// A scene of another program (`.gltf`, `.glb`, `.xml`, `.pbrt`).
    Import(PathBuf),
}

impl SceneSource {
    /// Tells the source from what was written: a path by its ending, else a built-in scene's name; `-` is the standard
    /// input, and nothing is the default scene, `cornell`.
    pub fn parse(written: Option<&OsStr>) -> Result<Self, SceneError> {
        let Some(written) = written else { return Ok(Self::BuiltIn("cornell")) };
        let path = Path::new(written);
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        match ending.as_deref() {
            Some("toml") => return Ok(Self::File(path.to_owned())),
            _ if ModelFormat::of(path).is_some() => return Ok(Self::Model(path.to_owned())),
            _ if import_file::ImportFormat::of(path).is_some() => return Ok(Self::Import(path.to_owned())),
            _ if written == "-" => return Ok(Self::StandardInput),
            _ => {}
        }
        let name = written.to_string_lossy();
        if let Some(name) = builtin_names().find(|builtin| *builtin == name) {
            return Ok(Self::BuiltIn(name));
        }
        if let Some((what, advice)) = formats::advice(path) {
            let message = format!("is {what}; what is read are {}", formats::SCENES);
            return Err(SceneError::in_file(show(path), message).with_help(advice));
        }
        let what = if path.exists() { "is neither a scene file nor a model" } else { "is no built-in scene" };
        let names: Vec<&str> = builtin_names().collect();
        let help = file::did_you_mean(&name, &names).unwrap_or_default();
        Err(SceneError::in_file(show(path), what)
            .with_help(format!("{help}; or a file that ends in .toml, .gltf, .glb, .xml, .pbrt, {}", formats::MODEL_ENDINGS)))
    }

    /// Reads the scene, and puts the environment that is asked for in the place of its own.
    pub fn load(&self, options: &LoadOptions) -> Result<Scene, SceneError> {
        let mut scene = self.load_as_it_is(options)?;
        if let Some(map) = &options.view.environment {
            framing::light_by(&mut scene, map, options.access()?)?;
        }
        if let Some(preset) = options.preset {
            scene.see_by(preset);
        }
        Ok(scene)
    }

    fn load_as_it_is(&self, options: &LoadOptions) -> Result<Scene, SceneError> {
        let access = options.access()?;
        match self {
            Self::BuiltIn(name) => {
                let text = builtin_text(name).ok_or_else(|| SceneError::in_file(name, "is no built-in scene"))?;
                scene_file::load_toml(text, name, Path::new(FOLDER), access)
            }
            Self::StandardInput => {
                let read = input::read_to_end(std::io::stdin().lock(), 0, most_scene_bytes());
                load_bytes(read, "stdin", Path::new(""), access)
            }
            Self::File(path) => {
                let read = access.files.log().read(path, most_scene_bytes());
                load_bytes(read, &show(path), path.parent().unwrap_or(Path::new("")), access)
            }
            Self::Model(path) => {
                let mut scene = load_model(path, &options.view, access)?;
                scene.name = super::file::stem(&show(path));
                framing::frame(scene, &show(path), &options.view)
            }
            Self::Import(path) => {
                let description = import_file::load(&access.files, path, options)?;
                scene_file::load_description(description, &show(path), access)
            }
        }
    }

    /// True of a model, which has neither camera nor light.
    pub fn is_model(&self) -> bool {
        matches!(self, Self::Model(_))
    }
}

/// Reads a model with the material that is asked for.
fn load_model(path: &Path, view: &ModelView, access: Access) -> Result<Scene, SceneError> {
    let Some(material) = &view.material else { return scene_file::load_model(path, view.smooth, None, access) };
    let library = Path::new(material);
    if library.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
        let read = access.files.log().read(library, most_scene_bytes());
        let bytes = read.map_err(|error| SceneError::in_file(show(library), format!("cannot be read: {error}")))?;
        let (text, _) = encoding::decode(&bytes);
        let folder = library.parent().unwrap_or(Path::new(""));
        return scene_file::load_model(path, view.smooth, Some((&show(library), &text, folder)), access);
    }
    let Some(text) = presets::preset(material) else {
        let names: Vec<&str> = presets::preset_names().collect();
        let help = file::did_you_mean(material, &names).unwrap_or_default();
        return Err(
            SceneError::in_file(material, "is no material").with_help(format!("{help}; or a .toml file with a [[material]]"))
        );
    };
    scene_file::load_model(path, view.smooth, Some((material, text, Path::new(""))), access)
}

/// Size of the largest scene file that can be parsed in the free memory: the tree of a text takes a hundred
/// times as much at worst.
fn most_scene_bytes() -> u64 {
    MOST_SCENE_BYTES.min(memory::available() / 100)
}

fn load_bytes(read: std::io::Result<Vec<u8>>, name: &str, folder: &Path, access: Access) -> Result<Scene, SceneError> {
    let bytes = read.map_err(|error| SceneError::in_file(name, format!("cannot be read: {error}")))?;
    match encoding::decode(&bytes) {
        (text, None) => scene_file::load_toml(&text, name, folder, access),
        (_, Some(encoding)) => {
            let message = format!("is not a text in UTF-8 but, as it seems, in {encoding}");
            Err(SceneError::in_file(name, message).with_help("save it as UTF-8"))
        }
    }
}

/// Reads the scene a person named: a `.toml` file, an `.obj` or `.ply` model, a glTF `.gltf` or `.glb`, a Mitsuba `.xml`, a `.pbrt`, or a built-in scene; `cornell` where nothing is named.
pub fn load(written: Option<&str>) -> Result<Scene, SceneError> {
    load_with(written.map(OsStr::new), &LoadOptions::default())
}

/// Reads a scene file whose text is this one, whatever is written there: paths in the text are relative to its folder, and errors call it by this path.
pub fn load_file_text(path: &Path, text: &str, options: &LoadOptions) -> Result<Scene, SceneError> {
    scene_file::load_toml(text, &show(path), path.parent().unwrap_or(Path::new("")), options.access()?)
}

/// [`load`], with `-` for the standard input.
pub fn load_with(written: Option<&OsStr>, options: &LoadOptions) -> Result<Scene, SceneError> {
    SceneSource::parse(written)?.load(options)
}
