//! Points that light is sampled from.

use glam::DVec3;

use crate::sampling::cell_grid::facing;

/// Where light is sampled from: a point on a surface, and which way the surface faces there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LitPoint {
    pub point: DVec3,
    /// As [`facing`] says.
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
