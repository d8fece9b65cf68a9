//! What is known of a picture before its first row.

use super::provenance::Provenance;

/// What a file's encoder needs to know before the first row.
#[derive(Debug, Clone)]
pub struct PictureSpec {
    pub width: u32,
    pub height: u32,
    /// Stops by which a preview is brightened: radiance is multiplied by 2^exposure. Float files are not changed.
    pub exposure: f32,
    pub provenance: Provenance,
}
