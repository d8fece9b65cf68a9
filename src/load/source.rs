//! Where scenes come from: a file, a model, a name.

use std::path::{Path, PathBuf};

use super::builtin::{FOLDER, builtin_names, builtin_text};
use super::error::{SceneError, show};
use super::{file, framing};
use crate::scene::Scene;

/// What a person named as the scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SceneSource {
    /// A scene that is part of the program, by its name.
    BuiltIn(&'static str),
    /// A scene file (`.toml`).
    File(PathBuf),
    /// A model (`.obj`), which is framed by itself.
    Model(PathBuf),
}

impl SceneSource {
    /// Tells the source from what was written: a path by its ending `.toml` or `.obj`, else a built-in scene's name; nothing is the
    /// default scene, `cornell`.
    pub fn parse(written: Option<&str>) -> Result<Self, SceneError> {
        let Some(written) = written else { return Ok(Self::BuiltIn("cornell")) };
        let path = Path::new(written);
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        match ending.as_deref() {
            Some("toml") => return Ok(Self::File(path.to_owned())),
            Some("obj") => return Ok(Self::Model(path.to_owned())),
            _ => {}
        }
        if let Some(name) = builtin_names().find(|name| *name == written) {
            return Ok(Self::BuiltIn(name));
        }
        let what = if path.exists() { "is neither a scene file nor a model" } else { "is no built-in scene" };
        let names: Vec<&str> = builtin_names().collect();
        let help = file::did_you_mean(written, &names).unwrap_or_default();
        Err(SceneError::in_file(written, what).with_help(format!("{help}; or a file that ends in .toml or .obj")))
    }

    /// Reads the scene.
    pub fn load(&self) -> Result<Scene, SceneError> {
        match self {
            Self::BuiltIn(name) => {
                let text = builtin_text(name).ok_or_else(|| SceneError::in_file(name, "is no built-in scene"))?;
                file::load_toml_str(text, name, Path::new(FOLDER))
            }
            Self::File(path) => {
                let name = show(path);
                let bytes =
                    std::fs::read(path).map_err(|error| SceneError::in_file(&name, format!("cannot be read: {error}")))?;
                let text = String::from_utf8(bytes)
                    .map_err(|error| SceneError::in_file(&name, format!("is not a text in UTF-8: {error}")))?;
                file::load_toml_str(&text, &name, path.parent().unwrap_or(Path::new("")))
            }
            Self::Model(path) => {
                let mut scene = file::load_model(path)?;
                scene.name = super::file::stem(&show(path));
                framing::frame(scene, &show(path))
            }
        }
    }
}

/// Reads the scene a person named: a `.toml` file, an `.obj` model, or a built-in scene; `cornell` where nothing is named.
pub fn load(written: Option<&str>) -> Result<Scene, SceneError> {
    SceneSource::parse(written)?.load()
}
