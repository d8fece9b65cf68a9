//! A surface and the direction it is seen from.

use glam::{DVec2, DVec3};

use super::phong_study::PhongStudy;
use crate::math::Frame;
use crate::reference::intersect::{NormalTexel, Tangents, UvSet};
use crate::scene::HemisphereSampling;
use crate::spectrum::Spectrum;

/// A shading normal on the side of the geometric one.
fn towards(wo: DVec3, geometric_normal: DVec3, shading_normal: DVec3) -> DVec3 {
    let normal = if shading_normal.dot(geometric_normal) < 0.0 { -shading_normal } else { shading_normal };
    // Near silhouettes an interpolated normal may turn away from the viewer; the true one does not.
    if normal.dot(wo) <= 0.0 { geometric_normal } else { normal }
}

/// A surface as seen from wo, both normals on wo's side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    pub wo: DVec3,
    /// wo is on the surface's front side.
    pub front: bool,
    pub geometric_normal: DVec3,
    /// The throughput of the path up to the surface.
    carried: Spectrum,
    /// Around the shading normal.
    pub frame: Frame,
    /// How diffuse lobes are sampled.
    pub hemisphere: HemisphereSampling,
    /// How the cosine-power lobes of `glossy` and `phong` are.
    pub phong: PhongStudy,
    /// The directions in which texture coordinates grow, where they do.
    pub tangents: Option<Tangents>,
    /// Tangents by the second texture coordinates, or by the only ones.
    second_tangents: Option<Tangents>,
    /// The shading normal before a map perturbed it, where it shadows the perturbed one.
    unperturbed_normal: Option<DVec3>,
    /// The unperturbed normal on the front side, where coats lie about it.
    coat_normal: Option<DVec3>,
}

impl View {
    pub fn new(wo: DVec3, front_normal: DVec3, shading_normal: DVec3) -> Self {
        let front = wo.dot(front_normal) > 0.0;
        let geometric_normal = if front { front_normal } else { -front_normal };
        let normal = towards(wo, geometric_normal, shading_normal);
        let (hemisphere, frame) = (HemisphereSampling::Cosine, Frame::around(normal));
        Self {
            wo,
            front,
            geometric_normal,
            carried: Spectrum::WHITE,
            frame,
            hemisphere,
            phong: PhongStudy::default(),
            tangents: None,
            second_tangents: None,
            unperturbed_normal: None,
            coat_normal: None,
        }
    }

    pub fn with_carried(self, carried: Spectrum) -> Self {
        Self { carried, ..self }
    }

    /// Each channel's share of what the path carries.
    pub(super) fn carried_shares(&self) -> Spectrum {
        let sum = self.carried.sum();
        if sum > 0.0 { self.carried / sum } else { Spectrum::grey(1.0 / 3.0) }
    }

    pub fn with_unperturbed_normal(self, unperturbed_normal: Option<DVec3>) -> Self {
        Self { unperturbed_normal: unperturbed_normal.map(|normal| towards(self.wo, self.geometric_normal, normal)), ..self }
    }

    pub fn with_coat_normal(self, coat_normal: Option<DVec3>) -> Self {
        Self { coat_normal, ..self }
    }

    /// The frame of a coat whose own normal map has this texel, if it has a map.
    pub(super) fn coat_frame(&self, texel: Option<NormalTexel>) -> Frame {
        let Some(normal) = self.coat_normal else { return self.frame };
        let perturbed = texel.and_then(|NormalTexel { texel, scale, set }| {
            let tangents = if set == UvSet::Second { self.second_tangents } else { self.tangents };
            tangents?.direction(normal, texel, scale)
        });
        Frame::around(towards(self.wo, self.geometric_normal, perturbed.unwrap_or(normal)))
    }

    /// The view by a perturbed normal of a map with mirroring: a normal that is perturbed away from wo is mirrored
    /// about the unperturbed normal, which is known, instead of being replaced by the geometric one.
    pub fn with_mirrored_normal(self, perturbed: DVec3) -> Self {
        let Some(unperturbed) = self.unperturbed_normal else { return self };
        let normal = if perturbed.dot(self.geometric_normal) < 0.0 { -perturbed } else { perturbed };
        let mirrored = 2.0 * normal.dot(unperturbed) * unperturbed - normal;
        if normal.dot(self.wo) > 0.0 || mirrored.dot(self.wo) <= 0.0 || mirrored.dot(self.geometric_normal) <= 0.0 {
            return self;
        }
        Self { frame: Frame::around(mirrored), ..self }
    }

