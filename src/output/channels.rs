//! All channels of an EXR file by their names, with what its header says.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use exr::meta::attribute::{AttributeValue, SampleType};
use exr::prelude::Vec2;

use super::read::{ReadError, check_size};
use crate::input;
use crate::picture_file::Format;
use crate::picture_file::open_exr::{ExrFile, read_lines};

/// The parts of an EXR file that lie where its picture does, in the display window; outside of the data window, numbers are 0.
#[derive(Debug, Clone, Default)]
pub struct Channels {
    pub width: u32,
    pub height: u32,
    /// Row by row from the top.
    values: BTreeMap<String, Vec<f32>>,
    /// Channels whose numbers are whole.
    whole: BTreeSet<String>,
    /// Channels that the picture's colours are made of.
    colours: BTreeSet<String>,
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

    /// Reads the file as [`Channels::read`] does; None of a picture in another format.
    ///
    /// # Errors
    /// The errors of [`Channels::read`].
    pub fn read_where_exr(path: &Path) -> Result<Option<Self>, ReadError> {
        let format = input::open_to_decode(path).and_then(|mut file| Format::of(&mut file, path));
        if matches!(format, Ok(Some(Format::OpenExr))) { Self::read(path).map(Some) } else { Ok(None) }
    }

    fn read_or_say(path: &Path) -> Result<Self, String> {
        let open = || input::open_to_decode(path).map_err(|error| error.to_string());
        let file = ExrFile::open(open()?, None).map_err(|what| format!("it {what}"))?;
        let (header, windows) = (file.header(), file.windows());
        let size @ [width, height] = windows.size();
        check_size(size)?;
        check_size(windows.data_size())?;
        let (mut values, mut whole) = (BTreeMap::new(), BTreeSet::new());
        for (part, header) in file.layers() {
            // Channels of reduced resolution hold no layer of a picture.
            let full = header.channels.list.iter().enumerate().filter(|(_, channel)| channel.sampling == Vec2(1, 1));
            let wanted: Vec<usize> = full.map(|(place, _)| place).collect();
            let mut planes = vec![vec![0.0; width as usize * height as usize]; wanted.len()];
            read_lines(open()?, part, &wanted, |(channel, at, numbers)| {
                let plane = wanted.iter().position(|of| *of == channel);
                if let (Some(plane), Some(([column, row], numbers))) = (plane, windows.place(at, numbers)) {
                    let start = row * width as usize + column;
                    planes[plane][start..start + numbers.len()].copy_from_slice(numbers);
                }
            })?;
            for (place, plane) in wanted.iter().zip(planes) {
                let own = header.channels.list[*place].name.to_string();
                // Some programs leave it to the part's name to tell channels of one name apart.
                let name = match &header.own_attributes.layer_name {
                    Some(part) if values.contains_key(&own) => format!("{part}.{own}"),
                    _ => own,
                };
                if header.channels.list[*place].sample_type == SampleType::U32 {
                    whole.insert(name.clone());
                }
                values.entry(name).or_insert(plane);
            }
        }
        let attributes = header
            .own_attributes
            .other
            .iter()
            .filter_map(|(name, value)| match value {
                AttributeValue::Text(text) => Some((name.to_string(), text.to_string())),
                AttributeValue::I32(number) => Some((name.to_string(), number.to_string())),
                _ => None,
            })
            .collect();
        let colours = file.colour_channels().into_iter().collect();
        Ok(Self { width, height, values, whole, colours, attributes })
    }

    /// Channels of this size that are in no file, each row by row from the top, with what a header would say; None where one has another number of
    /// values.
    pub fn of_memory(
        [width, height]: [u32; 2],
        channels: impl IntoIterator<Item = (String, Vec<f32>)>,
        attributes: impl IntoIterator<Item = (String, String)>,
    ) -> Option<Self> {
        let values: BTreeMap<String, Vec<f32>> = channels.into_iter().collect();
        let pixels = width as usize * height as usize;
        let fits = pixels > 0 && values.values().all(|channel| channel.len() == pixels);
        let attributes = attributes.into_iter().collect();
        fits.then_some(Self { width, height, values, attributes, ..Self::default() })
    }

    /// The values of a channel.
    pub fn channel(&self, name: &str) -> Option<&[f32]> {
        self.values.get(name).map(Vec::as_slice)
    }

    /// True for a channel that its file has as whole numbers.
    pub fn is_whole(&self, name: &str) -> bool {
        self.whole.contains(name)
    }

    /// True for a channel that colours of the picture itself are made of.
    pub fn is_colour(&self, name: &str) -> bool {
        self.colours.contains(name)
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

    /// All of the header's texts and numbers by their keys.
    pub fn attributes(&self) -> impl Iterator<Item = (&str, &str)> {
        self.attributes.iter().map(|(key, text)| (key.as_str(), text.as_str()))
    }

    /// The text or number that the header has under this key.
    pub fn attribute(&self, key: &str) -> Option<&str> {
        self.attributes.get(key).map(String::as_str)
    }
}
