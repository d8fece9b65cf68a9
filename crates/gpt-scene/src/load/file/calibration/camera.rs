//! A calibrated camera.

/// The kind of a lens.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Lens {
    #[default]
    BrownConrady,
    KannalaBrandt,
}

/// A camera of a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Calibration {
    /// Its number, in a file of several.
    pub id: Option<u32>,
    /// Width and height of the pictures that it was calibrated by.
    pub image_size: Option<[u32; 2]>,
    pub focal: [f64; 2],
    /// In pixels from the upper left corner of the picture.
    pub principal_point: [f64; 2],
    pub lens: Lens,
    /// In OpenCV's order: k1, k2, p1, p2, k3, k4, k5, k6; of a fisheye k1 to k4 in the first places.
    pub coefficients: [f64; 8],
}

/// Checks what is the same for both kinds.
///
/// # Errors
/// A sentence about a number that cannot be.
pub fn check(camera: &Calibration) -> Result<(), String> {
    let finite =
        camera.focal.iter().chain(&camera.principal_point).chain(&camera.coefficients).all(|number| number.abs() <= 1e18);
    if !finite {
        return Err("a number is too large, or none".to_owned());
    }
    if let Some(focal) = camera.focal.into_iter().find(|focal| *focal <= 0.0) {
        return Err(format!("a focal length is above 0, and this is {focal}"));
    }
    match camera.image_size {
        Some([width, height]) if width == 0 || height == 0 => Err(format!("a picture of {width} × {height} pixels has none")),
        _ => Ok(()),
    }
}
