//! Microfacets with Smith's shadowing (Walter et al. 2007; Heitz 2014): GGX or Beckmann, isotropic or not.
//!
//! All directions are in the surface's frame, z along the shading normal, x along the tangent. m is a microfacet's normal, on the side of
//! the upper hemisphere; wo is in the upper hemisphere, wi anywhere.
//!
//! Light that one microfacet sends to another is lost: the share of a uniform light that GGX microfacets without any absorption
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
use statrs::function::erf::erf_inv;

use super::lookup::Lookup;
use crate::scene::material::{DELTA_ALPHA, visible_slopes_below};
use crate::scene::{Masking, MicrofacetDistribution, Microfacets, PlasticInterface};

/// Random numbers are multiples of 2⁻²⁴: what lies below the smallest is drawn half-way to it.
const SMALLEST_NUMBER: f64 = 0.5 / 16_777_216.0;

/// The microfacets at one hit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facets {
    /// Widths along the tangent and across it. Below [`DELTA_ALPHA`] the surface is smooth.
    pub alpha: DVec2,
    pub distribution: MicrofacetDistribution,
    pub masking: Masking,
    /// The two widths are parameters of their own: x is along the direction in which texture coordinate u grows.
    pub anisotropic: bool,
}

impl Facets {
    /// Isotropic GGX, heights correlated.
    #[cfg(test)]
    pub fn ggx(alpha: f64) -> Self {
        let (distribution, masking) = (MicrofacetDistribution::Ggx, Masking::HeightCorrelated);
        Self { alpha: DVec2::splat(alpha), distribution, masking, anisotropic: false }
    }

    /// Looks the widths up. Of two widths, one too narrow to be resolved is as wide as can be.
    pub fn of(facets: &Microfacets, lookup: &Lookup) -> Self {
        let Microfacets { alpha, alpha_v, distribution, masking } = facets;
        let along = lookup.scalar(alpha);
        let Some(across) = alpha_v else {
            return Self { alpha: DVec2::splat(along), distribution: *distribution, masking: *masking, anisotropic: false };
        };
        let mut alpha = DVec2::new(along, lookup.scalar(across));
        if alpha.max_element() >= DELTA_ALPHA {
            alpha = alpha.max(DVec2::splat(DELTA_ALPHA));
        }
        Self { alpha, distribution: *distribution, masking: *masking, anisotropic: true }
    }

    /// Facets of rough plastic, which are the same everywhere.
    pub fn of_plastic(interface: &PlasticInterface) -> Self {
        let PlasticInterface { alpha, distribution, masking, .. } = *interface;
        Self { alpha: DVec2::splat(alpha), distribution, masking, anisotropic: false }
    }

    /// Too narrow to be told from a smooth surface.
    pub fn are_smooth(&self) -> bool {
        self.alpha.max_element() < DELTA_ALPHA
    }

    /// Area of microfacets with normal m, per area of the surface and per steradian: D(m). ∫ D(m) cosθm dωm = 1.
    pub fn distribution(&self, m: DVec3) -> f64 {
        let product = self.alpha.x * self.alpha.y;
        // tan²θ·cos²θ, each component over its width.
        let slopes = if self.anisotropic {
            (m.x / self.alpha.x).powi(2) + (m.y / self.alpha.y).powi(2)
        } else {
            (m.x * m.x + m.y * m.y) / product
        };
        let cos_squared = m.z * m.z;
        match self.distribution {
            MicrofacetDistribution::Beckmann if cos_squared == 0.0 => 0.0,
            MicrofacetDistribution::Beckmann => (-slopes / cos_squared).exp() / (PI * product * cos_squared * cos_squared),
            // α²/(π(cos²θ(α² − 1) + 1)²), written over the components, which keep their digits where cosθ is nearly 1.
            _ => {
                let stretched = slopes + cos_squared;
                1.0 / (PI * product * stretched * stretched)
            }
        }
    }

