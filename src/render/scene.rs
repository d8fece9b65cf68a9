//! The whole picture of a scene.

use super::image::Image;
use super::options::RenderOptions;
use super::stream::Renderer;
use crate::error::Error;
use crate::renderer::Silent;
use crate::scene::Scene;

/// Methods of a [`Scene`] that render it.
pub trait Render {
    /// Renders the whole picture. [`Renderer`] is for pictures larger than memory, for progress, and for several renders of one scene.
    ///
    /// # Errors
    /// Options that contradict each other, a device that is missing or too small for the scene, a device that fails.
    fn render(&self, options: &RenderOptions) -> Result<Image, Error>;
}

impl Render for Scene {
    fn render(&self, options: &RenderOptions) -> Result<Image, Error> {
        Renderer::new(self, options)?.image(&Silent)
    }
}
