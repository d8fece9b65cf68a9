//! The properties of a picture that are known before its first row.

use super::display::Display;
use super::layers::LayerChannel;
use super::provenance::{CROP_KEY, Entry, Provenance};
use super::rows::Completeness;
use crate::choice::choices;
use crate::film::Layer;

/// How OpenEXR files hold the picture.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ExrOptions {
    /// Red, green and blue in half precision: 11 bits, up to 65504.
    pub half: bool,
    pub compression: ExrCompression,
    /// In tiles of 64 × 64 pixels; else in scan lines.
    pub tiled: bool,
    /// Each layer as a part of its own; else all in one.
    pub parts: bool,
}

choices! {
    /// How OpenEXR files lie otherwise than as one part of scan lines.
    pub enum ExrForm {
        /// In tiles of 64 × 64 pixels, from which programs read regions and large textures.
        Tiled = "tiled",
        /// Each layer as a part of its own, which programs read without the others: rgba, depth, and the rest by their channels' names.
        Parts = "parts",
    }


    /// How OpenEXR files are compressed.
    pub enum ExrCompression {
        /// Not at all.
        None = "none",
        /// Runs of equal bytes.
        Rle = "rle",
        /// Deflate, each row by itself.
        Zips = "zips",
        /// Deflate, 16 rows together.
        Zip = "zip",
        /// Wavelets: the smallest files of noisy pictures, without loss.
        Piz = "piz",
        /// The form of zip with 24 of a float's 32 bits, the only one that loses something.
        Pxr24 = "pxr24",
    }
}

#[allow(clippy::derivable_impls, reason = "the table above derives no default")]
impl Default for ExrCompression {
    fn default() -> Self {
        Self::Piz
    }
}

/// The place of a part's pixels in the whole picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PartSpec {
    /// Width and height of the whole picture.
    pub film: [u32; 2],
    /// Column and row of the part's first pixel.
    pub origin: [u32; 2],
}

/// The properties that a file's encoder needs before the first row.
#[derive(Debug, Clone, Default)]
pub struct PictureSpec {
    pub width: u32,
    pub height: u32,
    /// How previews show radiance. Files of floating-point numbers are not changed by it.
    pub display: Display,
    pub exr: ExrOptions,
    /// Channels beside red, green and blue, of EXR files.
    pub layers: Vec<LayerChannel>,
    /// The layers to which they belong, where their file's header shall name them.
    pub layer_names: Vec<Layer>,
    /// Entries of the header of EXR files, beside those of the provenance.
    pub notes: Vec<(String, String)>,
    /// None of a picture whose origin is not known.
    pub provenance: Option<Provenance>,
    /// The place of a part that `gpt merge` joins with others; float files then hold what that needs.
    pub part: Option<PartSpec>,
    /// The place of a picture that was made of a part and is none itself: an EXR file says where in the whole picture it lies.
    pub placed: Option<PartSpec>,
}

impl PictureSpec {
    /// Samples that every pixel shall have; 0 where nothing is known of them.
    pub(super) fn samples_wanted(&self) -> u32 {
        self.provenance.as_ref().map_or(0, |provenance| provenance.settings.spp)
    }

    /// The entries of the header of a file in which every pixel received at least `samples`.
    pub(super) fn header_entries(&self, samples: u32, completeness: Completeness) -> Vec<(&'static str, Entry)> {
        let entries = self.provenance.as_ref().map(|provenance| provenance.entries(samples, completeness));
        entries.unwrap_or_default().into_iter().chain(self.crop().map(|crop| (CROP_KEY, Entry::Text(crop)))).collect()
    }

    /// Which region of the whole picture it is, where it is not all of it.
    fn crop(&self) -> Option<String> {
        let PartSpec { film, origin: [x, y] } = self.part?;
        let size = [self.width, self.height];
        (film != size).then(|| format!("{x},{y},{},{}", self.width, self.height))
    }
}
