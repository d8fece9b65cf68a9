//! Limits of a scene that are asked for while it is read and while it is converted.

use super::plugin::error_at;
use crate::load::error::SceneError;
pub use crate::load::import::MOST_SHAPES;
use crate::load::place::Origin;

/// The error where there are more.
pub fn too_many_shapes(place: &Origin) -> SceneError {
    error_at(place, format!("the scene has more than {MOST_SHAPES} shapes, instances counted"))
}
