//! Picture files of whatever origin: their pixels in the display window, as linear Rec. 709, and notes on what their headers say that is not used.
//!
//! Everything that reads a picture reads it here: textures and environments, `gpt compare`, `test`, `denoise`, `bench`, `--resume`, the library and
//! Python. Parts of a picture, which `gpt merge` joins, take the window from here and their channels as they stand in the file.
//!
//! - [`open_exr`]: windows, layers, parts, subsampled channels and attributes of OpenEXR.
//! - [`radiance`]: headers and orientations of Radiance's pictures.
//! - [`coded`]: formats of integers, and what they say of their colours.
//! - `primaries`: colours of other primaries; `pixels`: what all formats hand over.

pub mod coded;
pub mod open_exr;
mod pixels;
pub mod primaries;
pub mod radiance;

use std::io::Read;
use std::path::Path;

use image::ImageFormat;

use crate::input::AnyFile;
use crate::scene::ColorSpace;

use coded::CodedFile;
use open_exr::ExrFile;
use pixels::Sink;
pub use pixels::{Envelope, Hints};
use radiance::RadianceFile;

/// First bytes of every OpenEXR file, and of every Radiance picture.
const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
const RADIANCE_MAGIC: [u8; 2] = *b"#?";

/// How the bytes of a file are a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    OpenExr,
    Radiance,
    Coded(ImageFormat),
}

impl Format {
    /// By the first bytes of the file; of those that have no signature, by the ending of its name. None: it is no picture that is read here.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn of(file: &mut AnyFile, path: &Path) -> std::io::Result<Option<Self>> {
        let mut start = Vec::new();
        file.take(64).read_to_end(&mut start)?;
        file.rewind()?;
        let ending = || path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        Ok(if start.starts_with(&EXR_MAGIC) {
            Some(Self::OpenExr)
        } else if start.starts_with(&RADIANCE_MAGIC) {
            Some(Self::Radiance)
        } else {
            match image::guess_format(&start).ok().or_else(|| ImageFormat::from_extension(ending())) {
                Some(ImageFormat::OpenExr) => Some(Self::OpenExr),
                Some(ImageFormat::Hdr) => Some(Self::Radiance),
                Some(format) if format.reading_enabled() => Some(Self::Coded(format)),
                _ if ["pic", "rgbe", "xyze", "rad"].contains(&ending().as_str()) => Some(Self::Radiance),
                _ => None,
            }
        })
    }
}

/// A picture whose header was read.
pub enum PictureFile {
    OpenExr(Box<ExrFile>),
    Radiance(RadianceFile),
    Coded(CodedFile),
}

impl PictureFile {
    /// Reads the header. `color_space` stands for what the file says itself; where it is [`ColorSpace::Linear`], numbers are taken as they are,
    /// whatever primaries they have. The error says what is wrong with the file, without its name.
    pub fn open(mut file: AnyFile, path: &Path, color_space: Option<ColorSpace>) -> Result<Self, String> {
        let format = Format::of(&mut file, path).map_err(|error| format!("cannot be read: {error}"))?;
        Ok(match format {
            Some(Format::OpenExr) => Self::OpenExr(Box::new(ExrFile::open(file, color_space)?)),
            Some(Format::Radiance) => Self::Radiance(RadianceFile::open(file, color_space)?),
            Some(Format::Coded(format)) => Self::Coded(CodedFile::open(file, format, color_space)?),
            None => {
                return Err(
                    "is not an image in a format known here (PNG, JPEG, EXR, HDR, TIFF, BMP, TGA, WebP, GIF, PNM)".to_owned()
                );
            }
        })
    }

    /// Width and height of the display window.
    pub fn size(&self) -> [u32; 2] {
        match self {
            Self::OpenExr(file) => file.windows().size(),
            Self::Radiance(file) => file.size(),
            Self::Coded(file) => file.size(),
        }
    }

    /// Width and height of the pixels that the file has, shown or not.
    pub fn data_size(&self) -> [u32; 2] {
        match self {
            Self::OpenExr(file) => file.windows().data_size(),
            _ => self.size(),
        }
    }

    /// Properties that its header states and that matter for some uses alone.
    pub fn hints(&self) -> Hints {
        match self {
            Self::OpenExr(file) => file.hints().clone(),
            Self::Radiance(file) => Hints { has_view: file.has_view(), ..Hints::default() },
            Self::Coded(_) => Hints::default(),
        }
    }

    /// Properties that its header states and nothing uses, in sentences without the file's name.
    pub fn notes(&self) -> &[String] {
        match self {
            Self::OpenExr(file) => file.notes(),
            Self::Radiance(file) => file.notes(),
            Self::Coded(file) => file.notes(),
        }
    }

    /// Whoever ignores its header but for the size sees the same picture.
    pub fn is_plain(&self) -> bool {
        match self {
            Self::OpenExr(file) => file.is_plain(),
            Self::Radiance(file) => file.is_plain(),
            Self::Coded(file) => file.is_plain(),
        }
    }

    /// Its colours become those of Rec. 709 by arithmetic, which can make them negative.
    pub fn converts(&self) -> bool {
        match self {
            Self::OpenExr(file) => file.converts(),
            Self::Radiance(file) => file.converts(),
            Self::Coded(_) => false,
        }
    }

    /// Which part of the display window has pixels of the file: first column and row, width and height.
    pub fn covered(&self) -> [u32; 4] {
        match self {
            Self::OpenExr(file) => file.windows().covered(),
            _ => {
                let [width, height] = self.size();
                [0, 0, width, height]
            }
        }
    }

    /// The pixel that stands where the file has none.
    pub fn empty(&self) -> [f32; 4] {
        match self {
            Self::OpenExr(file) => file.empty(),
            _ => [0.0, 0.0, 0.0, 1.0],
        }
    }

    /// Decodes it, row by row and in any order. The error is a sentence without a subject.
    pub fn decode(self, sink: Sink<'_>) -> Result<(), String> {
        match self {
            Self::OpenExr(file) => file.decode(sink),
            Self::Radiance(file) => file.decode(sink),
            Self::Coded(file) => file.decode(sink),
        }
    }
}
