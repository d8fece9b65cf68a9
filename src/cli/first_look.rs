//! A first look at a picture with layers: a few samples of it and of its layers. All samples of the layers come before the picture's, and whoever
//! watches would see nothing until then.

use gpt::film::Layer;
use gpt::render::layers::render_layers;
use gpt::{RenderOptions, Scene};

use super::exit::Failure;
use super::layers::names_of_groups;
use super::ready::Ready;
use super::view::{Live, Watching};

/// Samples per pixel of it.
const SAMPLES: u32 = 4;

/// Shows it where somebody watches a picture with layers. What rendered it is ready for the rest.
///
/// # Errors
/// Errors of the device and the temporary files.
pub fn show(
    (live, watching): (&Live, &Watching<'_>),
    ready: Ready,
    (scene, options): (&Scene, &RenderOptions),
    layers: &[Layer],
) -> Result<Ready, Failure> {
    if !live.is_shown() || layers.is_empty() {
        return Ok(ready);
    }
    let mut renderer = ready.renderer(scene, options)?;
    live.on_device(renderer.device());
    renderer.render_first(SAMPLES, &watching.in_advance(), &mut |band| {
        watching.band(&band);
        Ok(())
    })?;
    // Mattes are not shown.
    let shown: Vec<Layer> = layers.iter().copied().filter(|layer| *layer != Layer::Cryptomatte).collect();
    let mut few = scene.clone();
    few.render.spp = few.render.spp.min(SAMPLES);
    let observer = watching.in_advance().without_rows();
    let channels = render_layers(&few, options, (&shown, false), &observer, &mut |_, _| Ok::<_, Failure>(None))?;
    if let Some(channels) = channels {
        live.layers(&channels, renderer.size(), names_of_groups(&shown, scene));
    }
    Ok(Ready::Renderer(Box::new(renderer), Box::new(scene.clone())))
}
