//! A part's header, and its pixels.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use exr::image::{AnyChannels, FlatSamples};
use exr::meta::MetaData;
use exr::meta::attribute::AttributeValue;
use exr::prelude::{ReadChannels, ReadLayers};

use crate::choice::Choice;
use crate::film::{KernelLayer, Layer, PartChannels};
use crate::input;
use crate::output::{CROP_KEY, LAYERS_KEY, Provenance, part_channels};
use crate::render::cryptomatte;
use crate::scene::settings::SETTINGS;
use crate::scene::{Filter, FilterKind, RenderSettings};

/// Why files are not joined.
#[derive(Debug, thiserror::Error)]
pub enum MergeError {
    #[error("{}: {what}", path.display())]
    Part { path: PathBuf, what: String },
    /// Two parts that do not belong together.
    #[error("{} and {} are parts of different pictures: {what}", a.display(), b.display())]
    Mixture { a: PathBuf, b: PathBuf, what: String },
    #[error("{} and {} overlap: both have {what}", a.display(), b.display())]
    Overlap { a: PathBuf, b: PathBuf, what: String },
    /// What is not there, in words.
    #[error("the picture is not whole: {0}; --partial joins what there is")]
    Missing(String),
}

/// Entries of a header in which parts of one picture may differ.
const OWN: [&str; 7] =
    ["gpt:device", "gpt:firstSample", "gpt:samples", "gpt:samplesWanted", "gpt:complete", "gpt:brokenOff", CROP_KEY];

/// Pixels of a part from which on several threads decompress it.
const WORTH_THREADS: u64 = 1 << 16;

/// What a part says of itself.
#[derive(Debug, Clone, PartialEq)]
pub struct PartHeader {
    pub path: PathBuf,
    /// Width and height of the whole picture.
    pub film: [u32; 2],
    /// First column and row, width and height.
    pub region: [u32; 4],
    /// Absolute indices.
    pub samples: Range<u32>,
    /// What it has beside the picture, each once.
    pub layers: Vec<Layer>,
    entries: BTreeMap<String, String>,
}

/// The pixels of a part, row by row, channel by channel.
pub struct PartPixels {
    channels: Vec<Vec<f32>>,
    /// In the order of [`PartHeader::kernels`] and of [`PartHeader::fixed_channels`].
    pub kernels: Vec<KernelChannels>,
    pub fixed: Vec<Vec<f32>>,
}

/// The channels of a layer: means, what rounding to them lost, and how many samples they are over.
pub struct KernelChannels {
    means: Vec<Vec<f32>>,
    remainders: Vec<Vec<f32>>,
    counts: Vec<f32>,
}

/// What a pixel of a part has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartPixel {
    pub mean: [f64; 3],
    pub count: f64,
    /// Mean of the squared luminance.
    pub second_moment: f64,
}

impl PartHeader {
    /// Reads a header.
    ///
    /// # Errors
    /// A file that is no part, or whose render broke off.
    pub fn read(path: &Path) -> Result<Self, MergeError> {
        let failure = |what: String| MergeError::Part { path: path.to_owned(), what };
        let file = Box::new(input::open(path).map_err(|error| failure(error.to_string()))?);
        let meta =
            MetaData::read_from_buffered(file, false).map_err(|error| failure(format!("it is no EXR picture: {error}")))?;
        let header = meta.headers.first().ok_or_else(|| failure("it is no EXR picture".to_owned()))?;
        let has = |name: &str| header.channels.list.iter().any(|channel| channel.name.eq(name));
        if !part_channels().all(has) {
            return Err(failure(
                "it is no part of a picture: `gpt render --first-sample A --spp N` or `--crop X,Y,W,H` writes parts".to_owned(),
            ));
        }
        let text = |value: &AttributeValue| match value {
            AttributeValue::I32(number) => Some(number.to_string()),
            AttributeValue::Text(text) => Some(text.to_string()),
            _ => None,
        };
        let own = header.own_attributes.other.iter();
        let entries: BTreeMap<String, String> = own.filter_map(|(name, value)| Some((name.to_string(), text(value)?))).collect();
        let number = |key: &str| {
            let found = entries.get(key).and_then(|text| text.parse::<u32>().ok());
            found.ok_or_else(|| failure(format!("its header has no {key}")))
        };
        let [first, samples] = [number("gpt:firstSample")?, number("gpt:samples")?];
        if number("gpt:brokenOff")? != 0 || samples == 0 {
            return Err(failure("its render broke off; render it again".to_owned()));
        }
        let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
        let window = header.shared_attributes.display_window.size;
        let film = [side(window.width()), side(window.height())];
        let place = header.own_attributes.layer_position;
        let [x, y] = [place.x(), place.y()].map(|place| u32::try_from(place).unwrap_or(u32::MAX));
        let region = [x, y, side(header.layer_size.width()), side(header.layer_size.height())];
        let fits = x.checked_add(region[2]).is_some_and(|end| end <= film[0])
            && y.checked_add(region[3]).is_some_and(|end| end <= film[1]);
        let end = first.checked_add(samples).filter(|_| fits);
        let end = end.ok_or_else(|| failure("its header contradicts itself".to_owned()))?;
        let layers = Layer::from_list(entries.get(LAYERS_KEY).map_or("", String::as_str))
            .ok_or_else(|| failure("its header names layers that this version does not know".to_owned()))?;
        Ok(Self { path: path.to_owned(), film, region, samples: first..end, layers, entries })
    }

