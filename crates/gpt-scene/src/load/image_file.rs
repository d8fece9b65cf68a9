//! The pictures of a scene as linear texels, out of one budget of memory.

use std::fmt;
use std::hash::{Hash, Hasher};
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

use exr::prelude::f16;
use image::{DynamicImage, ImageFormat, ImageReader, Limits, Rgba};

use super::error::show;
use super::files::Files;
use super::memory;
use crate::input::AnyFile;
use crate::math::srgb_to_linear;
use crate::picture_file::{Hints, PictureFile};
use crate::scene::{Channel, ColorSpace, ImageData, ImageSource, Texels};

/// Most texels on a side.
const LARGEST_SIDE: u32 = 16_384;
/// Bytes of a texel once it is read, at most.
const MOST_KEPT: u64 = size_of::<[f32; 4]>() as u64;
/// Most bytes of a texel besides those while it is decoded.
const WHILE_DECODED: u64 = 28;
/// Pictures of more texels are decoded one at a time.
const LARGE: u64 = 1 << 24;
/// Stands for texels that are infinite, which most of them became by overflow: the largest half-precision number.
const OVERFLOWN: f32 = 65_504.0;

/// The pictures of a scene. All together have one budget of memory, and what headers say is compared with it before anything is decoded.
#[derive(Debug)]
pub struct Pictures {
    files: Files,
    budget: u64,
    /// Bytes that the pictures so far take, or may take.
    kept: AtomicU64,
    large: Mutex<()>,
}

/// A file that stands within another one.
#[derive(Debug, Clone)]
pub struct EmbeddedFile {
    /// Its name, with an ending that says its format.
    pub name: String,
    pub bytes: Arc<[u8]>,
}

/// Source of the bytes of a picture.
#[derive(Debug, Clone)]
pub enum PictureSource {
    File(PathBuf),
    Embedded(Arc<EmbeddedFile>),
}

impl PictureSource {
    /// The file's name, whose ending says its format.
    pub fn name(&self) -> &Path {
        match self {
            Self::File(path) => path,
            Self::Embedded(file) => Path::new(&file.name),
        }
    }

    /// The source by which a written scene names the picture.
    pub fn to_source(&self, color_space: Option<ColorSpace>) -> ImageSource {
        let embedded = if let Self::Embedded(file) = self { Some(file.bytes.clone()) } else { None };
        ImageSource { path: self.name().to_owned(), embedded, color_space, scale: 1.0 }
    }
}

impl fmt::Display for PictureSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&show(self.name()))
    }
}

/// Embedded files are the same where they are the same in memory.
impl PartialEq for PictureSource {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::File(path), Self::File(other)) => path == other,
            (Self::Embedded(file), Self::Embedded(other)) => Arc::ptr_eq(file, other),
            _ => false,
        }
    }
}

impl Eq for PictureSource {}

impl Hash for PictureSource {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match self {
            Self::File(path) => path.hash(state),
            Self::Embedded(file) => Arc::as_ptr(file).hash(state),
        }
    }
}

/// A picture that was read.
#[derive(Debug)]
pub struct DecodedImage {
    pub image: ImageData,
    /// Bits of an integer; None: floating-point numbers.
    pub integer_bits: Option<u16>,
    /// Repairs of the picture, in words.
    pub change: Option<String>,
    /// Properties that its header states and nothing uses, in sentences without the file's name.
    pub notes: Vec<String>,
    pub hints: Hints,
    /// Other programs see the same in the file, whatever of its header they read.
    pub is_plain: bool,
}

/// Reads an image and turns it into linear colours. Without a colour space, formats of integers are taken to be sRGB and those of
/// floating-point numbers linear. The error says what is wrong with the file, without its name.
pub fn read_image(path: &Path, color_space: Option<ColorSpace>) -> Result<ImageData, String> {
    Pictures::new(Files::default()).read_file(path, color_space).map(|picture| picture.image)
}

/// A picture of one texel with these numbers from 0 to 1, as PNG.
pub fn one_texel(numbers: [f64; 3]) -> Result<Vec<u8>, String> {
    let texel = image::Rgb(numbers.map(|number| (65_535.0 * number).round() as u16));
    let mut encoded = Cursor::new(Vec::new());
    let picture = image::ImageBuffer::<image::Rgb<u16>, Vec<u16>>::from_pixel(1, 1, texel);
    DynamicImage::ImageRgb16(picture).write_to(&mut encoded, ImageFormat::Png).map_err(|error| error.to_string())?;
    Ok(encoded.into_inner())
}

