//! The light that the surface of plastic lets through to the diffuse base below it.

use std::f64::consts::PI;
use std::sync::Arc;

use super::microfacets::{DELTA_ALPHA, Masking, MicrofacetDistribution};
use crate::math::dielectric_reflectance;

/// Angles at which the transmittance of a rough surface is tabulated.
pub const TRANSMITTANCE_NODES: usize = 64;
/// Microfacets that stand for all: by their angle with the normal, and around it.
const FACETS: [usize; 2] = [96, 32];
/// Angles at which light arrives from within.
const ANGLES_WITHIN: usize = 64;

/// The boundary between air and the base of plastic.
#[derive(Debug, Clone, PartialEq)]
pub struct PlasticInterface {
    /// Inside over outside.
    pub ior: f64,
    /// Width of the microfacets; 0 where the surface is smooth.
    pub alpha: f64,
    pub distribution: MicrofacetDistribution,
    pub masking: Masking,
    /// Share of diffuse light from within that the surface sends back.
    internal_reflectance: f64,
    /// Share of light from outside that goes through, by the cosine of its angle; of a rough surface.
    transmittance: Option<Arc<[f32; TRANSMITTANCE_NODES]>>,
}

impl PlasticInterface {
    /// A smooth surface.
    pub fn smooth(ior: f64) -> Self {
        let (distribution, masking) = (MicrofacetDistribution::Ggx, Masking::HeightCorrelated);
        let internal_reflectance = diffuse_reflectance(1.0 / ior);
        Self { ior, alpha: 0.0, distribution, masking, internal_reflectance, transmittance: None }
    }

    /// A surface of microfacets; smooth where they are narrower than [`DELTA_ALPHA`]. What it reflects and lets through is integrated
    /// numerically, once.
    pub fn rough(ior: f64, alpha: f64, distribution: MicrofacetDistribution, masking: Masking) -> Self {
        if alpha < DELTA_ALPHA {
            return Self::smooth(ior);
        }
        let rough = Self { alpha, distribution, masking, ..Self::smooth(ior) };
        let mut table = [0.0_f32; TRANSMITTANCE_NODES];
        for (node, value) in table.iter_mut().enumerate() {
            *value = rough.once_transmitted(node_cosine(node)) as f32;
        }
        // 2 ∫ R(μ) μ dμ, light coming from the denser side.
        let of_angle = |cosine: f64| 2.0 * cosine * rough.once_reflected(cosine, 1.0 / ior);
        let internal_reflectance = midpoints(ANGLES_WITHIN).map(of_angle).sum::<f64>() / ANGLES_WITHIN as f64;
        Self { internal_reflectance, transmittance: Some(Arc::new(table)), ..rough }
    }

    /// The surface has microfacets.
    pub fn is_rough(&self) -> bool {
        self.transmittance.is_some()
    }

    /// 2 ∫ R(μ) μ dμ over what arrives from within.
    pub fn internal_reflectance(&self) -> f64 {
        self.internal_reflectance
    }

    /// Share of light from outside that a rough surface lets through, at cosines from 0 to 1 in even steps; in single precision, as devices
    /// read it.
    pub fn transmittance_table(&self) -> Option<&[f32; TRANSMITTANCE_NODES]> {
        self.transmittance.as_deref()
    }

    /// Share of light at an angle of the given cosine that microfacets reflect once, and no others stop. `eta` is the index of refraction
    /// beyond over that on this side.
    fn once_reflected(&self, cosine: f64, eta: f64) -> f64 {
        self.mean_over_facets(cosine, |o_m, m_z| {
            let i_z = 2.0 * o_m * m_z - cosine;
            (dielectric_reflectance(o_m, eta), i_z)
        })
    }

    /// Share of light from outside that microfacets refract, and no others stop.
    fn once_transmitted(&self, cosine: f64) -> f64 {
        self.mean_over_facets(cosine, |o_m, m_z| {
            let cos_squared = 1.0 - (1.0 - o_m * o_m) / (self.ior * self.ior);
            let t_z = (o_m / self.ior - cos_squared.max(0.0).sqrt()) * m_z - cosine / self.ior;
            (1.0 - dielectric_reflectance(o_m, self.ior), -t_z)
        })
    }

    /// The mean of s·G2·(wo·m)/(cosθo·cosθm) over microfacets m by projected area. `share` gives s and the cosine with which light leaves,
    /// on whichever side that is, by wo·m and cosθm.
    fn mean_over_facets(&self, cosine: f64, share: impl Fn(f64, f64) -> (f64, f64)) -> f64 {
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let tan_squared = |cosine: f64| (1.0 - cosine * cosine).max(0.0) / (cosine * cosine);
        let lambda = |cosine: f64| self.distribution.lambda(self.alpha * self.alpha * tan_squared(cosine));
        let lambda_o = lambda(cosine);
        let mut sum = 0.0;
        for s in midpoints(FACETS[0]) {
            // By the root of the share above, in which the integrand has no poles.
            let (u, weight) = (1.0 - s * s, 2.0 * s);
            let tangent_squared = self.alpha * self.alpha * self.distribution.stretched_tan_squared_below(u);
            let m_z = 1.0 / (1.0 + tangent_squared).sqrt();
            let m_across = m_z * tangent_squared.sqrt();
            for turn in midpoints(FACETS[1]) {
                let o_m = sine * m_across * (PI * turn).cos() + cosine * m_z;
                if o_m <= 0.0 {
                    continue;
                }
                let (share, leaving) = share(o_m.min(1.0), m_z);
                if leaving > 0.0 {
                    let seen = self.masking.shadowing(lambda_o, lambda(leaving.min(1.0)));
                    sum += weight * share * seen * o_m / (cosine * m_z);
                }
            }
        }
        (sum / (FACETS[0] * FACETS[1]) as f64).clamp(0.0, 1.0)
    }
}

/// The middles of so many equal parts of [0, 1].
fn midpoints(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |part| (part as f64 + 0.5) / count as f64)
}

/// Cosine of the angle that an entry of the table is for. At a right angle nothing arrives: the first entry is for one just above it.
fn node_cosine(node: usize) -> f64 {
    (node as f64 / (TRANSMITTANCE_NODES - 1) as f64).max(1e-6)
}

/// Share of diffuse light that a smooth dielectric reflects, 2 ∫ F(μ) μ dμ; `eta` is the index of refraction beyond over that on this side.
/// In closed form by Walsh and Duntley (Duntley 1942, equation 23), and from within by reciprocity.
pub fn diffuse_reflectance(eta: f64) -> f64 {
    /// Nearer to 1 the closed form loses its digits, and next to nothing is reflected.
    const NEAR_ONE: f64 = 1e-3;
    let n = eta.max(1.0 / eta);
    let outside = if n < 1.0 + NEAR_ONE { duntley(1.0 + NEAR_ONE) * (n - 1.0) / NEAR_ONE } else { duntley(n) };
    if eta >= 1.0 { outside } else { 1.0 - (1.0 - outside) / (n * n) }
}

fn duntley(n: f64) -> f64 {
    let (n2, n4) = (n * n, n.powi(4));
    0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0).powi(2))
        + n2 * (n2 - 1.0).powi(2) / (n2 + 1.0).powi(3) * ((n - 1.0) / (n + 1.0)).ln()
        - 2.0 * n * n2 * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0))
        + 8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0).powi(2)) * n.ln()
}
