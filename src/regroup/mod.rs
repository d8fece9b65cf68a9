//! The light groups of a finished picture, weighed anew and added up (`gpt regroup`). Light is linear: a group that is multiplied is the picture with
//! its emitters multiplied, as long as they are weighed as they were when the picture's samples were placed.

mod weight;

use std::path::Path;
use std::sync::Arc;

use crate::film::{KernelLayer, Layer, group_channels};
use crate::output::{
    Channels, Image, LAYERS_KEY, LIGHT_GROUPS_KEY, LayerChannel, LayerPicture, LayerSource, PartSpec, SAMPLE_COUNT, cut,
    read_picture,
};
use crate::render::cryptomatte;

pub use weight::GroupWeight;

/// Key of the header: by what the groups of a picture were multiplied.
pub const WEIGHTS_KEY: &str = "gpt:regrouped";

/// Layers that say nothing of light, which stay what they are.
const KEPT: [Layer; 11] = [
    Layer::Albedo,
    Layer::Normal,
    Layer::Position,
    Layer::Uv,
    Layer::ObjectPosition,
    Layer::Motion,
    Layer::Depth,
    Layer::Alpha,
    Layer::Samples,
    Layer::Ids,
    Layer::Cryptomatte,
];

/// Why a picture cannot be regrouped; sentences without the file's name.
#[derive(Debug, thiserror::Error)]
pub enum RegroupError {
    /// The file cannot be read.
    #[error(transparent)]
    Read(#[from] crate::output::ReadError),
    #[error(
        "it has no light groups: `gpt render --aov groups` writes those that emitters of the scene name by light_group = \"key\""
    )]
    NoGroups,
    #[error("its header names the light group {0:?}, and it has no channels {0}.R, {0}.G and {0}.B: another program changed it")]
    NoChannels(String),
    #[error("it has no light group {group:?}; its groups are {}", .known.join(", "))]
    Unknown { group: String, known: Vec<String> },
    #[error("the light group {0:?} is given two weights")]
    Twice(String),
    /// Layers wait in temporary files.
    #[error("cannot keep a layer in a temporary file: {0}")]
    Temporary(#[from] std::io::Error),
}

/// A picture as its light groups, with its other layers.
pub struct GroupedPicture {
    channels: Channels,
    /// The groups' names, in the order of the header.
    names: Vec<String>,
    lights: Vec<Vec<[f32; 3]>>,
    /// The part of the display window that has pixels: first column and row, width and height.
    covered: [u32; 4],
    /// Properties of the file that nothing uses, in sentences without its name.
    pub notes: Vec<String>,
}

/// A picture of which the groups were weighed.
pub struct Regrouped {
    pub picture: Image,
    /// Its groups with their new light, and the layers that say nothing of light.
    pub layers: Vec<LayerChannel>,
    pub layer_names: Vec<Layer>,
    /// Entries of the header.
    pub header: Vec<(String, String)>,
    /// The place in the whole picture, where it is a part of one.
    pub placed: Option<PartSpec>,
    /// Layers of light that no longer fit and are left out.
    pub dropped: Vec<Layer>,
}

impl GroupedPicture {
    /// Reads an EXR file that `gpt render --aov groups` wrote.
    ///
    /// # Errors
    /// [`RegroupError::Read`], [`RegroupError::NoGroups`] and [`RegroupError::NoChannels`].
    pub fn read(path: &Path) -> Result<Self, RegroupError> {
        let channels = Channels::read(path)?;
        // A picture without groups is none of ours, whatever else is wrong with it.
        Self::names(&channels)?;
        let read = read_picture(path)?;
        Self::of_channels(channels, read.covered, read.notes)
    }

    /// A picture that is in memory: all of its channels by their names in EXR files, and what its header would say of its layers and its groups.
    ///
    /// # Errors
    /// [`RegroupError::NoGroups`] and [`RegroupError::NoChannels`].
    pub fn of_memory(channels: Channels) -> Result<Self, RegroupError> {
        let whole = [0, 0, channels.width, channels.height];
        Self::of_channels(channels, whole, Vec::new())
    }

    fn names(channels: &Channels) -> Result<Vec<String>, RegroupError> {
        let list = channels.attribute(LIGHT_GROUPS_KEY).unwrap_or_default();
        let names: Vec<String> = list.split(',').filter(|name| !name.is_empty()).map(str::to_owned).collect();
        if names.is_empty() { Err(RegroupError::NoGroups) } else { Ok(names) }
    }

    fn of_channels(channels: Channels, covered: [u32; 4], notes: Vec<String>) -> Result<Self, RegroupError> {
        let names = Self::names(&channels)?;
        let light = |name: &String| {
            let [red, green, blue] = group_channels(name);
            let colours = channels.colours([&red, &green, &blue]).ok_or_else(|| RegroupError::NoChannels(name.clone()))?;
            Ok(cut(&colours, channels.width, covered))
        };
        let lights = names.iter().map(light).collect::<Result<_, RegroupError>>()?;
        Ok(Self { names, lights, covered, notes, channels })
    }

