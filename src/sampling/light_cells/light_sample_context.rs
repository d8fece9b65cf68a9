//! Reference points of light samples.

use glam::DVec3;

use crate::sampling::cell_grid::facing;
use crate::scene::{ReceiverId, SEES_ALL};

/// The reference point of light samples, and the way in which the surface faces there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightSampleContext {
    pub point: DVec3,
    /// The way in which the surface faces, by [`facing`].
    pub facing: u32,
    /// The receiver that the point belongs to, by which lamps light it or not.
    pub receiver: ReceiverId,
}

impl LightSampleContext {
    /// A point that every lamp lights. `normal`: of the surface, on the side from where it is seen.
    pub fn new(point: DVec3, normal: DVec3) -> Self {
        Self { point, facing: facing(normal), receiver: SEES_ALL }
    }

    /// The point as one of this receiver.
    #[must_use]
    pub fn of_receiver(self, receiver: ReceiverId) -> Self {
        Self { receiver, ..self }
    }
}

/// A point of which nothing else matters.
impl From<DVec3> for LightSampleContext {
    fn from(point: DVec3) -> Self {
        Self { point, facing: 0, receiver: SEES_ALL }
    }
}
