//! Lobes whose shape is a power of a cosine.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::math::Frame;
use crate::reference::warp;

/// (n+2)/(2π) cosⁿα, 0 past a right angle even where the exponent is 0: no direction there is ever drawn.
pub fn lobe_over_cosine(exponent: f64, cos_alpha: f64) -> f64 {
    if cos_alpha > 0.0 { (exponent + 2.0) / TAU * cos_alpha.powf(exponent) } else { 0.0 }
}

/// Draws a direction from the lobe cosⁿα about `axis`, and gives its density per steradian.
pub fn sample_about(axis: DVec3, exponent: f64, u1: f64, u2: f64) -> (DVec3, f64) {
    let local = warp::phong_lobe(exponent, u1, u2);
    (Frame::around(axis).to_world(local), warp::phong_lobe_pdf(exponent, local.z))
}
