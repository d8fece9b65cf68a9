//! Calibrations of cameras: a file of OpenCV's, or COLMAP's list of cameras.

mod colmap;
mod opencv;
mod yaml;

use std::path::Path;

use super::error::{SceneError, show};
use super::files::Files;

/// Most bytes of a calibration.
const MOST_BYTES: u64 = 1 << 24;

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

/// Reads all cameras of a file. `lens` is what is known of the kind of their lenses from elsewhere.
///
/// # Errors
/// A file that is neither kind, and mistakes in it, with their lines.
pub fn read(files: &Files, path: &Path, lens: Option<Lens>) -> Result<Vec<Calibration>, SceneError> {
    let name = show(path);
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    let is_list = match ending.as_str() {
        "txt" => true,
        "yml" | "yaml" | "json" => false,
        _ => {
            let message = "a calibration ends in .yml, .yaml or .json, as OpenCV writes them, or in .txt, as COLMAP does";
            let help = match ending.as_str() {
                "xml" => "cv::FileStorage writes YAML or JSON where the file's name ends so",
                "bin" => "`colmap model_converter --output_type TXT` writes cameras.txt",
                _ => "",
            };
            let error = SceneError::in_file(name, message);
            return Err(if help.is_empty() { error } else { error.with_help(help) });
        }
    };
    let bytes = files.read(path, MOST_BYTES).map_err(|error| SceneError::in_file(&name, format!("cannot be read: {error}")))?;
    let text = std::str::from_utf8(&bytes).map_err(|_| SceneError::in_file(&name, "is no text in UTF-8"))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    if is_list { colmap::cameras(&name, text, lens) } else { Ok(vec![opencv::camera(&name, text, lens)?]) }
}

/// Checks what is the same for both kinds.
///
/// # Errors
/// A sentence about a number that cannot be.
fn check(camera: &Calibration) -> Result<(), String> {
    let finite = camera.focal.iter().chain(&camera.principal_point).chain(&camera.coefficients).all(|number| number.abs() <= 1e18);
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
