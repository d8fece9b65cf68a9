//! What numbers and pictures of a scene may be.

use glam::DVec3;

use super::image::ImageData;

/// Most texels along a side of an image: twice as many still are a positive number of 32 bits.
const LONGEST_SIDE: u32 = 1 << 30;

/// What is wrong, in words.
pub type Check = Result<(), String>;

/// Neither 0 nor infinite.
pub fn is_positive(number: f64) -> bool {
    number.is_finite() && number > 0.0
}

/// A quantity of light, or a share of it.
pub fn is_amount(color: DVec3) -> bool {
    color.is_finite() && color.min_element() >= 0.0
}

/// Of length 1.
pub fn is_direction(direction: DVec3) -> bool {
    (direction.length_squared() - 1.0).abs() < 1e-6
}

/// It has as many texels as it says.
pub fn image(image: &ImageData) -> Check {
    let ImageData { width, height, texels, .. } = image;
    let count = u64::from(*width) * u64::from(*height);
    if count == 0 || count != texels.len() as u64 || *width.max(height) > LONGEST_SIDE {
        return Err(format!("it has {} texels and not {width} × {height}", texels.len()));
    }
    Ok(())
}
