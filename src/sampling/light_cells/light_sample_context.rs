//! Reference points of light samples.

use glam::DVec3;

use crate::sampling::cell_grid::facing;

/// The reference point of light samples, and the way in which the surface faces there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightSampleContext {
    pub point: DVec3,
    /// The way in which the surface faces, by [`facing`].
    pub facing: u32,
}

impl LightSampleContext {
    /// `normal`: of the surface, on the side from where it is seen.
    pub fn new(point: DVec3, normal: DVec3) -> Self {
        Self { point, facing: facing(normal) }
    }
}

/// A point of which nothing else matters.
impl From<DVec3> for LightSampleContext {
    fn from(point: DVec3) -> Self {
        Self { point, facing: 0 }
    }
}
