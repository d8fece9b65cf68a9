//! `[film]`: how large the picture is and how samples become pixels.

use std::fmt;

use super::value::BadSetting;
use crate::choice::{Choice, choices};

/// Width and height a picture may have, in pixels.
pub const MAX_SIDE: u32 = 32_768;
/// Pixels a picture may have.
pub const MAX_PIXELS: u64 = 1 << 28;
/// Half the width a filter may have, in pixels.
pub const SMALLEST_FILTER_RADIUS: f64 = 0.5;
pub const LARGEST_FILTER_RADIUS: f64 = 16.0;

/// The picture's size and reconstruction filter.
#[derive(Debug, Clone, PartialEq)]
pub struct FilmSettings {
    /// Width and height in pixels, both at least 1.
    pub size: [u32; 2],
    /// How samples become pixels.
    pub filter: Filter,
}

impl Default for FilmSettings {
    fn default() -> Self {
        Self { size: [512, 512], filter: Filter::default() }
    }
}

/// Reconstruction filter; samples are drawn from it, so every sample has weight 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Filter {
    /// Its curve.
    pub kind: FilterKind,
    /// Half the filter's width, in pixels.
    pub radius: f64,
}

impl Default for Filter {
    fn default() -> Self {
        Self { kind: FilterKind::Box, radius: 0.5 }
    }
}

/// The form for people: the scene file's name and the radius.
impl fmt::Display for Filter {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}, radius {}", self.kind.name(), self.radius)
    }
}

choices! {
    /// The shape of a reconstruction filter.
    pub enum FilterKind {
        /// The mean of a square.
        Box = "box",
        /// A pyramid.
        Tent = "tent",
        /// A bell, cut off at the radius and lowered to 0 there.
        Gaussian = "gaussian",
        /// A cosine window, close to 0 well before the radius.
        BlackmanHarris = "blackman_harris",
    }
}

impl FilterKind {
    /// Half the width, in pixels, of a filter of which only the shape is given.
    pub fn default_radius(self) -> f64 {
        match self {
            Self::Box => 0.5,
            Self::Tent => 1.0,
            Self::Gaussian => 1.5,
            Self::BlackmanHarris => 2.0,
        }
    }
}

impl FilmSettings {
    /// Checks that there can be such a picture.
    ///
    /// # Errors
    /// The first value out of its range.
    #[doc(hidden)]
    pub fn check(&self) -> Result<(), BadSetting> {
        let [width, height] = self.size;
        let bad = |message: String, help: String| Err(BadSetting { setting: "size", message, help: Some(help) });
        if width == 0 || height == 0 {
            return bad(format!("a picture of {width} x {height} pixels is empty"), "width and height are at least 1".to_owned());
        }
        if width.max(height) > MAX_SIDE || u64::from(width) * u64::from(height) > MAX_PIXELS {
            let help = format!("at most {MAX_SIDE} pixels on a side and {MAX_PIXELS} in all");
            return bad(format!("a picture of {width} x {height} pixels is too large"), help);
        }
        let radius = self.filter.radius;
        if !(SMALLEST_FILTER_RADIUS..=LARGEST_FILTER_RADIUS).contains(&radius) {
            let expected = format!("a radius from {SMALLEST_FILTER_RADIUS} to {LARGEST_FILTER_RADIUS} pixels");
            let message = format!("expected {expected}, found {radius}");
            return Err(BadSetting { setting: "filter", message, help: None });
        }
        Ok(())
    }
}
