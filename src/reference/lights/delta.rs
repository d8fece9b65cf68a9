//! Lights to which one direction leads from each point.

use std::fmt::Debug;

use glam::DVec3;

use crate::spectrum::Spectrum;

/// Such a light.
pub trait DeltaLight: Debug + Send + Sync {
    /// Light that arrives at a point. None where none does.
    fn arriving(&self, point: DVec3) -> Option<Arriving>;

    /// None: it is at infinity.
    fn position(&self) -> Option<DVec3>;
}

/// Light that arrives at a point from a delta light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arriving {
    /// From the point to the light.
    pub wi: DVec3,
    /// Length of the segment that must be free.
    pub distance: f64,
    /// Irradiance on a surface that faces it.
    pub irradiance: Spectrum,
}

impl Arriving {
    /// From a position, where the light has this intensity along a direction; None at the position itself.
    pub fn from_position(position: DVec3, point: DVec3, intensity: impl Fn(DVec3) -> Spectrum) -> Option<Self> {
        let to_light = position - point;
        let squared = to_light.length_squared();
        let distance = squared.sqrt();
        let wi = to_light / distance;
        (squared > 0.0).then(|| Self { wi, distance, irradiance: intensity(-wi) / squared })
    }
}
