//! All channels of an EXR file by their names, with what its header says.

use std::collections::BTreeMap;
use std::path::Path;

use exr::meta::attribute::AttributeValue;
use exr::prelude::{ReadChannels, ReadLayers};

use super::read::{ReadError, open_exr, sample};

/// The first part of an EXR file.
#[derive(Debug, Clone, Default)]
pub struct Channels {
    pub width: u32,
    pub height: u32,
    /// Row by row from the top.
    values: BTreeMap<String, Vec<f32>>,
    /// Texts and whole numbers of the header.
    attributes: BTreeMap<String, String>,
}

impl Channels {
    /// Reads the file.
    ///
    /// # Errors
    /// A file that is missing, broken, no EXR file, or too large.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        Self::read_or_say(path).map_err(|what| ReadError { path: path.to_owned(), what })
    }

    fn read_or_say(path: &Path) -> Result<Self, String> {
        let image = exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_buffered(open_exr(path)?)
            .map_err(|error| error.to_string())?;
        let layer = image.layer_data;
        let (width, height) = (layer.size.width(), layer.size.height());
        let whole = layer.channel_data.list.iter().filter(|channel| channel.sample_data.len() == width * height);
        let values = whole
            .map(|channel| {
                let samples = (0..width * height).map(|index| sample(&channel.sample_data, index)).collect();
                (channel.name.to_string(), samples)
            })
            .collect();
        let attributes = layer
            .attributes
            .other
            .iter()
            .filter_map(|(name, value)| match value {
                AttributeValue::Text(text) => Some((name.to_string(), text.to_string())),
                AttributeValue::I32(number) => Some((name.to_string(), number.to_string())),
                _ => None,
            })
            .collect();
        Ok(Self { width: width as u32, height: height as u32, values, attributes })
    }

    /// The values of a channel.
    pub fn channel(&self, name: &str) -> Option<&[f32]> {
        self.values.get(name).map(Vec::as_slice)
    }

    /// Three channels together.
    pub fn colours(&self, names: [&str; 3]) -> Option<Vec<[f32; 3]>> {
        let [a, b, c] = names.map(|name| self.channel(name));
        Some(a?.iter().zip(b?).zip(c?).map(|((a, b), c)| [*a, *b, *c]).collect())
    }

    /// The names of all channels, in their order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.values.keys().map(String::as_str)
    }

    /// What the header says under this key.
    pub fn attribute(&self, key: &str) -> Option<&str> {
        self.attributes.get(key).map(String::as_str)
    }
}
