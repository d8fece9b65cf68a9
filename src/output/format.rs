//! The kinds of picture files.

use std::path::Path;

/// A format of picture files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureFormat {
    /// Linear float scan lines, lossless.
    Exr,
    /// 8-bit sRGB preview.
    Png,
    /// 8-bit sRGB preview, smaller and with losses.
    Jpeg,
    /// Linear, 8 bits a channel with a shared exponent.
    Hdr,
}

/// Endings by which files are written, with what they hold.
pub const PICTURE_ENDINGS: &str = ".exr (linear float), .hdr (linear, shared exponent), .png and .jpg (sRGB previews)";

impl PictureFormat {
    /// The format that the file name's ending asks for, ignoring case; None for any other ending.
    pub fn from_path(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?;
        [("exr", Self::Exr), ("png", Self::Png), ("jpg", Self::Jpeg), ("jpeg", Self::Jpeg), ("hdr", Self::Hdr)]
            .into_iter()
            .find_map(|(known, format)| ending.eq_ignore_ascii_case(known).then_some(format))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_names_the_format() {
        assert_eq!(PictureFormat::from_path(Path::new("a/b.exr")), Some(PictureFormat::Exr));
        assert_eq!(PictureFormat::from_path(Path::new("B.PNG")), Some(PictureFormat::Png));
        assert_eq!(PictureFormat::from_path(Path::new("b.Jpeg")), Some(PictureFormat::Jpeg));
        assert_eq!(PictureFormat::from_path(Path::new("b.jpg")), Some(PictureFormat::Jpeg));
        assert_eq!(PictureFormat::from_path(Path::new("b.hdr")), Some(PictureFormat::Hdr));
        assert_eq!(PictureFormat::from_path(Path::new("b.tif")), None);
        assert_eq!(PictureFormat::from_path(Path::new("exr")), None);
    }
}
