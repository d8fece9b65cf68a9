//! Renders layers: each is a render of its own, of the same samples as the picture, by kernels that make it in place of radiance. So the kernels
//! of a picture without layers are what they are, and the film, its sums and its passes are the same for all.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;

use super::checkpoint::Checkpoint;
use super::cryptomatte;
use super::options::RenderOptions;
use super::stream::Renderer;
use crate::cpu::ReferenceRenderer;
use crate::film::{Band, KernelLayer, Layer};
use crate::output::{LayerChannel, LayerPicture};
use crate::plan::PlanOptions;
use crate::reference::layer::layer_scene;
use crate::renderer::{Observer, RenderError};
use crate::scene::{Guiding, LightChoice, Scene};

/// Gives the checkpoint of a layer that is about to be rendered, if it shall have one.
pub type LayerCheckpoints<'a, E> = &'a mut dyn FnMut(&Renderer, KernelLayer) -> Result<Option<Checkpoint>, E>;

/// A rendered layer: means, their rounding errors, and how many samples they are over. Only parts need the
/// last two.
struct Rendered {
    kernel: KernelLayer,
    means: Arc<LayerPicture>,
    of_part: Option<[Arc<LayerPicture>; 2]>,
}

/// Renders the layers that are wanted of a scene, with the options of its picture, or of the region of it that they name; their channels. With
/// `of_part`, there are also those that joining parts needs. None where the observer stopped it; `checkpoint` then has how far it came.
///
/// # Errors
/// Errors of the device, of temporary files, and of `checkpoint`.
pub fn render_layers<E: From<RenderError>>(
    scene: &Scene,
    options: &RenderOptions,
    (wanted, of_part): (&[Layer], bool),
    observer: &dyn Observer,
    checkpoint: LayerCheckpoints<'_, E>,
) -> Result<Option<Vec<LayerChannel>>, E> {
    let region = options.crop.unwrap_or([0, 0, scene.film.size[0], scene.film.size[1]]);
    let mut rendered: Vec<Rendered> = Vec::new();
    let mut channels: Vec<LayerChannel> = Vec::new();
    for &layer in wanted {
        if layer == Layer::Cryptomatte {
            let Some(mattes) = cryptomatte::mattes(scene, region, observer)? else { return Ok(None) };
            LayerChannel::add_new(&mut channels, mattes);
            continue;
        }
        let Some(kernel) = layer.kernel() else {
            let picture = if layer == Layer::Ids { Some(ids(scene, region).map_err(E::from)?) } else { None };
            LayerChannel::add_new(&mut channels, LayerChannel::of(layer, picture.as_ref()));
            continue;
        };
        let index = match rendered.iter().position(|one| one.kernel == kernel) {
            Some(index) => index,
            None => {
                let Some(one) = render_layer(scene, options, (kernel, of_part), observer, checkpoint)? else { return Ok(None) };
                rendered.push(one);
                rendered.len() - 1
            }
        };
        let Rendered { means, of_part, .. } = &rendered[index];
        LayerChannel::add_new(&mut channels, LayerChannel::of(layer, Some(means)));
        if let Some([remainders, counts]) = of_part {
            LayerChannel::add_new(&mut channels, LayerChannel::of_part(kernel, [means, remainders, counts]));
        }
    }
    Ok(Some(channels))
}

fn render_layer<E: From<RenderError>>(
    scene: &Scene,
    options: &RenderOptions,
    (layer, of_part): (KernelLayer, bool),
    observer: &dyn Observer,
    checkpoint: LayerCheckpoints<'_, E>,
) -> Result<Option<Rendered>, E> {
    let plan = PlanOptions { layer: Some(layer), ..options.plan.clone() };
    let of_layer =
        RenderOptions { plan, time_limit: None, target_error: None, adaptive: false, interval: None, ..options.clone() };
    let center = if layer == KernelLayer::Position { scene.center() } else { DVec3::ZERO };
    let scene = layer_scene(scene, layer);
    let mut renderer = Renderer::on(Renderer::begin(&of_layer), &scene, &of_layer)?;
    let picture = || LayerPicture::new(renderer.size()).map(Arc::new).map_err(RenderError::from);
    let means = picture()?;
    let others = if of_part { Some([picture()?, picture()?]) } else { None };
    let samples = scene.render.spp;
    let mut kept = checkpoint(&renderer, layer)?;
    let outcome = renderer.render_from(Instant::now(), observer, kept.as_mut(), &mut |band: Band| {
        let count = |pixel: usize| band.counts.as_ref().map_or(band.samples, |counts| counts[pixel]);
        // Positions were relative to it.
        let moved = |pixel: usize| if count(pixel) > 0 { center } else { DVec3::ZERO };
        let values: Vec<[f32; 3]> = band
            .mean
            .iter()
            .enumerate()
            .map(|(pixel, &mean)| match layer {
                KernelLayer::Depth => [mean[0], count(pixel) as f32 / samples as f32, 0.0],
                KernelLayer::Position => (moved(pixel) + wide(mean)).as_vec3().to_array(),
                _ => mean,
            })
            .collect();
        means.write_rows(band.first_row, &values)?;
        let Some([remainders, counts]) = &others else { return Ok(()) };
        let rests: Vec<[f32; 3]> = values
            .iter()
            .zip(&band.mean)
            .enumerate()
            .map(|(pixel, (&value, &mean))| {
                let rest = band.remainder.get(pixel).copied().unwrap_or_default();
                match layer {
                    KernelLayer::Position => (moved(pixel) + wide(mean) + wide(rest) - wide(value)).as_vec3().to_array(),
                    _ => rest,
                }
            })
            .collect();
        remainders.write_rows(band.first_row, &rests)?;
        let of_pixels: Vec<[f32; 3]> = (0..band.mean.len()).map(|pixel| [count(pixel) as f32, 0.0, 0.0]).collect();
        counts.write_rows(band.first_row, &of_pixels)
    })?;
    Ok((!outcome.report.interrupted).then_some(Rendered { kernel: layer, means, of_part: others }))
}

fn wide(values: [f32; 3]) -> DVec3 {
    DVec3::from_array(values.map(f64::from))
}

/// The identifiers at the pixels' centres. Numbers cannot be averaged; one ray a pixel is soon traced by the
/// CPU.
fn ids(scene: &Scene, [left, top, width, height]: [u32; 4]) -> Result<Arc<LayerPicture>, RenderError> {
    // The rays through the pixels' centres need no guide.
    let mut unguided = scene.clone();
    unguided.render.guiding = Guiding::Off;
    unguided.render.light_choice = LightChoice::Power;
    let reference = ReferenceRenderer::new(&unguided)?;
    let picture = LayerPicture::new([width, height])?;
    for y in 0..height {
        let row: Vec<[f32; 3]> = (0..width)
            .map(|x| reference.ids(left + x, top + y))
            .map(|[object, material]| [object as f32, material as f32, 0.0])
            .collect();
        picture.write_rows(y, &row)?;
    }
    Ok(Arc::new(picture))
}
