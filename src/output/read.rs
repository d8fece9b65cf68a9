//! Pictures read back, from this program and from others.

use std::io::Read;
use std::path::{Path, PathBuf};

use exr::image::{AnyChannels, FlatSamples, Layer};
use exr::meta::MetaData;
use exr::prelude::{ReadChannels, ReadLayers, f16};
use image::{ImageFormat, ImageReader};

use crate::input::{self, AnyFile};
use crate::math::srgb_to_linear;
use crate::scene::settings::{MAX_PIXELS, MAX_SIDE};

/// A picture in memory, linear.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    pub width: u32,
    pub height: u32,
    /// Row by row from the top, `width * height` long.
    pub pixels: Vec<[f32; 3]>,
}

/// What the numbers of a picture file are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureKind {
    /// Floating-point numbers, linear: EXR, Radiance HDR.
    Linear,
    /// Integers along the sRGB curve, none above 1: PNG, JPEG and others.
    Encoded,
}

impl PictureKind {
    /// By the first bytes of the file. None where it cannot be read, or has a format that may be either.
    pub fn of(path: &Path) -> Option<Self> {
        match guess(path).ok()?.format()? {
            ImageFormat::OpenExr | ImageFormat::Hdr => Some(Self::Linear),
            ImageFormat::Tiff | ImageFormat::Pnm => None,
            _ => Some(Self::Encoded),
        }
    }
}

/// Why a picture could not be read.
#[derive(Debug, thiserror::Error)]
#[error("cannot read {}: {what}", path.display())]
pub struct ReadError {
    pub path: PathBuf,
    pub what: String,
}

/// First bytes of every OpenEXR file.
const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Reads an OpenEXR file, or any format the `image` crate knows (PNG, Radiance HDR, …), by its content.
///
/// Of an OpenEXR file's channels, `R`, `G` and `B` count, else the first that end so (`Combined.R`), else one luminance channel
/// `Y`. Integer formats are taken for sRGB and made linear; float formats are linear.
///
/// # Errors
/// A file that is missing, broken, of an unknown format, too large, or without colour channels.
pub fn read_image(path: &Path) -> Result<Image, ReadError> {
    let failure = |what: String| ReadError { path: path.to_owned(), what };
    let mut magic = [0; 4];
    let is_exr = input::open(path)
        .and_then(|mut file| file.read_exact(&mut magic).map(|()| magic == EXR_MAGIC).or_else(short_file))
        .map_err(|error| failure(error.to_string()))?;
    if is_exr { read_exr(path).map_err(failure) } else { read_other(path).map_err(failure) }
}

/// A file shorter than the magic number is no OpenEXR file; that is an answer, not a failure.
fn short_file(error: std::io::Error) -> std::io::Result<bool> {
    if error.kind() == std::io::ErrorKind::UnexpectedEof { Ok(false) } else { Err(error) }
}

fn open(path: &Path) -> Result<AnyFile, String> {
    Ok(Box::new(input::open(path).map_err(|error| error.to_string())?))
}

/// Opens an OpenEXR file whose layers are no larger than pictures may be: its headers say so before anything is decoded.
pub fn open_exr(path: &Path) -> Result<AnyFile, String> {
    let meta = MetaData::read_from_buffered(open(path)?, false).map_err(|error| error.to_string())?;
    for header in &meta.headers {
        check_size(header.layer_size.width() as u64, header.layer_size.height() as u64)?;
    }
    open(path)
}

fn read_exr(path: &Path) -> Result<Image, String> {
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .from_buffered(open_exr(path)?)
        .map_err(|error| error.to_string())?;
    let (layer, channels) = find_colour(&image.layer_data).ok_or("it has no channels R, G and B")?;
    let [red, green, blue] = channels.map(|index| &layer.channel_data.list[index].sample_data);
    let (width, height) = (layer.size.width(), layer.size.height());
    if [red, green, blue].iter().any(|samples| samples.len() != width * height) {
        return Err("its colour channels are stored at a reduced resolution".to_owned());
    }
    let pixels = (0..width * height).map(|index| [sample(red, index), sample(green, index), sample(blue, index)]).collect();
    Ok(Image { width: width as u32, height: height as u32, pixels })
}

