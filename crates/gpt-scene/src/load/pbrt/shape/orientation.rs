//! The side that is a shape's front.

use crate::load::pbrt::world::ShapeRecord;

/// The front of a round shape is turned by `ReverseOrientation` there, and by transforms that mirror.
pub(super) fn is_flipped(record: &ShapeRecord) -> bool {
    record.reverses != (record.maps[0].matrix3.determinant() < 0.0)
}
