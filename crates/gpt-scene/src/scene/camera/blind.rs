//! Places of a picture that see nothing.

use glam::DVec2;

use super::model::{CameraModel, ViewPlace};
use crate::scene::check::Check;

/// Places along each side of a view at which it is looked whether anything is seen.
const PLACES: u32 = 64;

/// Evenly spread places of a view.
fn places(size: DVec2) -> impl Iterator<Item = ViewPlace> {
    let at = move |index: u32| {
        let steps = DVec2::new(f64::from(index % PLACES), f64::from(index / PLACES));
        ViewPlace { tile: 0, at: (steps + 0.5) / f64::from(PLACES) * size, size }
    };
    (0..PLACES * PLACES).map(at)
}

/// The share of a view's places that see nothing.
pub fn blind_share(model: &dyn CameraModel, size: DVec2) -> f64 {
    let blind = places(size).filter(|place| model.direction(place).is_none()).count();
    blind as f64 / f64::from(PLACES * PLACES)
}

/// Checks that some place of a view sees something; `axis` is the place of the axis, perhaps outside.
pub fn sees_something(model: &dyn CameraModel, size: DVec2, axis: DVec2) -> Check {
    let nearest = ViewPlace { tile: 0, at: axis.clamp(DVec2::splat(0.5), (size - 0.5).max(DVec2::splat(0.5))), size };
    if std::iter::once(nearest).chain(places(size)).any(|place| model.direction(&place).is_some()) {
        return Ok(());
    }
    Err("no place of its picture sees anything: all lie beyond where its lens shows the farthest from the axis".into())
}
