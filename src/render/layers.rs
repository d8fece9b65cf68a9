//! Renders layers: each is a render of its own, of the same samples as the picture, by kernels that make it in place of radiance. So the kernels
//! of a picture without layers are what they are, and the film, its sums and its passes are the same for all. The light of a group is rendered by
//! the picture's kernels, of a scene in which the light of all other groups is black; whatever chooses paths and weighs them is as it was.

use std::borrow::Cow;
use std::sync::Arc;
use std::time::Instant;

use glam::{DVec2, DVec3};

use super::checkpoint::Checkpoint;
use super::cryptomatte;
use super::options::RenderOptions;
use super::stream::Renderer;
use crate::choice::Choice;
use crate::cpu::ReferenceRenderer;
use crate::film::{Band, KernelLayer, Layer, RenderedLayer};
use crate::output::{LIGHT_GROUPS_KEY, LayerChannel, LayerPicture};
use crate::plan::PlanOptions;
use crate::reference::layer::layer_scene;
use crate::renderer::{Observer, RenderError};
use crate::scene::{Guiding, InvalidScene, LightChoice, Scene};

/// Gives the checkpoint of a layer that is about to be rendered, if it shall have one.
pub type LayerCheckpoints<'a, E> = &'a mut dyn FnMut(&Renderer, &RenderedLayer) -> Result<Option<Checkpoint>, E>;

/// A rendered layer: means, their rounding errors, and how many samples they are over. Only parts need the
/// last two.
struct Rendered {
    layer: RenderedLayer,
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
    if let Some((layer, message)) = contradiction(wanted, scene, options) {
        let part = format!("its layer {}", layer.name());
        return Err(RenderError::InvalidScene(InvalidScene { part, message }).into());
    }
    for &layer in wanted {
        if layer == Layer::Cryptomatte {
            let Some(mattes) = cryptomatte::mattes(scene, region, observer)? else { return Ok(None) };
            LayerChannel::add_new(&mut channels, mattes);
            continue;
        }
        let renders = renders_of(scene, layer);
        if renders.is_empty() {
            let picture = if layer == Layer::Ids { Some(ids(scene, region).map_err(E::from)?) } else { None };
            LayerChannel::add_new(&mut channels, LayerChannel::of(layer, picture.as_ref()));
        }
        for of_layer in renders {
            let index = match rendered.iter().position(|one| one.layer == of_layer) {
                Some(index) => index,
                None => {
                    let Some(one) = render_layer(scene, options, (of_layer, of_part), observer, checkpoint)? else {
                        return Ok(None);
                    };
                    rendered.push(one);
                    rendered.len() - 1
                }
            };
            let Rendered { layer: of_layer, means, of_part } = &rendered[index];
            LayerChannel::add_new(
                &mut channels,
                match of_layer {
                    RenderedLayer::Kernel(_) => LayerChannel::of(layer, Some(means)),
                    RenderedLayer::LightGroup(group) => LayerChannel::of_group(group, means),
                },
            );
            if let Some([remainders, counts]) = of_part {
                LayerChannel::add_new(&mut channels, LayerChannel::of_part(of_layer, [means, remainders, counts]));
            }
        }
    }
    Ok(Some(channels))
}

/// The renders that a layer needs; none where it needs nothing beside the picture, or no samples.
fn renders_of(scene: &Scene, layer: Layer) -> Vec<RenderedLayer> {
    if layer == Layer::Groups {
        return scene.light_group_names().into_iter().map(|group| RenderedLayer::LightGroup(group.to_owned())).collect();
    }
    layer.kernel().map(RenderedLayer::Kernel).into_iter().collect()
}

/// The first of the layers that cannot be rendered of a scene with these options, and a sentence about why. None where all can.
pub fn contradiction(wanted: &[Layer], scene: &Scene, options: &RenderOptions) -> Option<(Layer, String)> {
    wanted.iter().find_map(|&layer| {
        let message = match layer {
            Layer::Groups => contradiction_of_groups(scene, options),
            Layer::Motion => contradiction_of_motion(scene),
            _ => None,
        };
        message.map(|message| (layer, message))
    })
}