/// The layer and its channels that hold the colour.
fn find_colour(layers: &[Layer<AnyChannels<FlatSamples>>]) -> Option<(&Layer<AnyChannels<FlatSamples>>, [usize; 3])> {
    let plain = layers.iter().find_map(|layer| Some((layer, channels_with_prefix(layer, "")?)));
    let named = || {
        layers.iter().find_map(|layer| {
            let names = layer.channel_data.list.iter().map(|channel| channel.name.to_string());
            let prefixes = names.filter_map(|name| name.strip_suffix(".R").map(|prefix| format!("{prefix}.")));
            prefixes.filter_map(|prefix| channels_with_prefix(layer, &prefix)).next().map(|channels| (layer, channels))
        })
    };
    let grey = || layers.iter().find_map(|layer| Some((layer, [channel(layer, "Y")?; 3])));
    plain.or_else(named).or_else(grey)
}

fn channels_with_prefix(layer: &Layer<AnyChannels<FlatSamples>>, prefix: &str) -> Option<[usize; 3]> {
    let find = |name: &str| channel(layer, &format!("{prefix}{name}"));
    Some([find("R")?, find("G")?, find("B")?])
}

fn channel(layer: &Layer<AnyChannels<FlatSamples>>, name: &str) -> Option<usize> {
    layer.channel_data.list.iter().position(|channel| channel.name.eq(name))
}

pub(super) fn sample(samples: &FlatSamples, index: usize) -> f32 {
    match samples {
        FlatSamples::F16(values) => f16::to_f32(values[index]),
        FlatSamples::F32(values) => values[index],
        FlatSamples::U32(values) => values[index] as f32,
    }
}

fn guess(path: &Path) -> Result<ImageReader<AnyFile>, String> {
    let mut reader = ImageReader::new(open(path)?);
    // The ending says what a file without a signature is, as TGA files are.
    if let Ok(format) = ImageFormat::from_path(path) {
        reader.set_format(format);
    }
    reader.with_guessed_format().map_err(|error| error.to_string())
}

fn read_other(path: &Path) -> Result<Image, String> {
    let reader = guess(path)?;
    if reader.format().is_none() {
        return Err("it is no picture in a format this program knows".to_owned());
    }
    let (width, height) = reader.into_dimensions().map_err(|error| error.to_string())?;
    check_size(width.into(), height.into())?;
    let mut reader = guess(path)?;
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    // Room for the largest picture at 16 bytes a pixel.
    limits.max_alloc = Some(MAX_PIXELS * 16);
    reader.limits(limits);
    let decoded = reader.decode().map_err(|error| error.to_string())?;
    let is_float = matches!(decoded.color(), image::ColorType::Rgb32F | image::ColorType::Rgba32F);
    let (width, height) = (decoded.width(), decoded.height());
    let encoded = decoded.into_rgb32f();
    let to_linear = |value: f32| if is_float { value } else { srgb_to_linear(value) };
    let pixels = encoded.pixels().map(|pixel| pixel.0.map(to_linear)).collect();
    Ok(Image { width, height, pixels })
}

fn check_size(width: u64, height: u64) -> Result<(), String> {
    if width > u64::from(MAX_SIDE) || height > u64::from(MAX_SIDE) || width * height > MAX_PIXELS {
        return Err(format!(
            "{width}x{height} pixels are more than the {MAX_SIDE} on a side or {MAX_PIXELS} in all that are read"
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::srgb_byte;

    #[test]
    fn decoding_undoes_encoding() {
        for code in 0..=255_u8 {
            assert_eq!(srgb_byte(srgb_to_linear(f32::from(code) / 255.0)), code);
        }
    }

    #[test]
    fn half_floats_and_named_layers_are_read() {
        use exr::prelude::*;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("layers.exr");
        let channel = |name: &str, value: f32| AnyChannel::new(name, FlatSamples::F16(vec![f16::from_f32(value); 6]));
        let list =
            [channel("Combined.A", 1.0), channel("Combined.B", 3.0), channel("Combined.G", 2.0), channel("Combined.R", 1.0)];
        let channels = AnyChannels::sort(list.into_iter().collect());
        exr::image::Image::from_channels((3, 2), channels).write().to_file(&path).unwrap();
        let image = read_image(&path).unwrap();
        assert_eq!((image.width, image.height), (3, 2));
        assert_eq!(image.pixels, [[1.0, 2.0, 3.0]; 6]);
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("text.exr");
        for content in ["", "no", "this is no picture at all", "\u{76}\u{2f}\u{31}\u{1} and then nothing like a header"] {
            std::fs::write(&path, content).unwrap();
            let error = read_image(&path).unwrap_err().to_string();
            assert!(error.contains("text.exr"), "{error}");
        }
        assert!(read_image(&folder.path().join("missing.exr")).is_err());
    }
}