    /// Smith's Λ(w): invisible over visible microfacet area seen from w.
    fn lambda(&self, w: DVec3) -> f64 {
        let stretched_tan_squared = if self.anisotropic {
            (DVec2::new(w.x, w.y) * self.alpha).length_squared() / (w.z * w.z)
        } else {
            let tan_squared = (w.x * w.x + w.y * w.y) / (w.z * w.z);
            self.alpha.x * self.alpha.x * tan_squared
        };
        self.distribution.lambda(stretched_tan_squared)
    }

    /// Share of the microfacets that can be seen from w: G1(w).
    pub fn masking(&self, w: DVec3) -> f64 {
        1.0 / (1.0 + self.lambda(w))
    }

    /// Share that can be seen both from wo and from wi: G2(wo, wi). The same where wi is below the surface.
    pub fn shadowing_masking(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.masking.shadowing(self.lambda(wo), self.lambda(wi))
    }

    /// Share of those seen from wo that are seen from wi too.
    pub fn shadowing_of_visible(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.shadowing_masking(wo, wi) / self.masking(wo)
    }

    /// Draws a microfacet normal from those visible from wo: of a surface of width 1, stretched as both distributions can be.
    pub fn sample_visible(&self, wo: DVec3, u1: f64, u2: f64) -> DVec3 {
        let stretched = DVec3::new(self.alpha.x * wo.x, self.alpha.y * wo.y, wo.z).normalize();
        let normal = match self.distribution {
            MicrofacetDistribution::Beckmann => visible_beckmann(stretched, u1, u2),
            _ => visible_ggx(stretched, u1, u2),
        };
        DVec3::new(self.alpha.x * normal.x, self.alpha.y * normal.y, normal.z.max(0.0)).normalize()
    }

    /// Density of [`Facets::sample_visible`], per steradian: G1(wo)·D(m)·(wo·m)/cosθo.
    pub fn visible_pdf(&self, wo: DVec3, m: DVec3) -> f64 {
        self.masking(wo) * self.distribution(m) * wo.dot(m).max(0.0) / wo.z
    }
}

/// A visible normal of GGX (Heitz 2018, "Sampling the GGX Distribution of Visible Normals"): on a hemisphere, the visible ones are a half disk and a half
/// ellipse seen from wo.
fn visible_ggx(wo: DVec3, u1: f64, u2: f64) -> DVec3 {
    let across_squared = wo.x * wo.x + wo.y * wo.y;
    let first = if across_squared > 0.0 { DVec3::new(-wo.y, wo.x, 0.0) / across_squared.sqrt() } else { DVec3::X };
    let second = wo.cross(first);
    let on_disk = u1.sqrt() * DVec2::from_angle(2.0 * PI * u2);
    let share = 0.5 * (1.0 + wo.z);
    let x = on_disk.x;
    let y = (1.0 - share) * (1.0 - x * x).max(0.0).sqrt() + share * on_disk.y;
    x * first + y * second + (1.0 - x * x - y * y).max(0.0).sqrt() * wo
}

/// A visible normal of Beckmann's facets (Heitz and d'Eon 2014): across the direction of view slopes are normally distributed; along it they are weighted by how large
/// they look, and their distribution is inverted numerically.
fn visible_beckmann(wo: DVec3, u1: f64, u2: f64) -> DVec3 {
    let sine = wo.x.hypot(wo.y);
    let direction = if sine > 0.0 { DVec2::new(wo.x, wo.y) / sine } else { DVec2::X };
    let tangent = sine / wo.z;
    // From further on than this slopes are never drawn: less than 2⁻²⁵ of them lie there.
    const STEEPEST: f64 = 5.0;
    let (mut low, mut high) = (-STEEPEST, STEEPEST.min(1.0 / tangent));
    let wanted = u1.max(SMALLEST_NUMBER) * visible_slopes_below(high, tangent);
    for _ in 0..52 {
        let middle = 0.5 * (low + high);
        if visible_slopes_below(middle, tangent) < wanted { low = middle } else { high = middle }
    }
    let along = 0.5 * (low + high);
    let across = erf_inv(2.0 * (u2 + SMALLEST_NUMBER) - 1.0);
    let slope = DVec2::new(direction.x * along - direction.y * across, direction.y * along + direction.x * across);
    DVec3::new(-slope.x, -slope.y, 1.0)
}
