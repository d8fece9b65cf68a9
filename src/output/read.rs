//! Pictures read back, from this program and from others.

use std::path::{Path, PathBuf};

use image::ImageFormat;

use crate::input::{self, AnyFile};
use crate::picture_file::{Format, PictureFile, open_exr};
use crate::scene::settings::{MAX_PIXELS, MAX_SIDE};

/// A picture in memory, linear.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    pub width: u32,
    pub height: u32,
    /// Row by row from the top, `width * height` long.
    pub pixels: Vec<[f32; 3]>,
}

/// The pixels of a part of a picture that is so wide: first column and row, width and height.
pub fn cut<T: Copy>(pixels: &[T], width: u32, [column, row, columns, rows]: [u32; 4]) -> Vec<T> {
    let rows = pixels.chunks_exact(width.max(1) as usize).skip(row as usize).take(rows as usize);
    rows.flat_map(|pixels| &pixels[column as usize..(column + columns) as usize]).copied().collect()
}

/// The meaning of the numbers in a picture file.
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
        match Format::of(&mut open(path).ok()?, path).ok()?? {
            Format::OpenExr | Format::Radiance => Some(Self::Linear),
            Format::Coded(ImageFormat::Tiff | ImageFormat::Pnm) => None,
            Format::Coded(_) => Some(Self::Encoded),
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

/// A picture with what there is to know of its file.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadPicture {
    pub image: Image,
    /// Properties that the header states and nothing uses, in sentences without the file's name.
    pub notes: Vec<String>,
    /// The part that has pixels of the file, where the rest is black: first column and row, width and height.
    pub covered: [u32; 4],
}

impl ReadPicture {
    /// The notes with the file's name.
    pub fn warnings(&self, path: &Path) -> Vec<String> {
        self.notes.iter().map(|note| format!("{}: {note}", path.display())).collect()
    }
}

/// Reads an OpenEXR file, a Radiance picture, or any format the `image` crate knows (PNG, JPEG, …), by its content, in its display window.
///
/// # Errors
/// A file that is missing, broken, of an unknown format, too large, or without colour channels.
pub fn read_picture(path: &Path) -> Result<ReadPicture, ReadError> {
    read_or_say(path).map_err(|what| ReadError { path: path.to_owned(), what })
}

/// Reads as [`read_picture`] does; an OpenEXR file that states a digest must hold what was written.
///
/// # Errors
/// The errors of reading, and a file that was damaged or changed.
pub fn read_undamaged_picture(path: &Path) -> Result<ReadPicture, ReadError> {
    let check = || {
        let mut file = open(path)?;
        match Format::of(&mut file, path) {
            Ok(Some(Format::OpenExr)) => open_exr::check_digest(file).map(drop),
            // Other formats have none; what cannot be read, reading says.
            _ => Ok(()),
        }
    };
    check().map_err(|what| ReadError { path: path.to_owned(), what })?;
    read_picture(path)
}

/// The pixels of [`read_picture`].
///
/// # Errors
/// The errors of [`read_picture`].
pub fn read_image(path: &Path) -> Result<Image, ReadError> {
    read_picture(path).map(|picture| picture.image)
}

fn read_or_say(path: &Path) -> Result<ReadPicture, String> {
    let of_file = |what: String| format!("it {what}");
    let file = PictureFile::open(open(path)?, path, None).map_err(of_file)?;
    let size @ [width, height] = file.size();
    check_size(size)?;
    check_size(file.data_size())?;
    let (notes, covered, [red, green, blue, _]) = (file.notes().to_vec(), file.covered(), file.empty());
    let mut pixels = vec![[red, green, blue]; width as usize * height as usize];
    file.decode(&mut |[column, row], found| {
        let start = row * width as usize + column;
        let place = &mut pixels[start..start + found.len()];
        place.iter_mut().zip(found).for_each(|(pixel, [red, green, blue, _])| *pixel = [*red, *green, *blue]);
    })
    .map_err(of_file)?;
    Ok(ReadPicture { image: Image { width, height, pixels }, notes, covered })
}

fn open(path: &Path) -> Result<AnyFile, String> {
    input::open_to_decode(path).map_err(|error| error.to_string())
}

/// Refuses pictures that are larger than any is, before they are decoded.
pub(super) fn check_size([width, height]: [u32; 2]) -> Result<(), String> {
    if width > MAX_SIDE || height > MAX_SIDE || u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(format!(
            "{width}x{height} pixels are more than the {MAX_SIDE} on a side or {MAX_PIXELS} in all that are read"
        ));
    }
    if width == 0 || height == 0 {
        return Err(format!("it is empty: {width}x{height} pixels"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::srgb_to_linear;
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
