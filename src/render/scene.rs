//! The methods of a scene for users of the crate.

use std::path::Path;

use super::image::Image;
use super::options::RenderOptions;
use super::stream::Renderer;
use crate::error::Error;
use crate::load;
use crate::renderer::Silent;
use crate::scene::Scene;

/// The name of a scene that has no file.
const UNNAMED: &str = "scene";

impl Scene {
    /// Reads a scene file (`.toml`), a model (`.obj` or `.ply`, which is put in front of a camera), or a built-in scene by its name, such as `cornell`.
    ///
    /// # Errors
    /// [`Error::Scene`].
    pub fn load(scene: &str) -> Result<Self, Error> {
        Ok(load::load(Some(scene))?)
    }

    /// Reads a scene from the text of a scene file. Paths in it are relative to the current folder.
    ///
    /// # Errors
    /// [`Error::Scene`].
    pub fn from_toml(text: &str) -> Result<Self, Error> {
        Ok(load::load_toml_str(text, UNNAMED, Path::new(""))?)
    }

    /// Renders the whole picture. [`Renderer`] is for pictures larger than memory, for progress, and for several renders of one scene.
    ///
    /// # Errors
    /// Options that contradict each other, a device that is missing or too small for the scene, a device that fails.
    pub fn render(&self, options: &RenderOptions) -> Result<Image, Error> {
        Renderer::new(self, options)?.image(&Silent)
    }
}
