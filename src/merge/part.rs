//! A part's header, and its pixels.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use exr::meta::attribute::{AttributeValue, ChannelDescription, SampleType};
use exr::meta::header::Header;
use exr::prelude::Vec2;

use crate::choice::Choice;
use crate::film::{KernelLayer, Layer, PartChannels, RenderedLayer};
use crate::input;
use crate::output::{CROP_KEY, LAYERS_KEY, LIGHT_GROUPS_KEY, Provenance, SAMPLE_COUNT, part_channels};
use crate::picture_file::open_exr::{self, DIGEST_KEY, Windows};
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
    /// Samples or regions that are missing, in words.
    #[error("the picture is not whole: {0}; --partial joins what there is")]
    Missing(String),
}

/// Entries of a header in which parts of one picture may differ.
const OWN: [&str; 8] =
    ["gpt:device", "gpt:firstSample", "gpt:samples", "gpt:samplesWanted", "gpt:complete", "gpt:brokenOff", CROP_KEY, DIGEST_KEY];

/// The header of a part.
#[derive(Debug, Clone, PartialEq)]
pub struct PartHeader {
    pub path: PathBuf,
    /// Width and height of the whole picture.
    pub film: [u32; 2],
    /// First column and row, width and height.
    pub region: [u32; 4],
    /// Absolute indices.
    pub samples: Range<u32>,
    /// Its layers beside the picture, each once.
    pub layers: Vec<Layer>,
    entries: BTreeMap<String, String>,
}

/// The pixels of a part, row by row, channel by channel.
pub struct PartPixels {
    channels: Vec<Vec<f32>>,
    /// In the order of [`PartHeader::rendered`] and of [`PartHeader::fixed_channels`].
    pub rendered: Vec<RenderedChannels>,
    pub fixed: Vec<Vec<f32>>,
}

/// The channels of a layer: means, what rounding to them lost, and how many samples they are over.
pub struct RenderedChannels {
    means: Vec<Vec<f32>>,
    remainders: Vec<Vec<f32>>,
    counts: Vec<f32>,
}

