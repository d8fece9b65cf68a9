//! What is known of a picture before its first row.

use super::display::Display;
use super::provenance::{Entry, Provenance};
use super::rows::Completeness;
use crate::choice::choices;

/// How OpenEXR files hold the picture.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ExrOptions {
    /// Red, green and blue in half precision: 11 bits, up to 65504.
    pub half: bool,
    pub compression: ExrCompression,
}

choices! {
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
        /// As zip, with 24 of a float's 32 bits: the only one that loses something.
        Pxr24 = "pxr24",
    }
}

impl Default for ExrCompression {
    fn default() -> Self {
        Self::Piz
    }
}

/// What a file's encoder needs to know before the first row.
#[derive(Debug, Clone)]
pub struct PictureSpec {
    pub width: u32,
    pub height: u32,
    /// How previews show radiance. Files of floating-point numbers are not changed by it.
    pub display: Display,
    pub exr: ExrOptions,
    /// None of a picture whose origin is not known.
    pub provenance: Option<Provenance>,
}

impl PictureSpec {
    /// Samples that every pixel shall have; 0 where nothing is known of them.
    pub(super) fn samples_wanted(&self) -> u32 {
        self.provenance.as_ref().map_or(0, |provenance| provenance.settings.spp)
    }

    /// The entries of the header of a file in which every pixel received at least `samples`.
    pub(super) fn header_entries(&self, samples: u32, completeness: Completeness) -> Vec<(&'static str, Entry)> {
        self.provenance.as_ref().map_or_else(Vec::new, |provenance| provenance.entries(samples, completeness))
    }
}
