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

/// Density of [`sample_hemisphere`] per steradian.
pub fn hemisphere_pdf(view: &View, cos_theta: f64) -> f64 {
    match view.hemisphere {
        HemisphereSampling::Cosine => warp::cosine_hemisphere_pdf(cos_theta),
        HemisphereSampling::Uniform => warp::UNIFORM_HEMISPHERE_PDF,
    }
}
