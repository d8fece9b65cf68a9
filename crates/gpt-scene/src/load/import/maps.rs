//! Positions and directions in the world.

use glam::{DAffine3, DMat3, DVec3};

use crate::load::file::syntax::CameraTable;
use crate::load::file::value::Exactly;
use crate::load::place::Place;

/// The map scales alike along all axes, so that what is round stays round.
pub fn is_uniform(map: &DAffine3) -> bool {
    let m = map.matrix3;
    let gram = m.transpose() * m;
    let squared = gram.x_axis.x;
    let uneven = gram - DMat3::from_diagonal(DVec3::splat(squared));
    squared > 0.0 && uneven.to_cols_array().into_iter().all(|number| number.abs() <= 1e-9 * squared)
}

/// A direction in the world, of length 1; None where nothing is left of it.
pub fn world_direction(map: &DAffine3, direction: DVec3) -> Option<DVec3> {
    (map.matrix3 * direction).try_normalize()
}

/// A camera that looks from one point at another, without a projection.
///
/// # Errors
/// A sentence about a number that is out of range.
pub fn camera_at(position: DVec3, look_at: DVec3, up: DVec3, place: &Place) -> Result<CameraTable, String> {
    Ok(CameraTable {
        position: Exactly::of(position.to_array())?,
        look_at: place.at(Exactly::of(look_at.to_array())?),
        up: if up == DVec3::Y { None } else { Some(place.at(Exactly::of(up.to_array())?)) },
        vfov: None,
        projection: None,
        height: None,
        azimuth: None,
        elevation: None,
        fov: None,
        mapping: None,
        fit: None,
        layout: None,
        focal: None,
        principal_point: None,
        image_size: None,
        radial: None,
        tangential: None,
        calibration: None,
        calibration_id: None,
        stereo: None,
        shift: None,
        stretch: None,
        aperture: None,
        focus_distance: None,
        shutter: None,
        rolling_shutter: None,
        keyframes: None,
        interpolation: None,
        node: None,
        medium: None,
    })
}
