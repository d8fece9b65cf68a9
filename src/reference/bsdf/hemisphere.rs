//! Directions over a diffuse surface.

use glam::DVec3;

use super::view::View;
use crate::reference::warp;
use crate::scene::HemisphereSampling;

/// A direction about z, in proportion to its cosine or uniform.
pub fn sample_hemisphere(view: &View, u1: f64, u2: f64) -> DVec3 {
    match view.hemisphere {
        HemisphereSampling::Cosine => warp::cosine_hemisphere(u1, u2),
        HemisphereSampling::Uniform => warp::uniform_hemisphere(u1, u2),
    }
}

/// Weight of such a direction under a reflectance of 1: cosθ/π over the density cosθ/π leaves 1; over the uniform 1/2π, 2·cosθ.
pub fn hemisphere_weight(view: &View, cos_theta: f64) -> f64 {
    match view.hemisphere {
        HemisphereSampling::Cosine => 1.0,
        HemisphereSampling::Uniform => 2.0 * cos_theta,
    }
}

/// Density of [`sample_hemisphere`] per steradian.
pub fn hemisphere_pdf(view: &View, cos_theta: f64) -> f64 {
    match view.hemisphere {
        HemisphereSampling::Cosine => warp::cosine_hemisphere_pdf(cos_theta),
        HemisphereSampling::Uniform => warp::UNIFORM_HEMISPHERE_PDF,
    }
}