    /// The groups' names, in their order.
    pub fn names_of_groups(&self) -> &[String] {
        &self.names
    }

    /// The picture with its groups weighed so; those without a weight stay as they are. Every pixel is Σ wᵢ·Lᵢ, in double precision, rounded once.
    ///
    /// # Errors
    /// [`RegroupError::Unknown`], [`RegroupError::Twice`] and [`RegroupError::Temporary`].
    pub fn weighed(&self, weights: &[GroupWeight]) -> Result<Regrouped, RegroupError> {
        let mut of_groups = vec![[1.0_f64; 3]; self.names.len()];
        let mut is_weighed = vec![false; self.names.len()];
        for GroupWeight { group, weight } in weights {
            let Some(number) = self.names.iter().position(|name| name == group) else {
                return Err(RegroupError::Unknown { group: group.clone(), known: self.names.clone() });
            };
            if std::mem::replace(&mut is_weighed[number], true) {
                return Err(RegroupError::Twice(group.clone()));
            }
            of_groups[number] = *weight;
        }
        let [column, row, width, height] = self.covered;
        let mut sums = vec![[0.0_f64; 3]; width as usize * height as usize];
        let mut layers = Vec::new();
        for ((name, light), weight) in self.names.iter().zip(&self.lights).zip(&of_groups) {
            let mut weighed = Vec::with_capacity(light.len());
            for (sum, pixel) in sums.iter_mut().zip(light) {
                let product: [f64; 3] = std::array::from_fn(|channel| weight[channel] * f64::from(pixel[channel]));
                sum.iter_mut().zip(product).for_each(|(sum, product)| *sum += product);
                weighed.push(product.map(|value| value as f32));
            }
            layers.extend(LayerChannel::of_group(name, &self.layer_picture(&weighed)?));
        }
        let pixels = sums.iter().map(|sum| sum.map(|value| value as f32)).collect();
        let named = Layer::from_list(self.channels.attribute(LAYERS_KEY).unwrap_or_default()).unwrap_or_default();
        let (kept, dropped): (Vec<Layer>, Vec<Layer>) =
            named.into_iter().filter(|layer| *layer != Layer::Groups).partition(|layer| KEPT.contains(layer));
        for layer in &kept {
            layers.extend(self.channels_of(*layer)?);
        }
        let film = [self.channels.width, self.channels.height];
        Ok(Regrouped {
            picture: Image { width, height, pixels },
            layers,
            layer_names: kept.into_iter().chain([Layer::Groups]).collect(),
            header: self.header(&of_groups),
            placed: (self.covered != [0, 0, film[0], film[1]]).then_some(PartSpec { film, origin: [column, row] }),
            dropped,
        })
    }

    /// The header's entries: what was done, the groups, and what explains mattes.
    fn header(&self, weights: &[[f64; 3]]) -> Vec<(String, String)> {
        let of_group =
            |(name, weight): (&String, &[f64; 3])| format!("{name}={}", weight.map(|weight| weight.to_string()).join(" "));
        let said: Vec<String> = self.names.iter().zip(weights).map(of_group).collect();
        let mattes = self.channels.attributes().filter(|(key, _)| key.starts_with("cryptomatte/"));
        let mattes = mattes.map(|(key, text)| (key.to_owned(), text.to_owned()));
        let own = [(WEIGHTS_KEY.to_owned(), said.join("; ")), (LIGHT_GROUPS_KEY.to_owned(), self.names.join(","))];
        own.into_iter().chain(mattes).collect()
    }

    /// The channels of a layer that stays, as far as the file has them.
    fn channels_of(&self, layer: Layer) -> Result<Vec<LayerChannel>, RegroupError> {
        let names: Vec<String> = match layer {
            Layer::Alpha => vec!["A".to_owned()],
            Layer::Samples => vec![SAMPLE_COUNT.to_owned()],
            Layer::Ids => vec!["ObjectId".to_owned(), "MaterialId".to_owned()],
            Layer::Cryptomatte => cryptomatte::channel_names().map(str::to_owned).collect(),
            _ => layer.kernel().map(KernelLayer::part_channels).map_or_else(Vec::new, |channels| channels.values),
        };
        let is_whole = matches!(layer, Layer::Samples | Layer::Ids);
        let mut channels = Vec::new();
        for name in names {
            let Some(values) = self.channels.channel(&name) else { continue };
            let pixels: Vec<[f32; 3]> =
                cut(values, self.channels.width, self.covered).into_iter().map(|value| [value; 3]).collect();
            let picture = self.layer_picture(&pixels)?;
            let source = if is_whole { LayerSource::Whole(picture, 0) } else { LayerSource::Component(picture, 0) };
            channels.push(LayerChannel::new(name, source));
        }
        Ok(channels)
    }

    fn layer_picture(&self, pixels: &[[f32; 3]]) -> Result<Arc<LayerPicture>, RegroupError> {
        let [_, _, width, height] = self.covered;
        let picture = LayerPicture::new([width, height])?;
        picture.write_rows(0, pixels)?;
        Ok(Arc::new(picture))
    }
}
