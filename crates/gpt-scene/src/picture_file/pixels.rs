//! The result of all formats: pixels, and properties of headers that matter for some uses alone.

use crate::scene::ColorSpace;

/// How the light of all directions lies in a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Envelope {
    /// Latitude and longitude, the first and the last row on the poles, the first and the last column in the same place.
    LatLong,
    /// Six faces, one below the other.
    Cube,
}

/// Properties that a header states and that matter for some uses of the picture alone.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Hints {
    /// How the light of all directions lies in it.
    pub envelope: Option<Envelope>,
    /// How a texture goes on beyond its edges: `black`, `clamp`, `periodic` or `mirror`, of both axes or one after the other.
    pub wrap_modes: Option<String>,
    /// True if the header states a view, as renders of Radiance do.
    pub has_view: bool,
}

/// Takes pixels side by side, from a column and a row of the display window on: red, green, blue and alpha, linear unless said otherwise.
pub type Sink<'s> = &'s mut dyn FnMut([usize; 2], &[[f32; 4]]);

/// A value as a colour space has it, linear.
pub fn linear(value: f32, space: ColorSpace) -> f32 {
    match space {
        ColorSpace::Srgb => crate::math::srgb_to_linear(value),
        ColorSpace::Linear => value,
    }
}
