//! What is known of a picture before its first row.

use super::provenance::{Entry, Provenance};
use super::rows::Completeness;

/// What a file's encoder needs to know before the first row.
#[derive(Debug, Clone)]
pub struct PictureSpec {
    pub width: u32,
    pub height: u32,
    /// Stops by which a preview is brightened: radiance is multiplied by 2^exposure. Float files are not changed.
    pub exposure: f32,
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
