//! Chandrasekhar's half space (Radiative Transfer, 1950): isotropic scattering of any order in a medium without a lower end and without a boundary.

use std::f64::consts::PI;

use super::quadrature::gauss_legendre;

/// H on the nodes of a quadrature, for one albedo.
#[derive(Debug, Clone)]
pub struct HalfSpace {
    albedo: f64,
    /// Cosines, weights and H.
    nodes: Vec<(f64, f64, f64)>,
}

impl HalfSpace {
    /// Solves 1/H(µ) = √(1 − ϖ) + ϖ/2 ∫ x H(x) / (µ + x) dx by iteration, on the squares of Gauss's nodes, since H has an infinite slope at 0.
    pub fn new(albedo: f64) -> Self {
        let rule = gauss_legendre(64, 0.0, 1.0);
        let nodes = rule.into_iter().map(|(x, weight)| (x * x, 2.0 * x * weight, 1.0)).collect();
        let mut solved = Self { albedo, nodes };
        for _ in 0..1000 {
            // The mean of two iterates: they come from either side.
            let next: Vec<f64> = solved.nodes.iter().map(|&(cosine, _, h)| 0.5 * (h + solved.h(cosine))).collect();
            let change = solved.nodes.iter().zip(&next).map(|(node, next)| (node.2 - next).abs()).fold(0.0, f64::max);
            solved.nodes.iter_mut().zip(next).for_each(|(node, next)| node.2 = next);
            if change < 1e-15 {
                break;
            }
        }
        solved
    }

    /// H(µ).
    pub fn h(&self, cosine: f64) -> f64 {
        let integral: f64 = self.nodes.iter().map(|(x, weight, h)| weight * x * h / (cosine + x)).sum();
        1.0 / ((1.0 - self.albedo).sqrt() + 0.5 * self.albedo * integral)
    }

    /// The radiance of the half space in light whose irradiance perpendicular to itself is 1, by the cosines of the directions to light and eye.
    pub fn radiance(&self, [light, eye]: [f64; 2]) -> f64 {
        self.albedo / (4.0 * PI) * light / (light + eye) * self.h(light) * self.h(eye)
    }

    /// The part that is reflected of light from one direction; and, by reciprocity, the radiance towards that direction under a sky of radiance 1.
    pub fn plane_albedo(&self, cosine: f64) -> f64 {
        1.0 - self.h(cosine) * (1.0 - self.albedo).sqrt()
    }

    /// The part that is reflected of light that comes from all of the sky alike.
    pub fn spherical_albedo(&self) -> f64 {
        let moment: f64 = self.nodes.iter().map(|(x, weight, h)| weight * x * h).sum();
        1.0 - 2.0 * (1.0 - self.albedo).sqrt() * moment
    }
}
