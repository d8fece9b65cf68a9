//! OpenEXR files: the part, the layer and the window that are the picture.

mod attributes;
mod blocks;
mod chroma;
mod colours;
mod digest;
mod windows;

use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::Compression;
use glam::{DMat3, DVec3};

use blocks::RESAVE;
pub use blocks::read_lines;
pub use digest::{DIGEST_KEY, LineDigests, check_digest, first_channel, placeholder, read_checked_lines};
pub use windows::Windows;

use super::pixels::{Hints, Sink, linear};
use crate::input::AnyFile;
use crate::scene::ColorSpace;
use attributes::Attributes;
use chroma::Plane;
use colours::{Colours, Mixture};

/// An OpenEXR file whose header was read.
pub struct ExrFile {
    file: AnyFile,
    header: Header,
    /// The headers of the other parts, each with its place.
    others: Vec<(usize, Header)>,
    windows: Windows,
    colours: Colours,
    attributes: Attributes,
}

/// The headers of all parts.
///
/// # Errors
/// A file that is no OpenEXR file, and parts of that format that are not read.
pub fn headers(file: &mut AnyFile) -> Result<Vec<Header>, String> {
    let meta = MetaData::read_from_buffered(&mut *file, false).map_err(|error| format!("is not a valid EXR: {error}"))?;
    file.rewind().map_err(|error| format!("cannot be read: {error}"))?;
    for header in &meta.headers {
        if header.deep {
            return Err("holds deep data, many samples a pixel, which is not read: `oiiotool IN.exr --flatten -o OUT.exr` (openimageio-tools) \
                 makes a flat picture of it"
                .to_owned());
        }
        if matches!(header.compression, Compression::HTJ2K32 | Compression::HTJ2K256) {
            return Err(format!("is compressed by HTJ2K, which is not read; {RESAVE}"));
        }
    }
    if meta.headers.is_empty() {
        return Err("is an EXR without a picture".to_owned());
    }
    Ok(meta.headers.into_iter().collect())
}

/// Oddities that a header states of its pixels beside where they lie: none for a picture in squares, in linear Rec. 709.
pub fn oddities(header: &Header) -> Vec<String> {
    let mut notes = Vec::new();
    Attributes::of(header, Some(ColorSpace::Linear), &mut notes);
    notes
}

impl ExrFile {
    /// Reads the header.
    ///
    /// # Errors
    /// The errors of [`headers`], and a file without channels that are colours.
    pub fn open(mut file: AnyFile, color_space: Option<ColorSpace>) -> Result<Self, String> {
        let headers = headers(&mut file)?;
        let mut colours = Colours::choose(&headers)?;
        let (mut picture, others): (Vec<_>, Vec<_>) =
            headers.into_iter().enumerate().partition(|(part, _)| *part == colours.part);
        let (_, header) = picture.pop().ok_or("has no picture")?;
        let windows = Windows::of(&header);
        let attributes = Attributes::of(&header, color_space, &mut colours.notes);
        let covered = windows.covered();
        if covered[2] == 0 || covered[3] == 0 {
            let what = "its pixels (dataWindow) lie outside of what it shows (displayWindow): the picture is black";
            colours.notes.push(what.to_owned());
        }
        Ok(Self { file, header, others, windows, colours, attributes })
    }

    pub fn windows(&self) -> Windows {
        self.windows
    }

    /// Its place among the file's parts.
    pub fn part(&self) -> usize {
        self.colours.part
    }

    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Names of the channels that its colours are made of.
    pub fn colour_channels(&self) -> Vec<String> {
        let places: Vec<usize> = match self.colours.mixture {
            Mixture::Rgb(channels) => channels.into_iter().flatten().collect(),
            Mixture::Grey(channel) => vec![channel],
            Mixture::LuminanceChroma(channels) => channels.to_vec(),
        };
        places.into_iter().map(|place| self.header.channels.list[place].name.to_string()).collect()
    }

    /// The parts that lie where the picture does, the picture's first, each with its place among all.
    pub fn layers(&self) -> impl Iterator<Item = (usize, &Header)> {
        let fits = |header: &Header| Windows::of(header) == self.windows;
        let others = self.others.iter().filter(move |(_, header)| fits(header)).map(|(part, header)| (*part, header));
        std::iter::once((self.colours.part, &self.header)).chain(others)
    }

    pub fn notes(&self) -> &[String] {
        &self.colours.notes
    }

    pub fn hints(&self) -> &Hints {
        &self.attributes.hints
    }

    /// Answers [`super::PictureFile::converts`].
    pub fn converts(&self) -> bool {
        self.attributes.matrix.is_some() || matches!(self.colours.mixture, Mixture::LuminanceChroma(_))
    }

    /// Answers [`super::PictureFile::is_plain`].
    pub fn is_plain(&self) -> bool {
        let [width, height] = self.windows.size();
        let is_whole = self.windows.covered() == [0, 0, width, height] && self.windows.data_size() == [width, height];
        let Colours { part, mixture, ref layer, .. } = self.colours;
        let is_rgb = matches!(mixture, Mixture::Rgb([Some(_), Some(_), Some(_)])) && layer.is_empty() && part == 0;
        is_whole && is_rgb && !self.converts() && !blocks::is_subsampled(&self.header)
    }

