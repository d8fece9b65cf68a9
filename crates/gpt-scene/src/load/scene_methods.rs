//! The methods by which users of the library make a scene.

use std::path::Path;

use super::error::SceneError;
use super::scene_file::load_toml_str;
use super::source;
use crate::scene::Scene;

/// The name of a scene that has no file.
const UNNAMED: &str = "scene";

impl Scene {
    /// Reads a scene file (`.toml`), a model (`.obj` or `.ply`, which is put in front of a camera), or a built-in scene by its name, such as `cornell`.
    ///
    /// # Errors
    /// A mistake in a file, and files that cannot be read.
    pub fn load(scene: &str) -> Result<Self, SceneError> {
        source::load(Some(scene))
    }

    /// Reads a scene from the text of a scene file. Paths in it are relative to the current folder.
    ///
    /// # Errors
    /// The errors of [`Scene::load`].
    pub fn from_toml(text: &str) -> Result<Self, SceneError> {
        load_toml_str(text, UNNAMED, Path::new(""))
    }
}