    /// A part that stands in no file.
    #[cfg(test)]
    pub fn for_tests(film: [u32; 2], region: [u32; 4], samples: Range<u32>) -> Self {
        let path = PathBuf::from(format!("{region:?}-{samples:?}.exr"));
        Self { path, film, region, samples, layers: Vec::new(), entries: BTreeMap::new() }
    }

    /// The layers that were rendered for it, each once.
    pub fn kernels(&self) -> impl Iterator<Item = KernelLayer> {
        KernelLayer::ALL.into_iter().filter(|kernel| self.layers.iter().any(|layer| layer.kernel() == Some(*kernel)))
    }

    /// Channels that are the same whatever the samples.
    pub fn fixed_channels(&self) -> impl Iterator<Item = &'static str> {
        let ids = self.layers.contains(&Layer::Ids).then_some(["ObjectId", "MaterialId"]);
        let mattes = self.layers.contains(&Layer::Cryptomatte).then(cryptomatte::channel_names);
        ids.into_iter().flatten().chain(mattes.into_iter().flatten())
    }

    /// What the header says of mattes.
    pub fn notes(&self) -> Vec<(String, String)> {
        let notes = self.entries.iter().filter(|(key, _)| key.starts_with("cryptomatte/"));
        notes.map(|(key, text)| (key.clone(), text.clone())).collect()
    }

    /// Whether the other is a part of the same picture.
    ///
    /// # Errors
    /// The first thing in which they differ.
    pub fn belongs_with(&self, other: &Self) -> Result<(), MergeError> {
        let mixture = |what: String| MergeError::Mixture { a: self.path.clone(), b: other.path.clone(), what };
        if self.film != other.film {
            let [a, b] = [self.film, other.film].map(|[width, height]| format!("{width}x{height}"));
            return Err(mixture(format!("the pictures have {a} and {b} pixels")));
        }
        let keys = self.entries.keys().chain(other.entries.keys());
        for key in keys.filter(|key| key.starts_with("gpt:") && !OWN.contains(&key.as_str())) {
            let [a, b] = [self, other].map(|part| part.entries.get(key).map_or("nothing", String::as_str));
            if a != b {
                return Err(mixture(match key.as_str() {
                    "gpt:sceneHash" => "their scenes differ".to_owned(),
                    "gpt:scene" => continue,
                    "gpt:version" => format!("gpt {a} and gpt {b} made them"),
                    LAYERS_KEY => format!("the layers of one are {a}, and of the other {b}"),
                    _ => {
                        let setting = SETTINGS.iter().find(|setting| setting.header == key);
                        let name = setting.map_or(key.trim_start_matches("gpt:"), |setting| setting.flag);
                        format!("{name} is {a} and {b}")
                    }
                }));
            }
        }
        Ok(())
    }

    /// What the header of the whole picture says, with so many samples per pixel from the first on.
    pub fn provenance(&self, first_sample: u32, spp: u32, device: String) -> Provenance {
        let entry = |key: &str| self.entries.get(key).cloned().unwrap_or_default();
        let mut settings = RenderSettings::default();
        for setting in SETTINGS {
            let text = entry(setting.header);
            if let Ok(assignment) = setting.text(&text) {
                assignment.apply(&mut settings);
            }
        }
        settings.spp = spp;
        Provenance {
            scene: entry("gpt:scene"),
            scene_hash: entry("gpt:sceneHash"),
            settings,
            filter: filter(&entry("gpt:filter")),
            first_sample,
            target_error: None,
            adaptive: false,
            device,
        }
    }

    /// What rendered it.
    pub fn device(&self) -> &str {
        self.entries.get("gpt:device").map_or("", String::as_str)
    }

    /// Reads the pixels.
    ///
    /// # Errors
    /// A file that is damaged.
    pub fn pixels(&self) -> Result<PartPixels, MergeError> {
        let failure = |what: String| MergeError::Part { path: self.path.clone(), what };
        let file = input::open_to_decode(&self.path).map_err(|error| failure(error.to_string()))?;
        let reader =
            exr::prelude::read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
        let [_, _, width, height] = self.region.map(u64::from);
        // A reader with threads starts as many as there are cores for each file, which takes longer than a small one.
        let reader = if width * height < WORTH_THREADS { reader.non_parallel() } else { reader };
        let image = reader.from_buffered(file).map_err(|error| failure(error.to_string()))?;
        let AnyChannels { list } = image.layer_data.channel_data;
        let mut found: BTreeMap<String, FlatSamples> =
            list.into_iter().map(|channel| (channel.name.to_string(), channel.sample_data)).collect();
        let pixels = self.region[2] as usize * self.region[3] as usize;
        let mut channel = |name: &str| match found.remove(name) {
            Some(FlatSamples::F32(values)) if values.len() == pixels => Ok(values),
            // Numbers of shapes and materials.
            Some(FlatSamples::U32(values)) if values.len() == pixels => Ok(values.iter().map(|value| *value as f32).collect()),
            _ => Err(failure(format!("its channel {name} is not as this program writes it"))),
        };
        let mut of_kernel = |kernel: KernelLayer| {
            let PartChannels { values, remainders, count } = kernel.part_channels();
            Ok(KernelChannels {
                means: values.iter().map(|name| channel(name)).collect::<Result<_, _>>()?,
                remainders: remainders.iter().map(|name| channel(name)).collect::<Result<_, _>>()?,
                counts: channel(count)?,
            })
        };
        let kernels = self.kernels().map(&mut of_kernel).collect::<Result<_, MergeError>>()?;
        let channels = part_channels().map(&mut channel).collect::<Result<_, _>>()?;
        let fixed = self.fixed_channels().map(&mut channel).collect::<Result<_, _>>()?;
        Ok(PartPixels { channels, kernels, fixed })
    }
}

