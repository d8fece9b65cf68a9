//! Pictures of files, with the layers that are beside them there.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use gpt::film::Layer;
use gpt::output::{Channels, LAYERS_KEY, LIGHT_GROUPS_KEY, SAMPLE_COUNT};
use gpt::regroup::WEIGHTS_KEY;
use pyo3::prelude::*;

use crate::array::{Array, Numbers};
use crate::errors::raised;
use crate::layers::layer_of;
use crate::picture::Picture;
use crate::process;
use crate::task::Rendered;

/// A file as a render would give it, without what the render did.
#[pyfunction]
pub fn open_with_layers(py: Python<'_>, path: PathBuf) -> PyResult<Rendered> {
    process::check()?;
    let read = || {
        let image = gpt::Image::open(&path)?;
        Ok::<_, gpt::Error>((image, Channels::read_where_exr(&path)?.unwrap_or_default()))
    };
    let (image, channels) = py.detach(read).map_err(raised)?;
    let names = channels_of_layers(&channels);
    let mut layers: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for (channel, layer) in &names {
        layers.entry(layer.clone()).or_default().push(channel);
    }
    let arrays = py.detach(|| -> Vec<_> { layers.into_iter().map(|(layer, names)| (layer, array(&channels, &names))).collect() });
    let layers = arrays.into_iter().map(|(layer, array)| Ok((layer, Py::new(py, array)?))).collect::<PyResult<_>>()?;
    let named = Layer::from_list(channels.attribute(LAYERS_KEY).unwrap_or_default()).unwrap_or_default();
    let groups = channels.attribute(LIGHT_GROUPS_KEY).unwrap_or_default();
    let explains_layers = |key: &str| [LIGHT_GROUPS_KEY, WEIGHTS_KEY].contains(&key) || key.starts_with("cryptomatte/");
    let notes = channels.attributes().filter(|(key, _)| explains_layers(key));
    Ok(Rendered {
        picture: Py::new(py, Picture(image))?,
        layers,
        channels: names,
        layer_list: Layer::list(&named),
        groups: groups.split(',').filter(|group| !group.is_empty()).map(str::to_owned).collect(),
        notes: notes.map(|(key, text)| (key.to_owned(), text.to_owned())).collect(),
        stats: "{}".to_owned(),
    })
}

/// All channels but those that the picture is made of, each with its layer; those of a layer in the order of colours, or of their names.
fn channels_of_layers(channels: &Channels) -> Vec<(String, String)> {
    let names: BTreeSet<&str> = channels.names().collect();
    let mut found: Vec<(String, String)> = names
        .iter()
        .filter(|name| !channels.is_colour(name))
        .map(|name| ((*name).to_owned(), layer_of(name, |other| names.contains(other)).to_owned()))
        .collect();
    let place = |channel: &str| {
        let component = channel.rsplit_once('.').map_or("", |(_, component)| component);
        ["R", "G", "B", "A"].iter().position(|colour| component.eq_ignore_ascii_case(colour)).unwrap_or(4)
    };
    found.sort_by_cached_key(|(channel, layer)| (layer.clone(), place(channel), channel.clone()));
    found
}

fn array(channels: &Channels, names: &[&str]) -> Array {
    let planes: Vec<&[f32]> = names.iter().filter_map(|name| channels.channel(name)).collect();
    let pixels = 0..channels.width as usize * channels.height as usize;
    let numbers = pixels.flat_map(|pixel| planes.iter().map(move |plane| plane[pixel]));
    // Files have numbers of samples as floating-point numbers, so that all programs read them.
    let is_count = |plane: &[f32]| plane.iter().all(|number| *number >= 0.0 && number.fract() == 0.0);
    let counts = names.iter().zip(&planes).all(|(name, plane)| *name == SAMPLE_COUNT && is_count(plane));
    let numbers = if counts || names.iter().all(|name| channels.is_whole(name)) {
        Numbers::Whole(numbers.map(|number| number as u32).collect())
    } else {
        Numbers::Single(numbers.collect())
    };
    let mut shape = vec![channels.height as usize, channels.width as usize];
    if planes.len() > 1 {
        shape.push(planes.len());
    }
    Array { numbers, shape }
}
