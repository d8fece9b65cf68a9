//! A surface and the direction it is seen from.

use glam::DVec3;

use crate::math::Frame;
use crate::scene::HemisphereSampling;

/// A surface as seen from wo, both normals on wo's side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    pub wo: DVec3,
    /// wo is on the surface's front side.
    pub front: bool,
    pub geometric_normal: DVec3,
    /// Around the shading normal.
    pub frame: Frame,
    /// How diffuse lobes are sampled.
    pub hemisphere: HemisphereSampling,
}

impl View {
    pub fn new(wo: DVec3, front_normal: DVec3, shading_normal: DVec3) -> Self {
        let front = wo.dot(front_normal) > 0.0;
        let geometric_normal = if front { front_normal } else { -front_normal };
        let mut normal = if shading_normal.dot(geometric_normal) < 0.0 { -shading_normal } else { shading_normal };
        if normal.dot(wo) <= 0.0 {
            // Near silhouettes an interpolated normal may turn away from the viewer; the true one does not.
            normal = geometric_normal;
        }
        Self { wo, front, geometric_normal, frame: Frame::around(normal), hemisphere: HemisphereSampling::Cosine }
    }

    pub fn with_hemisphere(self, hemisphere: HemisphereSampling) -> Self {
        Self { hemisphere, ..self }
    }

    pub fn normal(&self) -> DVec3 {
        self.frame.normal
    }

    /// Whether light from `wi` can be reflected to wo: on the same side, by the true and by the interpolated surface.
    pub(super) fn reflects(&self, wi: DVec3) -> bool {
        wi.dot(self.geometric_normal) > 0.0 && wi.dot(self.normal()) > 0.0
    }

    /// Whether light from `wi` can come through to wo: on the other side, by the true and by the interpolated surface.
    pub(super) fn transmits(&self, wi: DVec3) -> bool {
        wi.dot(self.geometric_normal) < 0.0 && wi.dot(self.normal()) < 0.0
    }

    /// wo mirrored about the shading normal.
    pub(super) fn mirrored(&self) -> DVec3 {
        let normal = self.normal();
        (normal * (2.0 * self.wo.dot(normal)) - self.wo).normalize()
    }
}
