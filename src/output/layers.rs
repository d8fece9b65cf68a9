//! Layers that go into an EXR file beside the picture. They are rendered before it and wait in temporary files, not in memory.

use std::borrow::Cow;
use std::fs::File;
use std::io::{Read, Result, Seek, SeekFrom, Write};
use std::sync::{Arc, Mutex, PoisonError};

use super::temporary::{in_temporary_folder, temporary_file};
use crate::film::{Layer, RenderedLayer, group_channels};

/// The channel of the numbers of samples that pixels have.
pub const SAMPLE_COUNT: &str = "SampleCount";

/// The channels of the ends of pixels' intervals.
pub const LOW: [&str; 3] = ["Low.R", "Low.G", "Low.B"];
pub const HIGH: [&str; 3] = ["High.R", "High.G", "High.B"];

/// Three numbers a pixel, row by row.
#[derive(Debug)]
pub struct LayerPicture {
    width: usize,
    file: Mutex<File>,
}

impl LayerPicture {
    /// All 0.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn new([width, height]: [u32; 2]) -> Result<Self> {
        let file = temporary_file()?;
        file.set_len(u64::from(width) * u64::from(height) * size_of::<[f32; 3]>() as u64).map_err(in_temporary_folder)?;
        Ok(Self { width: width as usize, file: Mutex::new(file) })
    }

    /// Writes whole rows, from this one on.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn write_rows(&self, first_row: u32, pixels: &[[f32; 3]]) -> Result<()> {
        let mut file = self.at_row(first_row)?;
        file.write_all(bytemuck::cast_slice(pixels)).map_err(in_temporary_folder)
    }

    /// A row.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn row(&self, row: u32) -> Result<Vec<[f32; 3]>> {
        let mut pixels = vec![[0.0; 3]; self.width];
        let mut file = self.at_row(row)?;
        file.read_exact(bytemuck::cast_slice_mut(&mut pixels))?;
        Ok(pixels)
    }

    fn at_row(&self, row: u32) -> Result<std::sync::MutexGuard<'_, File>> {
        // The file has no state but its position, which is set anew.
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(u64::from(row) * (self.width * size_of::<[f32; 3]>()) as u64))?;
        Ok(file)
    }
}

/// A channel beside red, green and blue.
#[derive(Debug, Clone)]
pub struct LayerChannel {
    pub name: Cow<'static, str>,
    pub source: LayerSource,
}

/// The source of a channel's numbers.
#[derive(Debug, Clone)]
pub enum LayerSource {
    /// One of a layer's three numbers.
    Component(Arc<LayerPicture>, usize),
    /// One of a layer's three numbers, which is a whole number.
    Whole(Arc<LayerPicture>, usize),
    /// The variance of a sample, from the mean of its square and the picture itself.
    Variance(Arc<LayerPicture>, usize),
    /// Samples of the pixel.
    Count,
    /// The low end of a channel's interval.
    Low(usize),
    /// The high end.
    High(usize),
}

impl LayerSource {
    /// The picture that holds it.
    pub fn picture(&self) -> Option<&Arc<LayerPicture>> {
        match self {
            Self::Component(picture, _) | Self::Whole(picture, _) | Self::Variance(picture, _) => Some(picture),
            Self::Count | Self::Low(_) | Self::High(_) => None,
        }
    }
}

impl LayerChannel {
    /// The channels of a layer whose numbers a picture holds; where none does, the number of samples is meant.
    pub fn of(layer: Layer, picture: Option<&Arc<LayerPicture>>) -> Vec<Self> {
        let ends = |names: [&'static str; 3], source: fn(usize) -> LayerSource| {
            names.into_iter().enumerate().map(|(place, name)| Self::new(name, source(place))).collect()
        };
        let Some(picture) = picture else {
            return match layer {
                Layer::Low => ends(LOW, LayerSource::Low),
                Layer::High => ends(HIGH, LayerSource::High),
                _ => vec![Self::new(SAMPLE_COUNT, LayerSource::Count)],
            };
        };
        let of_picture = |names: &[&'static str], source: &dyn Fn(usize) -> LayerSource| -> Vec<Self> {
            names.iter().enumerate().map(|(place, name)| Self::new(*name, source(place))).collect()
        };
        match layer {
            // Beside the depth stands how many of the samples met a surface.
            Layer::Alpha => vec![Self::new("A", LayerSource::Component(picture.clone(), 1))],
            Layer::Variance => {
                of_picture(&["Variance.R", "Variance.G", "Variance.B"], &|place| LayerSource::Variance(picture.clone(), place))
            }
            Layer::Ids => of_picture(&["ObjectId", "MaterialId"], &|place| LayerSource::Whole(picture.clone(), place)),
            _ => layer.kernel().map_or_else(Vec::new, |kernel| Self::components(kernel.part_channels().values, picture)),
        }
    }

    /// The channels of the light of a group.
    pub fn of_group(group: &str, picture: &Arc<LayerPicture>) -> Vec<Self> {
        Self::components(group_channels(group).to_vec(), picture)
    }

    /// A channel of this name.
    pub fn new(name: impl Into<Cow<'static, str>>, source: LayerSource) -> Self {
        Self { name: name.into(), source }
    }

    fn components(names: Vec<String>, picture: &Arc<LayerPicture>) -> Vec<Self> {
        let channel = |(place, name): (usize, String)| Self::new(name, LayerSource::Component(picture.clone(), place));
        names.into_iter().enumerate().map(channel).collect()
    }

    /// The channels that a part needs to be joined with others: means, their rounding errors, and how many
    /// samples they are over.
    pub fn of_part(layer: &RenderedLayer, [means, remainders, counts]: [&Arc<LayerPicture>; 3]) -> Vec<Self> {
        let channels = layer.part_channels();
        let of_names = [(channels.values, means), (channels.remainders, remainders), (vec![channels.count], counts)];
        of_names.into_iter().flat_map(|(names, picture)| Self::components(names, picture)).collect()
    }

    /// Adds those whose names are not there yet: a layer may be asked for twice.
    pub fn add_new(channels: &mut Vec<Self>, new: Vec<Self>) {
        for channel in new {
            if channels.iter().all(|other| other.name != channel.name) {
                channels.push(channel);
            }
        }
    }
}

/// Variance of a sample, unbiased, from the mean of so many and that of their squares.
pub fn sample_variance(mean: f32, square: f32, samples: u32) -> f32 {
    if samples < 2 {
        return 0.0;
    }
    let [mean, square, samples] = [f64::from(mean), f64::from(square), f64::from(samples)];
    ((square - mean * mean).max(0.0) * samples / (samples - 1.0)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_back_and_others_are_0() {
        let picture = LayerPicture::new([3, 4]).unwrap();
        picture.write_rows(1, &[[1.0, 2.0, 3.0]; 6]).unwrap();
        assert_eq!(picture.row(2).unwrap(), [[1.0, 2.0, 3.0]; 3]);
        assert_eq!(picture.row(0).unwrap(), [[0.0; 3]; 3]);
        assert_eq!(picture.row(3).unwrap(), [[0.0; 3]; 3]);
    }

    #[test]
    fn variances_are_those_of_the_samples() {
        // 1, 2, 6: mean 3, squares 41/3, variance 7.
        assert!((sample_variance(3.0, 41.0 / 3.0, 3) - 7.0).abs() < 1e-5);
        assert_eq!((sample_variance(3.0, 9.0, 1), sample_variance(2.0, 3.9999, 5)), (0.0, 0.0));
    }
}
