//! COLMAP's list of cameras, cameras.txt: lines of CAMERA_ID, MODEL, WIDTH, HEIGHT and the model's parameters.

use super::camera::{Calibration, Lens, check};
use crate::load::error::SceneError;
use crate::load::file::suggestion::did_you_mean;

/// A model of COLMAP's (src/colmap/sensor/models.h).
struct Model {
    name: &'static str,
    lens: Lens,
    /// One focal length, or two.
    focals: usize,
    /// The places, in OpenCV's order, of the coefficients that follow the principal point.
    coefficients: &'static [usize],
}

const MODELS: &[Model] = &[
    Model { name: "SIMPLE_PINHOLE", lens: Lens::BrownConrady, focals: 1, coefficients: &[] },
    Model { name: "PINHOLE", lens: Lens::BrownConrady, focals: 2, coefficients: &[] },
    Model { name: "SIMPLE_RADIAL", lens: Lens::BrownConrady, focals: 1, coefficients: &[0] },
    Model { name: "RADIAL", lens: Lens::BrownConrady, focals: 1, coefficients: &[0, 1] },
    Model { name: "OPENCV", lens: Lens::BrownConrady, focals: 2, coefficients: &[0, 1, 2, 3] },
    Model { name: "FULL_OPENCV", lens: Lens::BrownConrady, focals: 2, coefficients: &[0, 1, 2, 3, 4, 5, 6, 7] },
    Model { name: "SIMPLE_RADIAL_FISHEYE", lens: Lens::KannalaBrandt, focals: 1, coefficients: &[0] },
    Model { name: "RADIAL_FISHEYE", lens: Lens::KannalaBrandt, focals: 1, coefficients: &[0, 1] },
    Model { name: "OPENCV_FISHEYE", lens: Lens::KannalaBrandt, focals: 2, coefficients: &[0, 1, 2, 3] },
];

/// All cameras of a list.
pub fn cameras(name: &str, text: &str, lens: Option<Lens>) -> Result<Vec<Calibration>, SceneError> {
    let mut cameras: Vec<Calibration> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let camera = camera(line, lens).map_err(|(message, help)| {
            let error = SceneError::in_line(name, index + 1, message);
            help.map_or(error.clone(), |help| error.with_help(help))
        })?;
        if cameras.iter().any(|other| other.id == camera.id) {
            let message = format!("a second camera has the number {}", camera.id.unwrap_or_default());
            return Err(SceneError::in_line(name, index + 1, message));
        }
        cameras.push(camera);
    }
    if cameras.is_empty() {
        return Err(SceneError::in_file(name, "has no cameras: each has a line of number, model, width, height and parameters"));
    }
    Ok(cameras)
}

/// The camera of a line.
///
/// # Errors
/// A sentence about what is wrong with it, and perhaps one about what would be right.
fn camera(line: &str, lens: Option<Lens>) -> Result<Calibration, (String, Option<String>)> {
    let plain = |message: String| (message, None);
    let mut words = line.split_whitespace();
    let mut next = |what: &str| words.next().ok_or_else(|| plain(format!("the line ends before its {what}")));
    let id = next("number")?;
    let model_name = next("model")?;
    let (width, height) = (next("width")?, next("height")?);
    let whole =
        |what: &str, word: &str| word.parse::<u32>().map_err(|_| plain(format!("the {what} is a whole number, not `{word}`")));
    let id = whole("camera's number", id)?;
    let image_size = [whole("width", width)?, whole("height", height)?];
    let Some(model) = MODELS.iter().find(|model| model.name == model_name) else {
        let names: Vec<&str> = MODELS.iter().map(|model| model.name).collect();
        let help = did_you_mean(model_name, &names).unwrap_or_else(|| format!("valid models: {}", names.join(", ")));
        return Err((format!("the camera model `{model_name}` cannot be said here"), Some(help)));
    };
    if lens.is_some_and(|lens| lens != model.lens) {
        let right = if model.lens == Lens::BrownConrady { "brown_conrady" } else { "kannala_brandt" };
        return Err((format!("the camera model {model_name} is another than `projection` says"), Some(format!("it is {right}"))));
    }
    let mut numbers = Vec::new();
    for word in words {
        let number = word.parse::<f64>().ok().filter(|number| number.is_finite());
        numbers.push(number.ok_or_else(|| plain(format!("a parameter is a number, not `{word}`")))?);
    }
    let expected = model.focals + 2 + model.coefficients.len();
    if numbers.len() != expected {
        return Err(plain(format!("{model_name} has {expected} parameters, and these are {}", numbers.len())));
    }
    let mut coefficients = [0.0; 8];
    for (&place, &number) in model.coefficients.iter().zip(&numbers[model.focals + 2..]) {
        coefficients[place] = number;
    }
    let camera = Calibration {
        id: Some(id),
        image_size: Some(image_size),
        focal: [numbers[0], numbers[model.focals - 1]],
        principal_point: [numbers[model.focals], numbers[model.focals + 1]],
        lens: model.lens,
        coefficients,
    };
    check(&camera).map_err(plain)?;
    Ok(camera)
}
