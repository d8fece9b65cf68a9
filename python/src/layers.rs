//! Layers of a picture as arrays.

use std::collections::BTreeMap;
use std::io::Result;

use gpt::output::{LayerChannel, LayerSource, sample_variance};

use crate::array::{Array, Numbers};

/// Channels as arrays, by the layers' names in EXR files: `Albedo` has three channels, `Z` one.
///
/// # Errors
/// What the file system says: layers wait in temporary files.
pub fn arrays(channels: &[LayerChannel], image: &gpt::Image) -> Result<BTreeMap<String, Array>> {
    let mut layers: BTreeMap<&str, Vec<&LayerSource>> = BTreeMap::new();
    for channel in channels {
        layers.entry(of_channel(channels, &channel.name)).or_default().push(&channel.source);
    }
    layers.into_iter().map(|(name, sources)| Ok((name.to_owned(), array(&sources, image)?))).collect()
}

/// Names of these channels, each with its layer's.
pub fn names(channels: &[LayerChannel]) -> Vec<(String, String)> {
    channels.iter().map(|channel| (channel.name.to_string(), of_channel(channels, &channel.name).to_owned())).collect()
}

fn of_channel<'a>(channels: &[LayerChannel], name: &'a str) -> &'a str {
    layer_of(name, |other| channels.iter().any(|channel| channel.name == other))
}

/// The layer that a channel belongs to: what stands before the last point of its name, as long as no channel is called that alone.
pub fn layer_of(channel: &str, is_channel: impl Fn(&str) -> bool) -> &str {
    channel.rsplit_once('.').map(|(layer, _)| layer).filter(|layer| !is_channel(layer)).unwrap_or(channel)
}

/// The low or the high end of a pixel's interval.
fn end(image: &gpt::Image, which: usize, pixel: usize, place: usize) -> f32 {
    image.interval_ends().map_or(f32::NAN, |ends| ends[which][pixel][place])
}

fn array(sources: &[&LayerSource], image: &gpt::Image) -> Result<Array> {
    let [width, height] = [image.width() as usize, image.height() as usize];
    let is_whole = sources.iter().all(|source| matches!(source, LayerSource::Whole(..) | LayerSource::Count));
    let mut single: Vec<f32> = Vec::new();
    let mut whole: Vec<u32> = Vec::new();
    if is_whole {
        whole.reserve(width * height * sources.len())
    } else {
        single.reserve(width * height * sources.len())
    };
    for y in 0..height {
        let rows = sources.iter().map(|source| source.picture().map(|picture| picture.row(y as u32)).transpose());
        let rows = rows.collect::<Result<Vec<_>>>()?;
        for x in 0..width {
            let pixel = y * width + x;
            for (source, row) in sources.iter().zip(&rows) {
                let number = |place: usize| row.as_ref().map_or(0.0, |row| row[x][place]);
                match source {
                    LayerSource::Count => whole.push(image.samples(pixel)),
                    LayerSource::Low(place) => single.push(end(image, 0, pixel, *place)),
                    LayerSource::High(place) => single.push(end(image, 1, pixel, *place)),
                    LayerSource::Whole(_, place) => whole.push(number(*place) as u32),
                    LayerSource::Component(_, place) => single.push(number(*place)),
                    LayerSource::Variance(_, place) => {
                        single.push(sample_variance(image.pixels()[pixel][*place], number(*place), image.samples(pixel)));
                    }
                }
            }
        }
    }
    let mut shape = vec![height, width];
    if sources.len() > 1 {
        shape.push(sources.len());
    }
    Ok(Array { numbers: if is_whole { Numbers::Whole(whole) } else { Numbers::Single(single) }, shape })
}
