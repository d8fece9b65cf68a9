//! Steps of transforms.

use glam::{DAffine3, DMat3, DMat4, DVec3, DVec4};

use super::number::parse_number;
use super::plugin::error_at;
use crate::load::error::SceneError;
use crate::load::place::Origin;

type Attributes<'g> = dyn FnMut(&str) -> Result<Option<String>, SceneError> + 'g;

/// The map of one step.
pub fn step(place: &Origin, tag: &str, get: &mut Attributes) -> Result<DAffine3, SceneError> {
    match tag {
        "translate" => Ok(DAffine3::from_translation(vector(place, get, 0.0)?)),
        "scale" => {
            let factors = vector(place, get, 1.0)?;
            let missing = factors.to_array().contains(&0.0);
            if missing { Err(error_at(place, "a scale by 0 leaves nothing")) } else { Ok(DAffine3::from_scale(factors)) }
        }
        "rotate" => {
            let axis = vector(place, get, 0.0)?;
            let angle = get("angle")?.ok_or_else(|| error_at(place, "<rotate> needs the attribute `angle`"))?;
            let angle = parse_number(place, &angle)?;
            if axis.try_normalize().is_none() {
                return Err(error_at(place, "the axis of a rotation has no length"));
            }
            Ok(DAffine3::from_mat3(rotation(axis, angle.to_radians())))
        }
        "lookat" | "lookAt" => {
            let mut point =
                |name: &str| -> Result<Option<DVec3>, SceneError> { get(name)?.map(|text| triple(place, &text)).transpose() };
            let origin = point("origin")?.unwrap_or(DVec3::ZERO);
            let target = point("target")?.ok_or_else(|| error_at(place, "<lookat> needs the attribute `target`"))?;
            let up = point("up")?;
            look_at(origin, target, up).ok_or_else(|| {
                error_at(place, "`up` lies along the viewing direction, or `target` is `origin`, so which way is up is not known")
            })
        }
        "matrix" => {
            let text = get("value")?.ok_or_else(|| error_at(place, "<matrix> needs the attribute `value`"))?;
            let numbers = numbers(place, &text)?;
            matrix(&numbers)
                .ok_or_else(|| error_at(place, "a matrix has 9 or 16 numbers, row by row, and of 16 the last row is 0, 0, 0, 1"))
        }
        _ => Err(error_at(place, format!("<{tag}> is no step of a transform: translate, scale, rotate, lookat, matrix"))),
    }
}

/// Rodrigues' formula. Version 3 takes an axis as it is, where those before took one of length 1 along it: another length distorts.
fn rotation(axis: DVec3, angle: f64) -> DMat3 {
    let (sine, cosine) = angle.sin_cos();
    let across =
        DMat3::from_cols(DVec3::new(0.0, axis.z, -axis.y), DVec3::new(-axis.z, 0.0, axis.x), DVec3::new(axis.y, -axis.x, 0.0));
    let along = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
    DMat3::from_diagonal(DVec3::splat(cosine)) + across * sine + along * (1.0 - cosine)
}

/// `x`, `y` and `z`, or `value` with one number or three.
pub fn vector(place: &Origin, get: &mut Attributes, default: f64) -> Result<DVec3, SceneError> {
    if let Some(value) = get("value")? {
        let numbers = numbers(place, &value)?;
        return match numbers[..] {
            [one] => Ok(DVec3::splat(one)),
            [x, y] => Ok(DVec3::new(x, y, default)),
            [x, y, z] => Ok(DVec3::new(x, y, z)),
            _ => Err(error_at(place, format!("expected three numbers, found {}", numbers.len()))),
        };
    }
    let mut vector = DVec3::splat(default);
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        if let Some(text) = get(name)? {
            vector[axis] = parse_number(place, &text)?;
        }
    }
    Ok(vector)
}

fn triple(place: &Origin, text: &str) -> Result<DVec3, SceneError> {
    match numbers(place, text)?[..] {
        [x, y, z] => Ok(DVec3::new(x, y, z)),
        _ => Err(error_at(place, format!("expected three numbers, found `{text}`"))),
    }
}

/// Numbers separated by commas or blanks.
pub fn numbers(place: &Origin, text: &str) -> Result<Vec<f64>, SceneError> {
    let words = text.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty());
    words.map(|word| parse_number(place, word)).collect()
}

/// Mitsuba's cameras look along +Z with +X to the left.
pub fn look_at(origin: DVec3, target: DVec3, up: Option<DVec3>) -> Option<DAffine3> {
    let forward = (target - origin).try_normalize()?;
    let up = up.filter(|up| *up != DVec3::ZERO).unwrap_or_else(|| forward.any_orthogonal_vector());
    let left = up.cross(forward).try_normalize()?;
    let matrix3 = DMat3::from_cols(left, forward.cross(left), forward);
    Some(DAffine3 { matrix3, translation: origin })
}

fn matrix(numbers: &[f64]) -> Option<DAffine3> {
    match numbers.len() {
        9 => {
            let rows: [f64; 9] = numbers.try_into().ok()?;
            Some(DAffine3::from_mat3(DMat3::from_cols_array(&rows).transpose()))
        }
        16 => {
            let rows: [f64; 16] = numbers.try_into().ok()?;
            let matrix = DMat4::from_cols_array(&rows).transpose();
            (matrix.row(3) == DVec4::W).then(|| DAffine3::from_mat4(matrix))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A camera at the origin that looks along +Z, up +Y, has +X to its left: the identity.
    #[test]
    fn cameras_are_left_handed_about_their_axis() {
        let map = look_at(DVec3::ZERO, DVec3::Z, Some(DVec3::Y)).expect("a frame");
        assert!(map.abs_diff_eq(DAffine3::IDENTITY, 1e-15));
        // Looking along -Z, its left is -X.
        let back = look_at(DVec3::ONE, DVec3::new(1.0, 1.0, 0.0), Some(DVec3::Y)).expect("a frame");
        assert!(back.transform_vector3(DVec3::X).abs_diff_eq(DVec3::NEG_X, 1e-15) && back.translation == DVec3::ONE);
        assert!(look_at(DVec3::ZERO, DVec3::Y, Some(DVec3::Y)).is_none());
    }

    #[test]
    fn matrices_are_row_by_row() {
        let numbers: Vec<f64> = vec![1.0, 0.0, 0.0, 5.0, 0.0, 2.0, 0.0, 6.0, 0.0, 0.0, 3.0, 7.0, 0.0, 0.0, 0.0, 1.0];
        let map = matrix(&numbers).expect("a map");
        assert_eq!(map.transform_point3(DVec3::ONE), DVec3::new(6.0, 8.0, 10.0));
        let mut projective = numbers;
        projective[12] = 1.0;
        assert!(matrix(&projective).is_none() && matrix(&[1.0; 12]).is_none());
    }
}
