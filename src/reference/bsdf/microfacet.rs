//! The GGX distribution of microfacets (Walter et al. 2007) with Smith's shadowing (Heitz 2014), isotropic.
//!
//! All directions are in the surface's frame, z along the shading normal. m is a microfacet's normal, on the side of the upper
//! hemisphere; wo is in the upper hemisphere, wi anywhere.
//!
//! Light that one microfacet sends to another is lost: the share of a uniform light that microfacets without any absorption
//! reflect, by the angle of view from the normal (measured, and held by a test; 0.307 is 1 − ln 2 in closed form), is
//!
//! | alpha | 0°    | 45°   | 70°   | 85°   |
//! | ----- | ----- | ----- | ----- | ----- |
//! | 0.05  | 0.997 | 0.996 | 0.985 | 0.902 |
//! | 0.25  | 0.916 | 0.886 | 0.839 | 0.901 |
//! | 0.5   | 0.688 | 0.683 | 0.731 | 0.872 |
//! | 0.75  | 0.464 | 0.510 | 0.628 | 0.827 |
//! | 1     | 0.307 | 0.377 | 0.532 | 0.780 |

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

/// Microfacets of width `alpha`, at least [`crate::scene::material::DELTA_ALPHA`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ggx {
    pub alpha: f64,
}

impl Ggx {
    /// Area of microfacets with normal m, per area of the surface and per steradian: D(m). ∫ D(m) cosθm dωm = 1.
    pub fn distribution(&self, m: DVec3) -> f64 {
        // α²/(π(cos²θ(α² − 1) + 1)²), written over the components, which keep their digits where cosθ is nearly 1.
        let alpha_squared = self.alpha * self.alpha;
        let stretched = (m.x * m.x + m.y * m.y) / alpha_squared + m.z * m.z;
        1.0 / (PI * alpha_squared * stretched * stretched)
    }

    /// Smith's Λ(w): invisible over visible microfacet area seen from w.
    fn lambda(&self, w: DVec3) -> f64 {
        let tan_squared = (w.x * w.x + w.y * w.y) / (w.z * w.z);
        0.5 * ((1.0 + self.alpha * self.alpha * tan_squared).sqrt() - 1.0)
    }

    /// Share of the microfacets that can be seen from w: G1(w).
    pub fn masking(&self, w: DVec3) -> f64 {
        1.0 / (1.0 + self.lambda(w))
    }

    /// Share that can be seen both from wo and from wi, heights correlated: G2(wo, wi). The same where wi is below the surface.
    pub fn shadowing_masking(&self, wo: DVec3, wi: DVec3) -> f64 {
        1.0 / (1.0 + self.lambda(wo) + self.lambda(wi))
    }

    /// Draws a microfacet normal from those visible from wo (Heitz 2018, "Sampling the GGX Distribution of Visible Normals"):
    /// stretched to a hemisphere, the visible ones are a half disk and a half ellipse seen from wo.
    pub fn sample_visible(&self, wo: DVec3, u1: f64, u2: f64) -> DVec3 {
        let view = DVec3::new(self.alpha * wo.x, self.alpha * wo.y, wo.z).normalize();
        let across_squared = view.x * view.x + view.y * view.y;
        let first = if across_squared > 0.0 { DVec3::new(-view.y, view.x, 0.0) / across_squared.sqrt() } else { DVec3::X };
        let second = view.cross(first);
        let on_disk = u1.sqrt() * DVec2::from_angle(2.0 * PI * u2);
        let share = 0.5 * (1.0 + view.z);
        let x = on_disk.x;
        let y = (1.0 - share) * (1.0 - x * x).max(0.0).sqrt() + share * on_disk.y;
        let normal = x * first + y * second + (1.0 - x * x - y * y).max(0.0).sqrt() * view;
        DVec3::new(self.alpha * normal.x, self.alpha * normal.y, normal.z.max(0.0)).normalize()
    }

    /// Density of [`Ggx::sample_visible`], per steradian: G1(wo)·D(m)·(wo·m)/cosθo.
    pub fn visible_pdf(&self, wo: DVec3, m: DVec3) -> f64 {
        self.masking(wo) * self.distribution(m) * wo.dot(m).max(0.0) / wo.z
    }
}
