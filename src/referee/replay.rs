//! Renders of the suite's scenes by this program, for truths that no formula tells and for the pictures of mistakes.

use std::path::Path;

use super::picture::{SceneFile, TruthPicture};
use crate::cpu::ReferenceRenderer;
use crate::load::{self, SceneError};
use crate::renderer::{Batch, RenderRequest, Renderer, Silent};
use crate::scene::Scene;

/// Renders of which mean and standard error are taken.
pub const PARTS: u32 = 16;

/// Why a scene of the suite gives no picture.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error("a temporary folder: {0}")]
    Folder(#[from] std::io::Error),
    #[error(transparent)]
    Render(#[from] crate::renderer::RenderError),
}

/// Reads a scene of the suite, whose files are written to `folder`.
///
/// # Errors
/// The scene is wrong, or the folder cannot be written.
pub fn load_scene(name: &str, text: &str, files: &[SceneFile], folder: &Path) -> Result<Scene, ReplayError> {
    for file in files {
        std::fs::write(folder.join(file.name), &file.bytes)?;
    }
    Ok(load::load_toml_str(text, name, folder)?)
}

/// Mean and standard error over [`PARTS`] renders of `spp` samples each.
///
/// # Errors
/// Errors of the device.
pub fn measure(renderer: &mut dyn Renderer, size: [u32; 2], seed: u32, spp: u32) -> Result<TruthPicture, ReplayError> {
    let [width, height] = size;
    let mut parts: Vec<Vec<[f32; 3]>> = Vec::new();
    for part in 0..PARTS {
        renderer.set_samples_per_pixel(spp);
        let request = RenderRequest { rows: 0..height, samples: 0..spp };
        let batch = Batch { seed: Some(seed.wrapping_mul(1000).wrapping_add(part)), ..Batch::of(&request) };
        let mut pixels = Vec::new();
        renderer.render_batch(&batch, &Silent, &mut |band| {
            pixels.extend(band.mean);
            Ok(())
        })?;
        parts.push(pixels);
    }
    let of_pixel = |pixel: usize, channel: usize| -> crate::compare::Moments {
        parts.iter().map(|part| f64::from(part[pixel][channel])).collect()
    };
    let pixels = 0..width as usize * height as usize;
    let moments: Vec<[_; 3]> = pixels.map(|pixel| std::array::from_fn(|channel| of_pixel(pixel, channel))).collect();
    Ok(TruthPicture {
        width,
        height,
        mean: moments.iter().map(|channels| channels.map(|channel| channel.mean() as f32)).collect(),
        standard_errors: moments.iter().map(|channels| channels.map(|channel| channel.standard_error() as f32)).collect(),
    })
}

/// The picture of a scene by the reference, in [`PARTS`] renders of `spp` samples each.
///
/// # Errors
/// The scene is wrong.
pub fn by_reference(name: &str, text: &str, files: &[SceneFile], spp: u32) -> Result<TruthPicture, ReplayError> {
    let folder = tempfile::tempdir()?;
    let scene = load_scene(name, text, files, folder.path())?;
    let size = scene.film.size;
    measure(&mut ReferenceRenderer::new(&scene)?, size, 1, spp)
}
