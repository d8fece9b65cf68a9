//! Renders layers: each is a render of its own, of the same samples as the picture, by kernels that make it in place of radiance. So the kernels
//! of a picture without layers are what they are, and the film, its sums and its passes are the same for all.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

use super::cryptomatte;
use super::options::RenderOptions;
use super::stream::Renderer;
use crate::film::{Band, KernelLayer, Layer};
use crate::output::{LayerChannel, LayerPicture, LayerSource};
use crate::plan::PlanOptions;
use crate::reference::ReferenceRenderer;
use crate::reference::layer::layer_scene;
use crate::renderer::{Observer, RenderError};
use crate::scene::Scene;

/// What has to be rendered for a layer; None: nothing besides the picture, or not by samples.
fn kernel_layer(layer: Layer) -> Option<KernelLayer> {
    match layer {
        Layer::Albedo => Some(KernelLayer::Albedo),
        Layer::Normal => Some(KernelLayer::Normal),
        Layer::Position => Some(KernelLayer::Position),
        Layer::Depth | Layer::Alpha => Some(KernelLayer::Depth),
        Layer::Variance => Some(KernelLayer::Squares),
        Layer::Direct => Some(KernelLayer::Direct),
        Layer::Indirect => Some(KernelLayer::Indirect),
        Layer::Emission => Some(KernelLayer::Emission),
        Layer::Samples | Layer::Ids | Layer::Cryptomatte => None,
    }
}

/// Renders the layers that are wanted of a scene, with the options of its picture; their channels. None where the observer stopped it.
///
/// # Errors
/// What the device reports, and what temporary files do.
pub fn render_layers(
    scene: &Scene,
    options: &RenderOptions,
    wanted: &[Layer],
    observer: &dyn Observer,
) -> Result<Option<Vec<LayerChannel>>, RenderError> {
    let mut pictures: BTreeMap<&'static str, Arc<LayerPicture>> = BTreeMap::new();
    let mut channels: Vec<LayerChannel> = Vec::new();
    for &layer in wanted {
        if layer == Layer::Cryptomatte {
            let Some(mattes) = cryptomatte::mattes(scene, observer)? else { return Ok(None) };
            channels.extend(
                mattes.into_iter().filter(|matte| channels.iter().all(|other| other.name != matte.name)).collect::<Vec<_>>(),
            );
            continue;
        }
        let picture = match kernel_layer(layer) {
            Some(kernel) => match pictures.get(kernel.switches()[0]) {
                Some(picture) => Some(picture.clone()),
                None => {
                    let Some(picture) = render_layer(scene, options, kernel, observer)? else { return Ok(None) };
                    pictures.insert(kernel.switches()[0], picture.clone());
                    Some(picture)
                }
            },
            None if layer == Layer::Ids => Some(ids(scene)?),
            None => None,
        };
        for channel in channels_of(layer, picture.as_ref()) {
            // A layer may be asked for twice.
            if channels.iter().all(|other| other.name != channel.name) {
                channels.push(channel);
            }
        }
    }
    Ok(Some(channels))
}

fn channels_of(layer: Layer, picture: Option<&Arc<LayerPicture>>) -> Vec<LayerChannel> {
    let Some(picture) = picture else { return vec![LayerChannel { name: "SampleCount", source: LayerSource::Count }] };
    let components = |names: &[&'static str]| -> Vec<LayerChannel> {
        let source = |place| LayerSource::Component(picture.clone(), place);
        names.iter().enumerate().map(|(place, name)| LayerChannel { name, source: source(place) }).collect()
    };
    match layer {
        Layer::Albedo => components(&["Albedo.R", "Albedo.G", "Albedo.B"]),
        Layer::Normal => components(&["N.X", "N.Y", "N.Z"]),
        Layer::Position => components(&["P.X", "P.Y", "P.Z"]),
        Layer::Direct => components(&["Direct.R", "Direct.G", "Direct.B"]),
        Layer::Indirect => components(&["Indirect.R", "Indirect.G", "Indirect.B"]),
        Layer::Emission => components(&["Emission.R", "Emission.G", "Emission.B"]),
        Layer::Depth => components(&["Z"]),
        // Beside the depth stands how many of the samples met a surface.
        Layer::Alpha => vec![LayerChannel { name: "A", source: LayerSource::Component(picture.clone(), 1) }],
        Layer::Variance => ["Variance.R", "Variance.G", "Variance.B"]
            .into_iter()
            .enumerate()
            .map(|(place, name)| LayerChannel { name, source: LayerSource::Variance(picture.clone(), place) })
            .collect(),
        Layer::Ids => ["ObjectId", "MaterialId"]
            .into_iter()
            .enumerate()
            .map(|(place, name)| LayerChannel { name, source: LayerSource::Whole(picture.clone(), place) })
            .collect(),
        Layer::Samples | Layer::Cryptomatte => Vec::new(),
    }
}

fn render_layer(
    scene: &Scene,
    options: &RenderOptions,
    layer: KernelLayer,
    observer: &dyn Observer,
) -> Result<Option<Arc<LayerPicture>>, RenderError> {
    let plan = PlanOptions { layer: Some(layer), ..options.plan.clone() };
    let of_layer = RenderOptions { plan, time_limit: None, target_error: None, adaptive: false, ..options.clone() };
    let center = if layer == KernelLayer::Position { scene.center() } else { glam::DVec3::ZERO };
    let scene = layer_scene(scene, layer);
    let mut renderer = Renderer::on(Renderer::begin(&of_layer), &scene, &of_layer)?;
    let picture = Arc::new(LayerPicture::new(scene.film.size)?);
    let samples = scene.render.spp;
    let outcome = renderer.render_from(Instant::now(), observer, None, &mut |band: Band| {
        let count = |pixel: usize| band.counts.as_ref().map_or(band.samples, |counts| counts[pixel]);
        let values: Vec<[f32; 3]> = band
            .mean
            .iter()
            .enumerate()
            .map(|(pixel, &mean)| match layer {
                KernelLayer::Depth => [mean[0], count(pixel) as f32 / samples as f32, 0.0],
                // Positions were relative to it.
                KernelLayer::Position if count(pixel) > 0 => {
                    (center + glam::DVec3::from_array(mean.map(f64::from))).as_vec3().to_array()
                }
                _ => mean,
            })
            .collect();
        picture.write_rows(band.first_row, &values)
    })?;
    Ok((!outcome.report.interrupted).then_some(picture))
}

/// What is met at the pixels' centres. Numbers cannot be averaged; one ray a pixel is soon traced by the CPU.
fn ids(scene: &Scene) -> Result<Arc<LayerPicture>, RenderError> {
    let reference = ReferenceRenderer::new(scene)?;
    let [width, height] = scene.film.size;
    let picture = LayerPicture::new([width, height])?;
    for y in 0..height {
        let row: Vec<[f32; 3]> =
            (0..width).map(|x| reference.ids(x, y)).map(|[object, material]| [object as f32, material as f32, 0.0]).collect();
        picture.write_rows(y, &row)?;
    }
    Ok(Arc::new(picture))
}
