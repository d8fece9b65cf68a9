//! The lens opening.

use crate::scene::check::{Check, is_positive};

/// Corners of a polygonal aperture.
pub const BLADES: std::ops::RangeInclusive<u32> = 3..=64;

/// The lens opening of a thin-lens camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aperture {
    pub shape: ApertureShape,
    /// Radius of the opening's circumscribed circle (disk, polygon) or half its side (square).
    pub radius: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ApertureShape {
    Disk,
    Square,
    Polygon { blades: u32, rotation_degrees: f64 },
}

impl Aperture {
    pub(super) fn check(&self) -> Check {
        if !is_positive(self.radius) {
            return Err("the aperture's radius and the distance in focus must be positive".into());
        }
        if let ApertureShape::Polygon { blades, rotation_degrees } = self.shape
            && !(BLADES.contains(&blades) && rotation_degrees.is_finite())
        {
            return Err(format!("an aperture has {} to {} blades, not {blades}", BLADES.start(), BLADES.end()));
        }
        Ok(())
    }
}