/// A sentence about why the camera has no motion vectors. None where it has.
fn contradiction_of_motion(scene: &Scene) -> Option<String> {
    let is_flat = scene.camera.window(DVec2::from(scene.film.size.map(f64::from))).is_some();
    (!is_flat).then(|| {
        format!(
            "motion vectors are of flat pictures, and the camera's projection is \"{}\"; leave the layer out, or render a flat picture (--projection perspective)",
            scene.camera.projection.name()
        )
    })
}

/// A sentence about why light groups cannot be rendered as layers that add up to the picture. None where they can.
fn contradiction_of_groups(scene: &Scene, options: &RenderOptions) -> Option<String> {
    let ends_by = |what: &str| {
        Some(format!(
            "light groups are of all samples of the picture, and {what} decides how many it has; state them by --spp alone"
        ))
    };
    if scene.light_groups.is_empty() {
        return Some(
            "no emitter of the scene names a light group: light_group = \"key\" in [[light]], [[material]] or [[medium]]"
                .to_owned(),
        );
    }
    if scene.render.clamp > 0.0 {
        return Some("light groups would not add up to a picture whose samples are clamped as wholes; set clamp to 0".to_owned());
    }
    if options.adaptive {
        return ends_by("--adaptive");
    }
    if options.target_error.is_some() {
        return ends_by("--target-error");
    }
    if options.interval.is_some_and(|interval| interval.target.is_some()) {
        return ends_by("--target-interval");
    }
    options.time_limit.and_then(|_| ends_by("--time-limit"))
}

/// Entries of the header about the light groups that are among the layers.
pub fn notes_of_groups(scene: &Scene) -> Vec<(String, String)> {
    vec![(LIGHT_GROUPS_KEY.to_owned(), scene.light_group_names().join(","))]
}

fn render_layer<E: From<RenderError>>(
    scene: &Scene,
    options: &RenderOptions,
    (layer, of_part): (RenderedLayer, bool),
    observer: &dyn Observer,
    checkpoint: LayerCheckpoints<'_, E>,
) -> Result<Option<Rendered>, E> {
    let kernel = layer.kernel();
    let plan = PlanOptions { layer: kernel, ..options.plan.clone() };
    let of_layer =
        RenderOptions { plan, time_limit: None, target_error: None, adaptive: false, interval: None, ..options.clone() };
    let center = if kernel == Some(KernelLayer::Position) { scene.center() } else { DVec3::ZERO };
    let scene = match &layer {
        RenderedLayer::Kernel(kernel) => layer_scene(scene, *kernel),
        RenderedLayer::LightGroup(group) => scene.in_light_of(group).map_or(Cow::Borrowed(scene), Cow::Owned),
    };
    let mut renderer = Renderer::on(Renderer::begin(&of_layer), &scene, &of_layer)?;
    let picture = || LayerPicture::new(renderer.size()).map(Arc::new).map_err(RenderError::from);
    let means = picture()?;
    let others = if of_part { Some([picture()?, picture()?]) } else { None };
    let samples = scene.render.spp;
    let mut kept = checkpoint(&renderer, &layer)?;
    let outcome = renderer.render_from(Instant::now(), observer, kept.as_mut(), &mut |band: Band| {
        let count = |pixel: usize| band.counts.as_ref().map_or(band.samples, |counts| counts[pixel]);
        // Positions were relative to it.
        let moved = |pixel: usize| if count(pixel) > 0 { center } else { DVec3::ZERO };
        let values: Vec<[f32; 3]> = band
            .mean
            .iter()
            .enumerate()
            .map(|(pixel, &mean)| match kernel {
                Some(KernelLayer::Depth) => [mean[0], count(pixel) as f32 / samples as f32, 0.0],
                Some(KernelLayer::Position) => (moved(pixel) + wide(mean)).as_vec3().to_array(),
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
                match kernel {
                    Some(KernelLayer::Position) => (moved(pixel) + wide(mean) + wide(rest) - wide(value)).as_vec3().to_array(),
                    _ => rest,
                }
            })
            .collect();
        remainders.write_rows(band.first_row, &rests)?;
        let of_pixels: Vec<[f32; 3]> = (0..band.mean.len()).map(|pixel| [count(pixel) as f32, 0.0, 0.0]).collect();
        counts.write_rows(band.first_row, &of_pixels)
    })?;
    Ok((!outcome.report.interrupted).then_some(Rendered { layer, means, of_part: others }))
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