/// A picture of a format that its bytes tell, as it is encoded.
///
/// # Errors
/// A sentence about what cannot be read.
pub fn decoded(bytes: &[u8]) -> Result<image::DynamicImage, String> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|error| error.to_string())?;
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(LARGEST_SIDE), Some(LARGEST_SIDE));
    reader.limits(limits);
    reader.decode().map_err(|error| format!("is not a valid image: {error}"))
}

/// A picture of one channel, as PNG: 1 less the alpha of an encoded picture, times a factor.
pub fn inverted_alpha(bytes: &[u8], factor: f64) -> Result<Vec<u8>, String> {
    let invalid = |error: image::ImageError| format!("is not a valid image: {error}");
    let alpha = decoded(bytes)?.into_rgba8();
    let byte = |alpha: u8| (255.0 * (1.0 - factor * f64::from(alpha) / 255.0)).round().clamp(0.0, 255.0) as u8;
    let grey = image::GrayImage::from_fn(alpha.width(), alpha.height(), |x, y| image::Luma([byte(alpha.get_pixel(x, y).0[3])]));
    let mut encoded = Cursor::new(Vec::new());
    grey.write_to(&mut encoded, ImageFormat::Png).map_err(invalid)?;
    Ok(encoded.into_inner())
}

impl Pictures {
    /// With half of the memory that is free.
    pub fn new(files: Files) -> Self {
        Self::within(files, memory::available() / 2)
    }

    /// With a budget in bytes.
    pub fn within(files: Files, budget: u64) -> Self {
        Self { files, budget, kept: AtomicU64::new(0), large: Mutex::new(()) }
    }

    pub fn files(&self) -> &Files {
        &self.files
    }

    /// [`read_image`] within this budget.
    pub fn read_file(&self, path: &Path, color_space: Option<ColorSpace>) -> Result<DecodedImage, String> {
        self.read(&PictureSource::File(path.to_owned()), color_space)
    }

    /// Reads a picture from a file, or from within one.
    pub fn read(&self, source: &PictureSource, color_space: Option<ColorSpace>) -> Result<DecodedImage, String> {
        let file = PictureFile::open(self.open(source)?, source.name(), color_space)?;
        let integer_bits = match &file {
            PictureFile::Coded(file) => Some(file.bits()).filter(|bits| *bits <= 16),
            _ => None,
        };
        let (notes, hints, is_plain) = (file.notes().to_vec(), file.hints(), file.is_plain());
        let most_kept = if integer_bits == Some(8) { 4 } else { MOST_KEPT };
        let mut beyond = 0;
        let mut image = self.decode([file.size(), file.data_size()], most_kept, || texels(file, &mut beyond))?;
        let beyond =
            (beyond > 0).then(|| format!("{beyond} texels have colours beyond Rec. 709: 0 stands for what is negative in them"));
        let change = [beyond, clamp(&mut image)?].into_iter().flatten().reduce(|a, b| format!("{a}; {b}"));
        Ok(DecodedImage { image, integer_bits, change, notes, hints, is_plain })
    }

    fn open(&self, source: &PictureSource) -> Result<AnyFile, String> {
        let path = match source {
            PictureSource::File(path) => path,
            PictureSource::Embedded(file) => return Ok(Box::new(Cursor::new(file.bytes.clone()))),
        };
        self.files.open(path).map_err(|error| format!("cannot be read: {error}"))
    }

