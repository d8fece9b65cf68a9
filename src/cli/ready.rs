//! The device or the renderer that the next picture begins with.

use gpt::device::ChosenDevice;
use gpt::renderer::RenderError;
use gpt::scene::BulkDigest;
use gpt::{RenderOptions, Renderer, Scene};

/// The means to begin a frame with.
pub enum Ready {
    /// The first one: a device that may still be opening.
    Device(ChosenDevice),
    /// A later one: the renderer of the frame before, and that frame.
    Renderer(Box<Renderer>, Box<Scene>),
    /// The renderer of another scene, and that scene.
    Other(Box<Renderer>, Box<Scene>),
}

impl Ready {
    /// Makes a frame ready.
    ///
    /// # Errors
    /// The errors of [`Renderer::on`].
    pub fn renderer(self, scene: &Scene, options: &RenderOptions) -> Result<Renderer, RenderError> {
        match self {
            Self::Device(choice) => Renderer::on(choice, scene, options),
            Self::Renderer(renderer, before) => renderer.at_frame(&before, scene),
            Self::Other(renderer, before) => renderer.with_scene(&before, scene),
        }
    }

    /// These means for a frame of another scene.
    pub fn for_another_scene(self) -> Self {
        match self {
            Self::Renderer(renderer, before) => Self::Other(renderer, before),
            ready => ready,
        }
    }

    /// The digest of an earlier frame's meshes, where this scene has the same ones.
    pub fn bulk_digest(&self, scene: &Scene) -> Option<&BulkDigest> {
        match self {
            Self::Device(_) | Self::Other(..) => None,
            Self::Renderer(renderer, before) => scene.has_meshes_of(before).then(|| renderer.bulk_digest()),
        }
    }
}
