//! Fibres that stand on a surface and shine where light grazes them.

use glam::DVec3;

use crate::scene::material::{AlbedoTable, sheen_distribution, sheen_lambda};
use crate::spectrum::Spectrum;

/// The sheen of KHR_materials_sheen: c·D·G/(4·cosθo·cosθi) by the distribution and the shadowing of Estevez and Kulla (2017), without Fresnel's
/// reflectance. What lies below gets 1 − max c·E, E the share of light that white fibres reflect, by the larger of those of wo and wi.
///
/// Fibres on a surface. The fit of their shadowing makes E more than 1 at grazing angles of narrow fibres;
/// there all is divided by it, so that they give back what arrives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheen {
    pub color: Spectrum,
    /// The width of the distribution is its square. Not below the smallest that is resolved.
    pub roughness: f64,
}

impl Sheen {
    pub fn is_none(&self) -> bool {
        self.color.max_component() <= 0.0
    }

    /// f·cosθi, of directions in the surface's frame.
    pub fn value(&self, wo: DVec3, wi: DVec3) -> Spectrum {
        let alpha = self.roughness * self.roughness;
        let m = (wo + wi).normalize_or(DVec3::Z);
        let shadowing = 1.0 + sheen_lambda(alpha, wo.z) + sheen_lambda(alpha, wi.z);
        let table = AlbedoTable::of_sheen();
        let most = table.at(wo.z, self.roughness).max(table.at(wi.z, self.roughness)).max(1.0);
        self.color * (sheen_distribution(alpha, m.x * m.x + m.y * m.y) / (4.0 * wo.z * shadowing * most))
    }

    /// Share of light that the fibres take from what lies below, at an angle of the given cosine.
    pub fn taken(&self, cosine: f64) -> f64 {
        if self.is_none() {
            return 0.0;
        }
        self.color.max_component().min(1.0) * AlbedoTable::of_sheen().at(cosine, self.roughness).min(1.0)
    }
}
