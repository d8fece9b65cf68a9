//! The perfect mirror.

use glam::DVec3;

use super::{BsdfSample, Density, View};

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mirror {
    pub reflectance: DVec3,
}

impl Mirror {
    pub fn sample(&self, view: &View) -> Option<BsdfSample> {
        let wi = reflect(view);
        view.reflects(wi).then_some(BsdfSample { weight: self.reflectance, ..BsdfSample::reflected(wi, Density::Delta) })
    }
}

/// wo mirrored about the shading normal.
pub fn reflect(view: &View) -> DVec3 {
    let normal = view.normal();
    (normal * (2.0 * view.wo.dot(normal)) - view.wo).normalize()
}
