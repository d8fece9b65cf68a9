//! A surface and the direction it is seen from.

use glam::DVec3;

use crate::math::Frame;
use crate::reference::intersect::Tangents;
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
    /// The directions in which texture coordinates grow, where they do.
    pub tangents: Option<Tangents>,
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
        Self { wo, front, geometric_normal, frame: Frame::around(normal), hemisphere: HemisphereSampling::Cosine, tangents: None }
    }

    pub fn with_hemisphere(self, hemisphere: HemisphereSampling) -> Self {
        Self { hemisphere, ..self }
    }

    pub fn with_tangents(self, tangents: Option<Tangents>) -> Self {
        Self { tangents, ..self }
    }

    /// The frame that microfacets lie in: x along the tangent where that matters and there is one.
    pub(super) fn facet_frame(&self, anisotropic: bool) -> Frame {
        match self.tangents {
            Some(tangents) if anisotropic => Frame::along(self.normal(), tangents.along_u),
            _ => self.frame,
        }
    }

    /// The same, turned about the normal by an angle in radians, from the tangent towards the side where v grows.
    pub(super) fn turned_facet_frame(&self, anisotropic: bool, angle: f64) -> Frame {
        let frame = self.facet_frame(anisotropic);
        if !anisotropic {
            return frame;
        }
        let side = if self.tangents.is_some_and(|tangents| frame.bitangent.dot(tangents.along_v) < 0.0) { -1.0 } else { 1.0 };
        Frame::along(frame.normal, frame.tangent * angle.cos() + frame.bitangent * (side * angle.sin()))
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
