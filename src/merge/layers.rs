//! The layers of parts, joined: means over the samples that each part's are over, in double precision, and what samples do not change as it is.

use std::io;
use std::sync::Arc;

use super::part::{PartHeader, PartPixels};
use crate::film::{KernelLayer, Layer, RenderedLayer};
use crate::output::{LayerChannel, LayerPicture};
use crate::render::cryptomatte;

/// Numbers of a pixel that a [`LayerPicture`] has.
const IN_PICTURE: usize = 3;

/// Sums over the samples of the pixels of a picture.
pub struct LayerSums {
    layers: Vec<Layer>,
    rendered: Vec<(RenderedLayer, Vec<LayerPixel>)>,
    /// Channels that are the same whatever the samples, each with its pixels.
    fixed: Vec<Vec<f32>>,
}

/// Sums over the samples of a pixel that met something, where the layer is of surfaces.
#[derive(Debug, Clone, Copy, Default)]
struct LayerPixel {
    sum: [f64; 3],
    count: f64,
}

impl LayerSums {
    /// The layers of a picture of so many pixels, as this part has them.
    pub fn new(part: &PartHeader, pixels: usize) -> Self {
        Self {
            layers: part.layers.clone(),
            rendered: part.rendered().map(|layer| (layer, vec![LayerPixel::default(); pixels])).collect(),
            fixed: part.fixed_channels().map(|_| vec![0.0; pixels]).collect(),
        }
    }

    /// Adds a run of a part's pixels, from its pixel `own` on, at pixel `place` of the picture.
    pub fn add(&mut self, part: &PartPixels, (own, place): (usize, usize), count: usize) {
        for ((_, sums), channels) in self.rendered.iter_mut().zip(&part.rendered) {
            for (pixel, sum) in sums[place..place + count].iter_mut().enumerate() {
                let (means, samples) = channels.at(own + pixel);
                for (sum, mean) in sum.sum.iter_mut().zip(means) {
                    *sum += samples * mean;
                }
                sum.count += samples;
            }
        }
        for (values, channel) in self.fixed.iter_mut().zip(&part.fixed) {
            values[place..place + count].copy_from_slice(&channel[own..own + count]);
        }
    }

    /// The channels of the whole picture of this width. `samples`: how many each pixel has.
    ///
    /// # Errors
    /// Errors of temporary files.
    pub fn channels(&self, size: [u32; 2], samples: impl Fn(usize) -> f64) -> io::Result<Vec<LayerChannel>> {
        let mut channels = Vec::new();
        for (layer, sums) in &self.rendered {
            let value = |(pixel, sum): (usize, &LayerPixel)| {
                let mean = sum.sum.map(|of_channel| if sum.count > 0.0 { (of_channel / sum.count) as f32 } else { 0.0 });
                let share = |samples: f64| if samples > 0.0 { sum.count as f32 / samples as f32 } else { 0.0 };
                // Beside the depth stands what share of the samples met a surface.
                if layer.kernel() == Some(KernelLayer::Depth) { [mean[0], share(samples(pixel)), 0.0] } else { mean }
            };
            let picture = written(size, sums.iter().enumerate().map(value))?;
            if let RenderedLayer::LightGroup(group) = layer {
                LayerChannel::add_new(&mut channels, LayerChannel::of_group(group, &picture));
            }
            for layer in self.layers.iter().filter(|of_kernel| layer.kernel().is_some() && of_kernel.kernel() == layer.kernel()) {
                LayerChannel::add_new(&mut channels, LayerChannel::of(*layer, Some(&picture)));
            }
        }
        if self.layers.contains(&Layer::Samples) {
            LayerChannel::add_new(&mut channels, LayerChannel::of(Layer::Samples, None));
        }
        let mut fixed = self.fixed.as_slice();
        if self.layers.contains(&Layer::Ids) {
            let [objects, materials, rest @ ..] = fixed else { return Ok(channels) };
            let picture = written(size, objects.iter().zip(materials).map(|(object, material)| [*object, *material, 0.0]))?;
            LayerChannel::add_new(&mut channels, LayerChannel::of(Layer::Ids, Some(&picture)));
            fixed = rest;
        }
        if self.layers.contains(&Layer::Cryptomatte) {
            let triple = |three: &[Vec<f32>]| {
                let pixels = 0..three[0].len();
                written(size, pixels.map(|pixel| std::array::from_fn(|place| three[place][pixel])))
            };
            let pictures = fixed.chunks_exact(IN_PICTURE).map(triple).collect::<io::Result<Vec<_>>>()?;
            LayerChannel::add_new(&mut channels, cryptomatte::channels(&pictures));
        }
        Ok(channels)
    }
}

fn written(size: [u32; 2], pixels: impl Iterator<Item = [f32; IN_PICTURE]>) -> io::Result<Arc<LayerPicture>> {
    let picture = LayerPicture::new(size)?;
    let width = size[0] as usize;
    let mut row = Vec::with_capacity(width);
    let mut rows = 0;
    for pixel in pixels {
        row.push(pixel);
        if row.len() == width {
            picture.write_rows(rows, &row)?;
            row.clear();
            rows += 1;
        }
    }
    Ok(Arc::new(picture))
}
