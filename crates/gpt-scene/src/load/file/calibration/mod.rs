//! Calibrations of cameras: a file of OpenCV's, or COLMAP's list of cameras.

mod camera;
mod colmap;
mod opencv;
mod yaml;

use std::path::Path;

use crate::load::error::{SceneError, show};
use crate::load::files::Files;

pub use camera::{Calibration, Lens};

/// Most bytes of a calibration.
const MOST_BYTES: u64 = 1 << 24;

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
