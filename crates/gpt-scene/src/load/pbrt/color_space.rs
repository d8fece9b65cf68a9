//! The spaces of colours that are written as red, green and blue.

use glam::{DMat3, DVec3};

use crate::picture_file::primaries::Primaries;
use crate::spectrum::Spectrum;

/// A colour space by its name there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RgbSpace {
    #[default]
    Srgb,
    DciP3,
    Rec2020,
    Aces,
}

impl RgbSpace {
    pub const NAMES: [&'static str; 4] = ["srgb", "dci-p3", "rec2020", "aces2065-1"];

    /// The space of this name, in upper or lower case.
    pub fn named(name: &str) -> Option<Self> {
        match name.to_ascii_lowercase().as_str() {
            "srgb" => Some(Self::Srgb),
            "dci-p3" => Some(Self::DciP3),
            "rec2020" => Some(Self::Rec2020),
            "aces2065-1" => Some(Self::Aces),
            _ => None,
        }
    }

    /// A colour in linear Rec.709, in which the space's white is white.
    pub fn to_rec_709(self, [red, green, blue]: [f64; 3]) -> Spectrum {
        let name = match self {
            Self::Srgb => return Spectrum::new(red, green, blue),
            // Its white is D65 there.
            Self::DciP3 => "p3d65",
            Self::Rec2020 => "rec2020",
            Self::Aces => "ap0",
        };
        let matrix = Primaries::named(name).and_then(|primaries| primaries.to_rec_709(None)).flatten();
        Spectrum::from_rgb((matrix.unwrap_or(DMat3::IDENTITY) * DVec3::new(red, green, blue)).to_array())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_white_in_all_spaces() {
        for name in RgbSpace::NAMES {
            let space = RgbSpace::named(&name.to_uppercase()).expect("it has a name");
            assert!(space.to_rec_709([1.0; 3]).distance(Spectrum::WHITE) < 1e-3, "{name}");
        }
        // The control: another space's green lies outside of Rec.709.
        assert!(RgbSpace::Rec2020.to_rec_709([0.0, 1.0, 0.0]).r() < -0.5);
        assert_eq!(RgbSpace::named("adobe"), None);
    }
}
