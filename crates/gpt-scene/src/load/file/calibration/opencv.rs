//! A camera as OpenCV's samples and ROS write it: `camera_matrix`, `distortion_coefficients`, `image_width`, `image_height`.

use super::camera::{Calibration, Lens, check};
use super::yaml::{self, Node, Value};
use crate::load::error::SceneError;

/// Names under which files have the coefficients.
const COEFFICIENTS: [&str; 5] = ["distortion_coefficients", "dist_coeffs", "dist_coeff", "dist_coefs", "distortion"];
/// Names of the matrix.
const MATRIX: [&str; 3] = ["camera_matrix", "K", "mtx"];

/// A mistake: line and words.
type Mistake = (usize, String);

/// The camera of a file. A file of a fisheye says so by `distortion_model` or `fisheye_model`; where it does not, `lens` decides, and else it is none.
pub fn camera(name: &str, text: &str, lens: Option<Lens>) -> Result<Calibration, SceneError> {
    let root = yaml::read(name, text)?;
    of_file(&root, lens).map_err(|(line, message)| SceneError::in_line(name, line, message))
}

fn of_file(root: &Node, known: Option<Lens>) -> Result<Calibration, Mistake> {
    let Value::Map(_) = root.value else { return Err((root.line, "a calibration is a table of keys".to_owned())) };
    let matrix_node = MATRIX.iter().find_map(|name| root.get(name));
    let matrix_node = matrix_node.ok_or_else(|| (root.line, "the key `camera_matrix` is missing".to_owned()))?;
    let matrix = matrix(matrix_node)?;
    let numbers: [f64; 9] = matrix.clone().try_into().map_err(|_| {
        (matrix_node.line, format!("`camera_matrix` has 3 rows of 3 numbers, and these are {} numbers", matrix.len()))
    })?;
    let [fx, skew, cx, zero_1, fy, cy, zero_2, zero_3, one] = numbers;
    if skew != 0.0 {
        return Err((matrix_node.line, format!("the matrix has a skew of {skew}, and cameras here have none")));
    }
    if [zero_1, zero_2, zero_3] != [0.0; 3] || one != 1.0 {
        let message = "a camera's matrix is [fx, 0, cx], [0, fy, cy], [0, 0, 1]";
        return Err((matrix_node.line, message.to_owned()));
    }
    let (mut lens, said_at) = stated_lens(root)?;
    if let (Some(known), Some(stated)) = (known, lens)
        && known != stated
    {
        return Err((said_at, "the camera's model is another than `projection` says".to_owned()));
    }
    lens = lens.or(known);
    let lens = lens.unwrap_or_default();
    let coefficients = match COEFFICIENTS.iter().find_map(|name| root.get(name)) {
        Some(node) => coefficients(node, lens)?,
        None => [0.0; 8],
    };
    let side = |names: [&str; 2]| -> Result<Option<u32>, Mistake> {
        let Some(node) = names.iter().find_map(|name| root.get(name)) else { return Ok(None) };
        let number = number(node)?;
        if number.fract() != 0.0 || !(1.0..=1e9).contains(&number) {
            return Err((node.line, format!("`{}` is a whole number of at least 1, not {number}", names[0])));
        }
        Ok(Some(number as u32))
    };
    let image_size = match (side(["image_width", "width"])?, side(["image_height", "height"])?) {
        (Some(width), Some(height)) => Some([width, height]),
        (None, None) => None,
        _ => return Err((root.line, "`image_width` and `image_height` go together".to_owned())),
    };
    // Places count from the middle of the first pixel there, and from the picture's corner here.
    let principal_point = [cx + 0.5, cy + 0.5];
    let camera = Calibration { id: None, image_size, focal: [fx, fy], principal_point, lens, coefficients };
    check(&camera).map_err(|message| (matrix_node.line, message))?;
    Ok(camera)
}

/// The kind of lens that a file states, and the line.
fn stated_lens(root: &Node) -> Result<(Option<Lens>, usize), Mistake> {
    if let Some(node) = root.get("distortion_model") {
        let lens = match node.text().unwrap_or_default() {
            "plumb_bob" | "rational_polynomial" | "none" | "" => Lens::BrownConrady,
            "equidistant" | "fisheye" => Lens::KannalaBrandt,
            other => {
                let message = format!(
                    "the distortion model `{other}` cannot be said here; plumb_bob, rational_polynomial and equidistant can"
                );
                return Err((node.line, message));
            }
        };
        return Ok((Some(lens), node.line));
    }
    Ok(match root.get("fisheye_model") {
        Some(node) if number(node)? != 0.0 => (Some(Lens::KannalaBrandt), node.line),
        Some(node) => (Some(Lens::BrownConrady), node.line),
        None => (None, root.line),
    })
}

/// Coefficients in OpenCV's order, those that are left out as 0.
fn coefficients(node: &Node, lens: Lens) -> Result<[f64; 8], Mistake> {
    let numbers = matrix(node)?;
    let (most, right) = match lens {
        Lens::BrownConrady => (8, [0, 4, 5, 8, 12, 14].as_slice()),
        Lens::KannalaBrandt => (4, [0, 4].as_slice()),
    };
    if !right.contains(&numbers.len()) {
        let counts = right[1..].iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
        return Err((node.line, format!("there are {} coefficients, and such a camera has {counts}", numbers.len())));
    }
    if let Some(index) = (most..numbers.len()).find(|&index| numbers[index] != 0.0) {
        let what = if index < 12 { "thin prisms" } else { "a tilted sensor" };
        return Err((node.line, format!("coefficient {} is of {what}, which cameras here have not", index + 1)));
    }
    Ok(std::array::from_fn(|index| numbers.get(index).copied().unwrap_or(0.0)))
}

/// The numbers of a matrix, row by row: a list, a list of rows, or a table with the list `data`.
fn matrix(node: &Node) -> Result<Vec<f64>, Mistake> {
    let data = node.get("data").unwrap_or(node);
    let Value::List(entries) = &data.value else { return Err((data.line, "a matrix is a list of numbers".to_owned())) };
    let mut numbers = Vec::new();
    for entry in entries {
        match &entry.value {
            Value::List(row) => {
                for entry in row {
                    numbers.push(number(entry)?);
                }
            }
            _ => numbers.push(number(entry)?),
        }
    }
    Ok(numbers)
}

fn number(node: &Node) -> Result<f64, Mistake> {
    let text = node.text().unwrap_or_default();
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| (node.line, format!("expected a number, found `{text}`")))
}