/// A pixel of a part.
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
        let mut file = input::open_to_decode(path).map_err(|error| failure(error.to_string()))?;
        let headers = open_exr::headers(&mut file).map_err(|what| failure(format!("it {what}")))?;
        let header = &headers[0];
        let has = |name: &str| channels(&headers).any(|channel| channel.name.eq(name));
        if !part_channels().all(has) {
            return Err(failure(
                "it is no part of a picture: `gpt render --first-sample A --spp N` or `--crop X,Y,W,H` writes parts".to_owned(),
            ));
        }
        let mut oddities = open_exr::oddities(header);
        let lies_elsewhere = headers.iter().any(|other| Windows::of(other) != Windows::of(header));
        oddities.extend(lies_elsewhere.then(|| "its parts of OpenEXR lie in several places".to_owned()));
        if let Some(oddity) = oddities.first() {
            return Err(failure(format!("{oddity}: another program changed it, and only files of `gpt render` are joined")));
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
        let windows = Windows::of(header);
        let (film, region) = (windows.size(), windows.covered());
        let fits = region[2..] == windows.data_size();
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
    pub fn rendered(&self) -> impl Iterator<Item = RenderedLayer> {
        let wanted = |kernel: &KernelLayer| self.layers.iter().any(|layer| layer.kernel() == Some(*kernel));
        let groups = self.entries.get(LIGHT_GROUPS_KEY).filter(|_| self.layers.contains(&Layer::Groups));
        let groups = groups.into_iter().flat_map(|list| list.split(','));
        let kernels = KernelLayer::ALL.into_iter().filter(wanted).map(RenderedLayer::Kernel);
        kernels.chain(groups.map(|group| RenderedLayer::LightGroup(group.to_owned())))
    }

    /// Channels that are the same whatever the samples.
    pub fn fixed_channels(&self) -> impl Iterator<Item = &'static str> {
        let ids = self.layers.contains(&Layer::Ids).then_some(["ObjectId", "MaterialId"]);
        let mattes = self.layers.contains(&Layer::Cryptomatte).then(cryptomatte::channel_names);
        ids.into_iter().flatten().chain(mattes.into_iter().flatten())
    }

    /// The header's entries about mattes and light groups.
    pub fn notes(&self) -> Vec<(String, String)> {
        let notes = self.entries.iter().filter(|(key, _)| key.starts_with("cryptomatte/") || *key == LIGHT_GROUPS_KEY);
        notes.map(|(key, text)| (key.clone(), text.clone())).collect()
    }

    /// Checks that the other is a part of the same picture.
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

    /// The header entries of the whole picture, with so many samples per pixel from the first on.
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
            interval: None,
            device,
        }
    }

    /// The device that rendered it.
    pub fn device(&self) -> &str {
        self.entries.get("gpt:device").map_or("", String::as_str)
    }

    /// Reads the pixels.
    ///
    /// # Errors
    /// A file that is damaged.
    pub fn pixels(&self) -> Result<PartPixels, MergeError> {
        let failure = |what: String| MergeError::Part { path: self.path.clone(), what };
        let open = || input::open_to_decode(&self.path).map_err(|error| failure(error.to_string()));
        let headers = open_exr::headers(&mut open()?).map_err(|what| failure(format!("it {what}")))?;
        let list: Vec<&ChannelDescription> = channels(&headers).collect();
        let [width, height] = [self.region[2] as usize, self.region[3] as usize];
        // Numbers of shapes and materials are whole ones.
        let is_read = |kind: SampleType| matches!(kind, SampleType::F32 | SampleType::U32);
        let whole = list.iter().enumerate().filter(|(_, channel)| is_read(channel.sample_type) && channel.sampling == Vec2(1, 1));
        let wanted: Vec<usize> = whole.map(|(place, _)| place).collect();
        let mut planes = vec![vec![0.0; width * height]; wanted.len()];
        let mut strange = None;
        open_exr::read_checked_lines(open()?, &wanted, |(channel, [column, row], numbers)| {
            if let Some(place) = numbers.iter().position(|number| !number.is_finite()) {
                strange.get_or_insert((channel, [column + place, row], numbers[place]));
            }
            let plane = wanted.iter().position(|of| *of == channel).map(|plane| &mut planes[plane]);
            let start = row * width + column;
            if let Some(place) = plane.and_then(|plane| plane.get_mut(start..start + numbers.len())) {
                place.copy_from_slice(numbers);
            }
        })
        .map_err(&failure)?;
        if let Some((channel, [column, row], number)) = strange {
            let name = &list[channel].name;
            return Err(failure(format!("its channel {name} holds {number} at {column}, {row}, which is no finite number")));
        }
        let name = |place: &usize| list[*place].name.to_string();
        let mut found: BTreeMap<String, Vec<f32>> = wanted.iter().map(name).zip(planes).collect();
        let unknown = |name: &str| failure(format!("its channel {name} is not as this program writes it"));
        let mut channel = |name: &str| found.remove(name).ok_or_else(|| unknown(name));
        let mut of_layer = |layer: RenderedLayer| {
            let PartChannels { values, remainders, count } = layer.part_channels();
            Ok(RenderedChannels {
                means: values.iter().map(|name| channel(name)).collect::<Result<_, _>>()?,
                remainders: remainders.iter().map(|name| channel(name)).collect::<Result<_, _>>()?,
                counts: channel(&count)?,
            })
        };
        let rendered = self.rendered().map(&mut of_layer).collect::<Result<_, MergeError>>()?;
        let channels = part_channels().map(&mut channel).collect::<Result<_, _>>()?;
        let fixed = self.fixed_channels().map(&mut channel).collect::<Result<_, _>>()?;
        let pixels = PartPixels { channels, rendered, fixed };
        self.check_counts(&pixels).map_err(failure)?;
        Ok(pixels)
    }
}