    /// Share of light between wo and `wi` that is left where a map perturbed the normal (Estevez, Lecocq and Stein
    /// 2019): 1 where none did.
    pub fn shadowing(&self, wi: DVec3) -> f64 {
        let Some(unperturbed) = self.unperturbed_normal else { return 1.0 };
        let squared_tangent = |direction: DVec3| {
            let squared_cosine = unperturbed.dot(direction).powi(2).clamp(1e-12, 1.0);
            (1.0 - squared_cosine) / squared_cosine
        };
        let alpha2 = (0.125 * squared_tangent(self.normal())).min(1.0);
        2.0 / (1.0 + (1.0 + alpha2 * squared_tangent(wi)).sqrt())
    }

    pub fn with_hemisphere(self, hemisphere: HemisphereSampling) -> Self {
        Self { hemisphere, ..self }
    }

    pub fn with_phong(self, phong: PhongStudy) -> Self {
        Self { phong, ..self }
    }

    pub fn with_tangents(self, tangents: Option<Tangents>) -> Self {
        Self { tangents, ..self }
    }

    pub fn with_second_tangents(self, second_tangents: Option<Tangents>) -> Self {
        Self { second_tangents, ..self }
    }

    /// The frame that microfacets lie in: x along the tangent where that matters and there is one.
    pub(super) fn facet_frame(&self, anisotropic: bool) -> Frame {
        match self.tangents {
            Some(tangents) if anisotropic => Frame::along(self.normal(), tangents.along_u),
            _ => self.frame,
        }
    }

    /// The frame of facets, turned about the normal: its x is `direction`, along the tangent and across it towards the side where v grows.
    pub(super) fn turned_facet_frame(&self, anisotropic: bool, direction: DVec2) -> Frame {
        let frame = self.facet_frame(anisotropic);
        if !anisotropic {
            return frame;
        }
        let side = if self.tangents.is_some_and(|tangents| frame.bitangent.dot(tangents.along_v) < 0.0) { -1.0 } else { 1.0 };
        Frame::along(frame.normal, frame.tangent * direction.x + frame.bitangent * (side * direction.y))
    }

    pub fn normal(&self) -> DVec3 {
        self.frame.normal
    }

    /// Says that light from `wi` can be reflected to wo: on the same side, by the true and by the interpolated surface.
    pub fn reflects(&self, wi: DVec3) -> bool {
        wi.dot(self.geometric_normal) > 0.0 && wi.dot(self.normal()) > 0.0
    }

    /// Says that light from `wi` can come through to wo: on the other side, by the true and by the interpolated surface.
    pub fn transmits(&self, wi: DVec3) -> bool {
        wi.dot(self.geometric_normal) < 0.0 && wi.dot(self.normal()) < 0.0
    }

    /// wo mirrored about the shading normal.
    pub(super) fn mirrored(&self) -> DVec3 {
        self.mirrored_about(self.normal())
    }

    /// wo mirrored about another normal.
    pub(super) fn mirrored_about(&self, normal: DVec3) -> DVec3 {
        (normal * (2.0 * self.wo.dot(normal)) - self.wo).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: seen from 80 degrees to the left, a normal that leans 30 degrees to the right looks away; its mirror leans to the left.
    #[test]
    fn normals_that_look_away_are_mirrored() {
        let leaning = |degrees: f64| DVec3::new(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos());
        let view = |wo: DVec3, perturbed: DVec3| View::new(wo, DVec3::Z, perturbed).with_unperturbed_normal(Some(DVec3::Z));
        let away = view(leaning(-80.0), leaning(30.0));
        assert_eq!(away.normal(), DVec3::Z);
        assert!((away.with_mirrored_normal(leaning(30.0)).normal() - leaning(-30.0)).length() < 1e-15);
        // A normal that looks at the viewer stays as it is.
        let towards = view(leaning(-50.0), leaning(30.0));
        assert_eq!(towards.with_mirrored_normal(leaning(30.0)), towards);
    }

    /// By hand: a normal perturbed by 45 degrees has the width ⅛ of its squared tangent.
    #[test]
    fn perturbed_normals_are_shadowed_by_the_surface() {
        let diagonal = DVec3::new(1.0, 0.0, 1.0).normalize();
        let view = View::new(DVec3::Z, DVec3::Z, diagonal).with_unperturbed_normal(Some(DVec3::Z));
        let at = |squared_tangent: f64| 2.0 / (1.0 + (1.0 + 0.125 * squared_tangent).sqrt());
        let wi = DVec3::new(0.0, 2.0, 1.0).normalize();
        assert!((view.shadowing(wi) - at(4.0)).abs() < 1e-12 && (view.shadowing(DVec3::Z) - 1.0).abs() < 1e-12);
        assert!((view.shadowing(wi) - at(3.0)).abs() > 1e-3);
        // Nothing where nothing is perturbed, or where the surface throws no shadow.
        assert_eq!(View::new(DVec3::Z, DVec3::Z, DVec3::Z).with_unperturbed_normal(Some(DVec3::Z)).shadowing(wi), 1.0);
        assert_eq!(View::new(DVec3::Z, DVec3::Z, diagonal).shadowing(wi), 1.0);
    }
}
