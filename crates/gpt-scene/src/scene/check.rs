//! The ranges of a scene's numbers and pictures.

use glam::DVec3;

use super::image::ImageData;
use crate::spectrum::Spectrum;

/// Most texels along a side of an image: twice as many still are a positive number of 32 bits.
const LONGEST_SIDE: u32 = 1 << 30;

/// Farthest from the origin that anything may stand or reach. Bounding volumes and distances are squared in single precision, which ends at
/// 3·10³⁸, and a scene is moved to its camera, which may stand on the other side.
pub const FARTHEST: f64 = 1e18;

/// The mistake, in words.
pub type Check = Result<(), String>;

/// Neither 0 nor infinite.
pub fn is_positive(number: f64) -> bool {
    number.is_finite() && number > 0.0
}

/// Checks that a shape that reaches this far from the origin can be rendered. A reach that is not a number
/// cannot.
pub fn within_range(reach: f64) -> Check {
    if reach <= FARTHEST {
        return Ok(());
    }
    Err(format!(
        "it reaches farther than {FARTHEST:e} units from the origin, beyond the range of numbers; choose a larger unit for the scene"
    ))
}

/// A quantity of light, or a share of it.
pub fn is_amount(color: Spectrum) -> bool {
    color.is_finite() && color.min_component() >= 0.0
}

/// True for a vector of length 1.
pub fn is_direction(direction: DVec3) -> bool {
    (direction.length_squared() - 1.0).abs() < 1e-6
}

/// Checks that the image has as many texels as it says.
pub fn image(image: &ImageData) -> Check {
    let ImageData { width, height, texels, .. } = image;
    let count = u64::from(*width) * u64::from(*height);
    if count == 0 || count != texels.len() as u64 || *width.max(height) > LONGEST_SIDE {
        return Err(format!("it has {} texels and not {width} × {height}", texels.len()));
    }
    Ok(())
}