impl PartHeader {
    /// Checks that pixels have the numbers of samples of which the header tells.
    fn check_counts(&self, pixels: &PartPixels) -> Result<(), String> {
        let width = self.region[2] as usize;
        // A time limit may leave pixels with more samples than the least finished one has, and none with more than were wanted.
        let most = self.entries.get("gpt:samplesWanted").and_then(|text| text.parse().ok()).unwrap_or(u32::MAX);
        let [least, most] = [self.samples.len() as f64, f64::from(most).max(self.samples.len() as f64)];
        let is_possible = |count: f32| count.fract() == 0.0 && (least..=most).contains(&f64::from(count));
        let strange = pixels.counts().iter().position(|count| !is_possible(*count));
        if let Some(place) = strange {
            let [column, row] = [place % width, place / width];
            let (count, said) = (pixels.counts()[place], self.samples.len());
            return Err(format!("its channel SampleCount holds {count} at {column}, {row}, and its header says {said} samples"));
        }
        let of_layers = pixels.rendered.iter().find_map(|layer| layer.counts.iter().find(|count| **count < 0.0));
        of_layers.map_or(Ok(()), |count| Err(format!("a layer has {count} samples of a pixel")))
    }
}

impl RenderedChannels {
    /// A pixel's means, and how many samples they are over.
    pub fn at(&self, pixel: usize) -> ([f64; 3], f64) {
        let mut means = [0.0; 3];
        for (mean, (nearest, rest)) in means.iter_mut().zip(self.means.iter().zip(&self.remainders)) {
            *mean = f64::from(nearest[pixel]) + f64::from(rest[pixel]);
        }
        (means, f64::from(self.counts[pixel]))
    }
}

/// The channels of all parts of a file, in their order.
fn channels(headers: &[Header]) -> impl Iterator<Item = &ChannelDescription> {
    headers.iter().flat_map(|header| &header.channels.list)
}

/// The filter of which a header tells.
fn filter(text: &str) -> Filter {
    let parsed = text
        .split_once(", radius ")
        .and_then(|(kind, radius)| Some(Filter { kind: FilterKind::from_name(kind)?, radius: radius.parse().ok()? }));
    parsed.unwrap_or_default()
}

impl PartPixels {
    fn counts(&self) -> &[f32] {
        part_channels().position(|name| name == SAMPLE_COUNT).map_or(&[], |place| &self.channels[place])
    }

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
    fn numbers_of_samples_are_those_of_the_header() {
        let header = PartHeader::for_tests([2, 1], [0, 0, 2, 1], 16..20);
        let check = |count: f32| {
            let channels = part_channels().map(|name| vec![1.0, if name == SAMPLE_COUNT { count } else { 1.0 }]);
            let mut channels: Vec<_> = channels.collect();
            let place = part_channels().position(|name| name == SAMPLE_COUNT).expect("it is there");
            channels[place][0] = 4.0;
            header.check_counts(&PartPixels { channels, rendered: Vec::new(), fixed: Vec::new() })
        };
        for wrong in [f32::NAN, -24.0, 0.0, 3.0, 4.5, f32::INFINITY] {
            let said = check(wrong).expect_err("it is refused");
            assert!(said.contains("SampleCount holds") && said.contains("at 1, 0") && said.contains("4 samples"), "{said}");
        }
        // A time limit may leave more samples, where the header does not say how many were wanted.
        assert!(check(4.0).is_ok() && check(6.0).is_ok(), "the control");
    }

    #[test]
    fn filters_are_read_as_they_are_written() {
        for written in [Filter::default(), Filter { kind: FilterKind::Gaussian, radius: 1.5 }] {
            assert_eq!(filter(&written.to_string()), written);
        }
    }
}
