//! Maps from the unit square to the shapes and directions that are sampled, each beside its density.
//!
//! Directions are in a frame whose z axis is the lobe's axis. A density is per steradian or per unit area, as its name says.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

/// Uniform on a disk of radius `radius` around the origin; density 1/(πR²) per area.
pub fn disk(radius: f64, u1: f64, u2: f64) -> DVec2 {
    radius * u1.sqrt() * DVec2::from_angle(TAU * u2)
}

/// Uniform over all directions.
pub fn uniform_sphere(u1: f64, u2: f64) -> DVec3 {
    direction(1.0 - 2.0 * u1, (4.0 * u1 * (1.0 - u1)).max(0.0).sqrt(), u2)
}

/// Density of [`uniform_sphere`] per steradian.
pub const UNIFORM_SPHERE_PDF: f64 = 1.0 / (4.0 * PI);

/// Uniform over the upper hemisphere: z = ξ1.
pub fn uniform_hemisphere(u1: f64, u2: f64) -> DVec3 {
    direction(u1, (1.0 - u1 * u1).max(0.0).sqrt(), u2)
}

/// Density of [`uniform_hemisphere`] per steradian.
pub const UNIFORM_HEMISPHERE_PDF: f64 = 1.0 / TAU;

/// Proportional to the cosine with z: a uniform point of the unit disk, projected up (Malley). cosθ = √(1−ξ1) is never 0, as
/// ξ1 < 1.
pub fn cosine_hemisphere(u1: f64, u2: f64) -> DVec3 {
    direction((1.0 - u1).sqrt(), u1.sqrt(), u2)
}

/// Density of [`cosine_hemisphere`] per steradian.
pub fn cosine_hemisphere_pdf(cos_theta: f64) -> f64 {
    cos_theta.max(0.0) / PI
}

/// Uniform over the cone of half-angle θmax around z. The cone is given by 1 − cosθmax, which keeps its precision when the cone is
/// narrow.
pub fn cone(one_minus_cos_max: f64, u1: f64, u2: f64) -> DVec3 {
    let c = u1 * one_minus_cos_max;
    direction(1.0 - c, (c * (2.0 - c)).max(0.0).sqrt(), u2)
}

/// Density of [`cone`] per steradian.
pub fn cone_pdf(one_minus_cos_max: f64) -> f64 {
    1.0 / (TAU * one_minus_cos_max)
}

/// Proportional to cosⁿα, α the angle with z.
pub fn phong_lobe(exponent: f64, u1: f64, u2: f64) -> DVec3 {
    let cos_alpha = u1.powf(1.0 / (exponent + 1.0));
    direction(cos_alpha, (1.0 - cos_alpha * cos_alpha).max(0.0).sqrt(), u2)
}

/// Density of [`phong_lobe`] per steradian: 0 past a right angle, where 0⁰ would be 1.
pub fn phong_lobe_pdf(exponent: f64, cos_alpha: f64) -> f64 {
    if cos_alpha > 0.0 { (exponent + 1.0) / TAU * cos_alpha.powf(exponent) } else { 0.0 }
}

/// Uniform on a triangle: the weights of its second and third vertex; density 1/A per area.
pub fn triangle(u1: f64, u2: f64) -> DVec2 {
    let root = u1.sqrt();
    DVec2::new(1.0 - root, u2 * root)
}

/// The unit vector at the given angle from z, with azimuth 2π·u.
fn direction(cos_theta: f64, sin_theta: f64, u: f64) -> DVec3 {
    let (sin_phi, cos_phi) = (TAU * u).sin_cos();
    DVec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
}

#[cfg(test)]
mod tests;