    /// The value where it has no pixel.
    pub fn empty(&self) -> [f32; 4] {
        [0.0, 0.0, 0.0, if self.colours.alpha.is_some() { 0.0 } else { 1.0 }]
    }

    /// Does the work of [`super::PictureFile::decode`].
    pub fn decode(self, sink: Sink<'_>) -> Result<(), String> {
        let Self { file, header, windows, colours, attributes, .. } = self;
        let (space, matrix) = (attributes.color_space, attributes.matrix);
        let finish = move |pixel: [f32; 4]| finish(pixel, space, matrix);
        let mut place = |at: [usize; 2], pixels: &[[f32; 4]]| {
            if let Some((at, pixels)) = windows.place(at, pixels) {
                sink(at, pixels);
            }
        };
        if blocks::is_subsampled(&header) || matches!(colours.mixture, Mixture::LuminanceChroma(_)) {
            return decode_planes(file, &header, &colours, &attributes, |row, pixels: Vec<[f32; 4]>| {
                place([0, row], &pixels.into_iter().map(finish).collect::<Vec<_>>());
            });
        }
        let mut slots: Vec<(usize, usize)> = match colours.mixture {
            Mixture::Rgb(channels) => (0..3).filter_map(|slot| Some((channels[slot]?, slot))).collect(),
            Mixture::Grey(channel) => vec![(channel, 0), (channel, 1), (channel, 2)],
            Mixture::LuminanceChroma(_) => Vec::new(),
        };
        slots.extend(colours.alpha.map(|channel| (channel, 3)));
        let wanted: Vec<usize> = slots.iter().map(|(channel, _)| *channel).collect();
        let last = wanted.iter().copied().max();
        let mut pixels: Vec<[f32; 4]> = Vec::new();
        read_lines(file, colours.part, &wanted, |(channel, at, numbers)| {
            if pixels.len() != numbers.len() {
                pixels.clear();
                pixels.resize(numbers.len(), [0.0, 0.0, 0.0, 1.0]);
            }
            for (_, slot) in slots.iter().filter(|(of, _)| *of == channel) {
                pixels.iter_mut().zip(numbers).for_each(|(pixel, number)| pixel[*slot] = *number);
            }
            // Channels of a row come in their order: with the last one it is whole, and every slot is written anew in the next one.
            if Some(channel) == last {
                if matrix.is_some() || space != ColorSpace::Linear {
                    pixels.iter_mut().for_each(|pixel| *pixel = finish(*pixel));
                }
                place(at, &pixels);
                if wanted.len() < 4 {
                    pixels.fill([0.0, 0.0, 0.0, 1.0]);
                }
            }
        })
        .map_err(|error| format!("is a damaged EXR: {error}"))
    }
}

/// Rows of a picture whose channels have to be in memory whole, each with its row in the data window.
fn decode_planes(
    file: AnyFile,
    header: &Header,
    colours: &Colours,
    attributes: &Attributes,
    mut put: impl FnMut(usize, Vec<[f32; 4]>),
) -> Result<(), String> {
    let mut slots: Vec<Option<usize>> = match colours.mixture {
        Mixture::Rgb(channels) => channels.to_vec(),
        Mixture::Grey(channel) => vec![Some(channel); 3],
        Mixture::LuminanceChroma(channels) => channels.map(Some).to_vec(),
    };
    slots.push(colours.alpha);
    let mut wanted: Vec<usize> = slots.iter().flatten().copied().collect();
    wanted.sort_unstable();
    wanted.dedup();
    let mut planes: Vec<Plane> = wanted.iter().map(|channel| Plane::new(header, &header.channels.list[*channel])).collect();
    read_lines(file, colours.part, &wanted, |(channel, at, numbers)| {
        if let Some(place) = wanted.iter().position(|of| *of == channel) {
            planes[place].put(at, numbers);
        }
    })
    .map_err(|error| format!("is a damaged EXR: {error}"))?;
    let weights = chroma::luminance_weights(&attributes.primaries);
    let (width, height) = (header.layer_size.width(), header.layer_size.height());
    for row in 0..height {
        let rows: Vec<Vec<f32>> = planes.iter().map(|plane| plane.row(row, width)).collect();
        let number = |slot: usize, column: usize, missing: f32| {
            let place = slots[slot].and_then(|channel| wanted.iter().position(|of| *of == channel));
            place.map_or(missing, |place| rows[place][column])
        };
        let pixel = |column: usize| {
            let values = [0, 1, 2].map(|slot| number(slot, column, 0.0));
            let [red, green, blue] = match colours.mixture {
                Mixture::LuminanceChroma(_) => chroma::colour(values, weights),
                _ => values,
            };
            [red, green, blue, number(3, column, 1.0)]
        };
        put(row, (0..width).map(pixel).collect());
    }
    Ok(())
}

/// A pixel as the file has it, in linear Rec. 709.
fn finish([red, green, blue, alpha]: [f32; 4], space: ColorSpace, matrix: Option<DMat3>) -> [f32; 4] {
    let colour = [red, green, blue].map(|value| linear(value, space));
    let [red, green, blue] = match matrix {
        Some(matrix) => (matrix * DVec3::from(colour.map(f64::from))).to_array().map(|value| value as f32),
        None => colour,
    };
    [red, green, blue, alpha]
}
