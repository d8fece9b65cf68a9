//! The use of the texels of pictures.

/// The use of a picture's texels. Files of integers hold all of them in sRGB unless they are `raw`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Texels {
    Colours,
    /// Their luminance.
    Numbers,
    /// Their luminance, of which slopes are taken.
    Heights,
    /// Directions.
    Normals,
}
