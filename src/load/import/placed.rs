//! Where things stand: transforms and cameras in the terms of scene files.

use glam::{DAffine3, DMat4, DVec3};

use super::keys::{Keys, Value, list};

/// `{ matrix = [16 numbers] }`; None for the identity.
pub fn matrix_value(map: &DAffine3) -> Option<Value> {
    if *map == DAffine3::IDENTITY {
        return None;
    }
    let rows = [0, 1, 2].map(|row| {
        let axes = map.matrix3;
        [axes.x_axis[row], axes.y_axis[row], axes.z_axis[row], map.translation[row]]
    });
    let numbers = rows.into_iter().flatten().chain([0.0, 0.0, 0.0, 1.0]);
    Some(Value::Table(Keys::new().with("matrix", list(numbers))))
}

/// The map of a transform that [`matrix_value`] made.
pub fn matrix_of(value: &Value) -> Option<DAffine3> {
    let Value::Table(keys) = value else { return None };
    let Some(Value::List(numbers)) = keys.get("matrix") else { return None };
    let numbers: Vec<f64> =
        numbers.iter().filter_map(|number| if let Value::Number(number) = number { Some(*number) } else { None }).collect();
    let numbers: [f64; 16] = numbers.try_into().ok()?;
    Some(DAffine3::from_mat4(DMat4::from_cols_array(&numbers).transpose()))
}

/// The map scales alike along all axes, so that what is round stays round.
pub fn is_uniform(map: &DAffine3) -> bool {
    let m = map.matrix3;
    let gram = m.transpose() * m;
    let squared = gram.x_axis.x;
    let uneven = gram - glam::DMat3::from_diagonal(DVec3::splat(squared));
    squared > 0.0 && uneven.to_cols_array().into_iter().all(|number| number.abs() <= 1e-9 * squared)
}

/// A direction in the world, of length 1; None where nothing is left of it.
pub fn world_direction(map: &DAffine3, direction: DVec3) -> Option<DVec3> {
    (map.matrix3 * direction).try_normalize()
}

/// `position`, `look_at` and `up` of a camera that looks along `forward`; up is left out where it is +Y.
pub fn camera_keys(position: DVec3, forward: DVec3, up: DVec3, distance: f64) -> Keys {
    let keys = Keys::new().with("position", position).with("look_at", position + forward * distance);
    if up == DVec3::Y { keys } else { keys.with("up", up) }
}