impl KernelChannels {
    /// A pixel's means, and how many samples they are over.
    pub fn at(&self, pixel: usize) -> ([f64; 3], f64) {
        let mut means = [0.0; 3];
        for (mean, (nearest, rest)) in means.iter_mut().zip(self.means.iter().zip(&self.remainders)) {
            *mean = f64::from(nearest[pixel]) + f64::from(rest[pixel]);
        }
        (means, f64::from(self.counts[pixel]))
    }
}

/// The filter of which a header tells.
fn filter(text: &str) -> Filter {
    let parsed = text
        .split_once(", radius ")
        .and_then(|(kind, radius)| Some(Filter { kind: FilterKind::from_name(kind)?, radius: radius.parse().ok()? }));
    parsed.unwrap_or_default()
}

impl PartPixels {
    /// A pixel, counted within the part.
    pub fn at(&self, pixel: usize) -> PartPixel {
        // In the order of their names: blue, green and red, their remainders, the number of samples, and the variances.
        let [b, g, r, rest_b, rest_g, rest_r, count, var_b, var_g, var_r] =
            std::array::from_fn(|channel| f64::from(self.channels[channel][pixel]));
        let mean = [r + rest_r, g + rest_g, b + rest_b];
        let second_moment = crate::film::second_moment(mean, [var_r, var_g, var_b], count);
        PartPixel { mean, count, second_moment }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn filters_are_read_as_they_are_told() {
        for filter_told in [Filter::default(), Filter { kind: FilterKind::Gaussian, radius: 1.5 }] {
            assert_eq!(filter(&filter_told.to_string()), filter_told);
        }
    }
}