    /// Calls `decode` if there is room for the picture, of which so much is shown and so much decoded, and which will take so many bytes a texel at
    /// most.
    fn decode(
        &self,
        sizes: [[u32; 2]; 2],
        most_kept: u64,
        decode: impl FnOnce() -> Result<ImageData, String>,
    ) -> Result<ImageData, String> {
        for [width, height] in sizes {
            if width == 0 || height == 0 {
                return Err(format!("the image is empty: {width} x {height} pixels"));
            }
            if width.max(height) > LARGEST_SIDE {
                return Err(format!("the image is too large: {width} x {height} pixels, at most {LARGEST_SIDE} on a side"));
            }
        }
        let area = |[width, height]: [u32; 2]| u64::from(width) * u64::from(height);
        let [width, height] = if area(sizes[1]) > area(sizes[0]) { sizes[1] } else { sizes[0] };
        let texels = area([width, height]);
        let most = most_kept * texels;
        let needed = self.kept.fetch_add(most, Ordering::Relaxed) + most + WHILE_DECODED * texels;
        if needed > self.budget {
            self.kept.fetch_sub(most, Ordering::Relaxed);
            let (needed, budget) = (needed.div_ceil(1 << 20), self.budget >> 20);
            return Err(format!(
                "the image of {width} x {height} pixels does not fit: with those before, it needs {needed} MiB of memory, and pictures \
                 may take {budget} MiB here; make it smaller"
            ));
        }
        // A poisoned lock has lost nothing: it holds no data.
        let _alone = (texels > LARGE).then(|| self.large.lock().unwrap_or_else(std::sync::PoisonError::into_inner));
        let decoded = decode();
        let kept = decoded.as_ref().map_or(0, |image| image.texels.as_bytes().len() as u64);
        self.kept.fetch_sub(most.saturating_sub(kept), Ordering::Relaxed);
        decoded
    }
}

/// The texels of a picture whose header was read. Colours of other primaries may be negative as Rec. 709's; `beyond` counts those.
fn texels(file: PictureFile, beyond: &mut usize) -> Result<ImageData, String> {
    if let PictureFile::Coded(file) = file {
        return file.decode_codes().map(|(image, space)| image_data(image, space));
    }
    let size @ [width, height] = file.size();
    let converts = file.converts();
    let mut texels = vec![file.empty(); width as usize * height as usize];
    file.decode(&mut |[column, row], pixels| {
        let start = row * width as usize + column;
        texels[start..start + pixels.len()].copy_from_slice(pixels);
    })?;
    if converts {
        let is_negative = |value: &f32| *value < 0.0 && value.is_finite();
        for texel in texels.iter_mut().filter(|texel| texel[..3].iter().any(is_negative)) {
            // Rounding alone is not worth a word.
            *beyond += usize::from(texel[..3].iter().any(|value| *value < -1e-3));
            texel[..3].iter_mut().filter(|value| is_negative(value)).for_each(|value| *value = 0.0);
        }
    }
    Ok(from_floats(size, texels))
}

/// Makes the few texels possible that are negative or not finite, as filters and overflow leave them in many maps.
fn clamp(image: &mut ImageData) -> Result<Option<String>, String> {
    let possible = |value: f32| value.is_finite() && value >= 0.0;
    if matches!(image.texels, Texels::Bytes { .. } | Texels::Shorts { .. }) {
        return Ok(None);
    }
    let all = image.texels.len();
    let is_bad = |index: usize| !image.texels.get(index).into_iter().all(possible);
    let bad: Vec<usize> = (0..all).filter(|&index| is_bad(index)).collect();
    let count = bad.len();
    if count == 0 {
        return Ok(None);
    }
    if count > 1 && count > all / 10 {
        return Err(format!("{count} of the image's {all} texels are negative or not finite, so it holds no colours"));
    }
    let values = image.texels.colors().flat_map(|texel| texel.to_array());
    let largest = values.filter(|value| possible(*value)).fold(OVERFLOWN, f32::max);
    let mend = |value: f32| {
        if value == f32::INFINITY {
            largest
        } else if possible(value) {
            value
        } else {
            0.0
        }
    };
    let mut texels: Vec<[f32; 4]> = (0..all).map(|index| image.texels.get(index)).collect();
    bad.into_iter().for_each(|index| texels[index] = texels[index].map(mend));
    *image = from_floats([image.width, image.height], texels);
    let texels = if count == 1 { "one texel that is".to_owned() } else { format!("{count} texels that are") };
    Ok(Some(format!("{texels} negative or not finite: 0 stands for negative values, {largest} for infinite ones")))
}

/// Linear texels, in the least memory that holds their values.
fn from_floats([width, height]: [u32; 2], texels: Vec<[f32; 4]>) -> ImageData {
    let has_alpha = texels.iter().any(|texel| texel[3] != 1.0);
    let half =
        |value: f32| Some(f16::from_f32(value)).filter(|half| half.is_finite() && half.to_f32() == value).map(f16::to_bits);
    let in_half = |texel: &[f32; 4]| {
        let [red, green, blue, alpha] = texel.map(half);
        Some([red?, green?, blue?, alpha?])
    };
    let texels = match texels.iter().map(in_half).collect() {
        Some(numbers) => Texels::Half(numbers),
        None if has_alpha => Texels::FloatAlpha(texels),
        None => Texels::Float(texels.into_iter().map(|[red, green, blue, _]| [red, green, blue]).collect()),
    };
    ImageData { width, height, texels, has_alpha }
}

