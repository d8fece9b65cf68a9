//! Distributions of microfacets.

use std::f64::consts::PI;

use statrs::function::erf::{erf, erfc};

use crate::scene::texture::ColorInput;

/// GGX narrower than this is a delta lobe: f32 no longer resolves it.
pub const DELTA_ALPHA: f64 = 1e-4;

/// The microfacets of a rough surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Microfacets {
    /// Width of the distribution: in all directions, or along the one in which texture coordinate u grows where `alpha_v` is another. The
    /// exponent of Phong's distribution.
    pub alpha: ColorInput,
    /// Width across that direction. None: the surface is isotropic.
    pub alpha_v: Option<ColorInput>,
    pub distribution: MicrofacetDistribution,
    pub masking: Masking,
}

impl Microfacets {
    /// Isotropic GGX with height-correlated shadowing; `alpha` 0 is a smooth surface.
    pub fn ggx(alpha: ColorInput) -> Self {
        Self { alpha, alpha_v: None, distribution: MicrofacetDistribution::Ggx, masking: Masking::HeightCorrelated }
    }

    /// The surface is smooth everywhere.
    pub fn are_smooth(&self) -> bool {
        let is_smooth = |alpha: ColorInput| matches!(alpha, ColorInput::Constant(alpha) if alpha.r() < DELTA_ALPHA);
        is_smooth(self.alpha) && self.alpha_v.is_none_or(is_smooth)
    }

    /// Phong's distribution, whose width is an exponent.
    pub fn phong(exponent: ColorInput) -> Self {
        Self { distribution: MicrofacetDistribution::Phong, ..Self::ggx(exponent) }
    }
}

/// Which slopes microfacets have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MicrofacetDistribution {
    /// Trowbridge and Reitz; Walter et al. 2007.
    Ggx,
    /// Normally distributed slopes (Beckmann and Spizzichino 1963; Walter et al. 2007).
    Beckmann,
    /// Cosine-power perturbation of the refracted direction (Honsdorf 2013, section 5.3). Rough glass alone has it.
    Phong,
}

/// How the visibility of microfacets from two directions goes together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Masking {
    /// 1/(1 + Λo + Λi): what is high is seen from both sides (Heitz 2014).
    HeightCorrelated,
    /// G1(wo)·G1(wi), as if the two had nothing to do with each other.
    Separable,
}

impl Masking {
    /// Share of the microfacets that are seen both from wo and from wi, by Smith's Λ of both: G2(wo, wi).
    pub fn shadowing(self, lambda_o: f64, lambda_i: f64) -> f64 {
        match self {
            Self::HeightCorrelated => 1.0 / (1.0 + lambda_o + lambda_i),
            Self::Separable => 1.0 / ((1.0 + lambda_o) * (1.0 + lambda_i)),
        }
    }
}

impl MicrofacetDistribution {
    /// Smith's Λ, invisible over visible area of microfacets, by α²·tan²θ of the direction they are seen from.
    pub fn lambda(self, stretched_tan_squared: f64) -> f64 {
        match self {
            Self::Beckmann if stretched_tan_squared > 0.0 => {
                let a = 1.0 / stretched_tan_squared.sqrt();
                // (erf(a) − 1)/2 + exp(−a²)/(2a√π)
                0.5 * ((-a * a).exp() / (a * PI.sqrt()) - erfc(a))
            }
            Self::Beckmann => 0.0,
            _ => 0.5 * ((1.0 + stretched_tan_squared).sqrt() - 1.0),
        }
    }

    /// tan²θ/α² of the microfacet below which lies the share `u` of all microfacets, by projected area.
    pub(super) fn stretched_tan_squared_below(self, u: f64) -> f64 {
        match self {
            Self::Beckmann => -(1.0 - u).ln(),
            _ => u / (1.0 - u),
        }
    }
}

/// Share of Beckmann's slopes along a direction that are below `slope`, weighted by how large they look from an angle of the given tangent:
/// (1 + erf p)/2 + tanθ·exp(−p²)/(2√π), for slopes of a surface of width 1.
pub fn visible_slopes_below(slope: f64, tangent: f64) -> f64 {
    // erfc keeps the digits of the tail.
    let below = if slope < 0.0 { 0.5 * erfc(-slope) } else { 0.5 * (1.0 + erf(slope)) };
    below + tangent * (-slope * slope).exp() / (2.0 * PI.sqrt())
}
