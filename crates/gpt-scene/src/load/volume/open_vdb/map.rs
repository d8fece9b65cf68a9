//! Transforms from a tree's index space to the file's space.

use glam::{DAffine3, DMat4, DVec3};

use crate::load::volume::bytes::Bytes;

/// Reads a map by its name and numbers. Maps of scales have more numbers than they need, such as their inverses.
///
/// # Errors
/// A sentence about a map that is not affine.
pub fn read(bytes: &mut Bytes<'_>) -> Result<DAffine3, String> {
    let name = bytes.text()?;
    match name.as_str() {
        "AffineMap" | "UnitaryMap" => {
            // Numbers are row by row, for vectors that are rows: the columns of the matrix for those that are columns.
            let matrix = DMat4::from_cols_array(&bytes.f64s()?);
            if matrix.row(3).to_array() != [0.0, 0.0, 0.0, 1.0] {
                return Err("its transform is not affine".to_owned());
            }
            Ok(DAffine3::from_mat4(matrix))
        }
        "TranslationMap" => Ok(DAffine3::from_translation(DVec3::from_array(bytes.f64s()?))),
        "ScaleMap" | "UniformScaleMap" => Ok(DAffine3::from_scale(scale(bytes)?)),
        "ScaleTranslateMap" | "UniformScaleTranslateMap" => {
            let translation = DVec3::from_array(bytes.f64s()?);
            Ok(DAffine3 { translation, ..DAffine3::from_scale(scale(bytes)?) })
        }
        "NonlinearFrustumMap" => {
            Err("its grid is in a camera's frustum; OpenVDB or the program that made it can resample it to a box".to_owned())
        }
        _ => Err(format!("its transform is of the unknown type `{name}`")),
    }
}

/// The factors of a scale, which four vectors that follow from them come after.
fn scale(bytes: &mut Bytes<'_>) -> Result<DVec3, String> {
    let [x, y, z, ..] = bytes.f64s::<15>()?;
    Ok(DVec3::new(x, y, z))
}