fn image_data(image: DynamicImage, space: ColorSpace) -> ImageData {
    let is_float = matches!(image, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_));
    let (width, height) = (image.width(), image.height());
    let eight_bits = matches!(image.color().bytes_per_pixel() / image.color().channel_count(), 1);
    if is_float {
        let decoded = |texel: &Rgba<f32>| {
            let [red, green, blue, alpha] = texel.0;
            [decode(red, space), decode(green, space), decode(blue, space), alpha]
        };
        return from_floats([width, height], image.into_rgba32f().pixels().map(decoded).collect());
    }
    let texels = if eight_bits {
        Texels::Bytes { codes: image.into_rgba8().pixels().map(|pixel| pixel.0).collect(), space }
    } else {
        Texels::Shorts { codes: image.into_rgba16().pixels().map(|pixel| pixel.0).collect(), space }
    };
    let has_alpha = texels.channel(Channel::A).any(|alpha| alpha != 1.0);
    ImageData { width, height, texels, has_alpha }
}

fn decode(value: f32, space: ColorSpace) -> f32 {
    match space {
        ColorSpace::Srgb => srgb_to_linear(value),
        ColorSpace::Linear => value,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_srgb_curve_meets_its_published_values() {
        assert_eq!(srgb_to_linear(0.0), 0.0);
        assert_eq!(srgb_to_linear(1.0), 1.0);
        // 0.04045 / 12.92 where the pieces meet, and the middle grey 128/255.
        approx::assert_relative_eq!(srgb_to_linear(0.04045), 0.003_130_805, max_relative = 1e-6);
        approx::assert_relative_eq!(srgb_to_linear(128.0 / 255.0), 0.215_860_5, max_relative = 1e-6);
    }

    #[test]
    fn pictures_share_a_budget_and_headers_are_compared_with_it() {
        let folder = tempfile::tempdir().unwrap();
        let paths = ["a.png", "b.exr", "c.png"].map(|name| folder.path().join(name));
        image::RgbImage::new(100, 100).save(&paths[0]).unwrap();
        exr::prelude::write_rgb_file(&paths[1], 100, 100, |_, _| (1.0_f32, 1.0_f32, 1.0_f32)).unwrap();
        image::RgbImage::new(3000, 3000).save(&paths[2]).unwrap();
        // Room for both small pictures, of four bytes and of half-precision numbers, but not while a third is decoded.
        let pictures = Pictures::within(Files::default(), 10_000 * (4 + MOST_KEPT + WHILE_DECODED));
        let read = |path: &Path| pictures.read_file(path, None).map(|picture| picture.image.texels.len());
        let refusal = read(&paths[2]).unwrap_err();
        assert!(refusal.contains("3000 x 3000") && refusal.contains("275 MiB"), "{refusal}");
        // Refused pictures take no memory.
        assert_eq!((read(&paths[0]), read(&paths[1])), (Ok(10_000), Ok(10_000)));
        assert_eq!(pictures.kept.load(Ordering::Relaxed), 10_000 * (4 + 8));
        assert!(read(&paths[1]).is_err());
    }

    #[test]
    fn a_few_impossible_texels_are_mended_and_many_are_refused() {
        let mut texels = vec![[1.0; 4]; 100];
        let image = |texels: &[[f32; 4]]| from_floats([100, 1], texels.to_vec());
        assert_eq!(clamp(&mut image(&texels)), Ok(None));
        texels[3] = [f32::INFINITY, -0.01, 2.0, 1.0];
        texels[4] = [f32::NAN, f32::NEG_INFINITY, 1.0, 1.0];
        let mut image_of_texels = image(&texels);
        let change = clamp(&mut image_of_texels).unwrap().unwrap();
        assert!(change.starts_with("2 texels") && change.contains("65504"), "{change}");
        assert_eq!([3, 4].map(|index| image_of_texels.texels.get(index)), [[65_504.0, 0.0, 2.0, 1.0], [0.0, 0.0, 1.0, 1.0]]);
        assert_eq!(clamp(&mut image_of_texels), Ok(None));
        texels[..50].fill([-1.0; 4]);
        assert!(clamp(&mut image(&texels)).is_err());
    }
}
