//! Picture files: bands of pixels go in row by row, whole files come out, and other people's files are read back.
//!
//! Writers hold a few bands at a time, never the picture, so that memory does not grow with its size.

mod atomic;
mod exr_file;
mod picture;
mod png_file;
mod provenance;
mod read;
mod rows;

use std::io;
use std::path::{Path, PathBuf};

pub use atomic::{AtomicFile, check_target, remove_unfinished};
pub use picture::{PictureFile, PictureSpec};
pub use png_file::srgb_byte;
pub use provenance::Provenance;
pub use read::{Image, ReadError, read_image};

/// Width and height a picture may have, in pixels.
pub const MAX_SIDE: u32 = 32_768;
/// Pixels a picture may have.
pub const MAX_PIXELS: u64 = 1 << 28;

/// What a picture file can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureFormat {
    /// Linear float scan lines, lossless.
    Exr,
    /// 8-bit sRGB preview.
    Png,
}

impl PictureFormat {
    /// The format that the file name's ending asks for, ignoring case; None for any other ending.
    pub fn from_path(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?;
        [("exr", Self::Exr), ("png", Self::Png)]
            .into_iter()
            .find_map(|(known, format)| ending.eq_ignore_ascii_case(known).then_some(format))
    }
}

/// Why a picture could not be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("{}: the folder {} does not exist", path.display(), folder.display())]
    NoFolder { path: PathBuf, folder: PathBuf },
    #[error("{}: {what}", path.display())]
    BadTarget { path: PathBuf, what: &'static str },
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
    #[error("cannot write {}: {what}", path.display())]
    Encode { path: PathBuf, what: String },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_names_the_format() {
        assert_eq!(PictureFormat::from_path(Path::new("a/b.exr")), Some(PictureFormat::Exr));
        assert_eq!(PictureFormat::from_path(Path::new("B.PNG")), Some(PictureFormat::Png));
        assert_eq!(PictureFormat::from_path(Path::new("b.jpg")), None);
        assert_eq!(PictureFormat::from_path(Path::new("exr")), None);
    }
}
