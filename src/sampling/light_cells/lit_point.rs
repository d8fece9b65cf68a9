//! Points that light is sampled from.

use glam::DVec3;

use crate::sampling::cell_grid::facing;

/// A point of a surface that light is sampled from, and the way in which the surface faces there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LitPoint {
    pub point: DVec3,
    /// The way in which the surface faces, by [`facing`].
    pub facing: u32,
}

impl LitPoint {
    /// `normal`: of the surface, on the side from where it is seen.
    pub fn new(point: DVec3, normal: DVec3) -> Self {
        Self { point, facing: facing(normal) }
    }
}

/// A point of which nothing else matters.
impl From<DVec3> for LitPoint {
    fn from(point: DVec3) -> Self {
        Self { point, facing: 0 }
    }
}
