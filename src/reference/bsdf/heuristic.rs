//! The weight of a blend's first material.

use glam::DVec3;

use super::Lookup;
use super::fresnel::{dielectric_reflectance, normal_incidence_reflectance, schlick_reflectance};
use crate::math::luminance;
use crate::reference::texture;
use crate::scene::Heuristic;

/// w0 in [0, 1] at one hit. Nested heuristics are evaluated from the inside out, as plain numbers.
pub fn weight(heuristic: &Heuristic, lookup: &Lookup) -> f64 {
    let cosine = lookup.cosine;
    match *heuristic {
        Heuristic::Constant { value } => value,
        Heuristic::Facing { power } => cosine.powf(power).clamp(0.0, 1.0),
        // As seen from outside, on either side.
        Heuristic::Fresnel { ior, exact: true } => 1.0 - dielectric_reflectance(cosine, ior),
        Heuristic::Fresnel { ior, exact: false } => {
            1.0 - schlick_reflectance(cosine, DVec3::splat(normal_incidence_reflectance(ior))).x
        }
        Heuristic::Texture { texture } => luminance(texture::look_up(&lookup.scene.textures, texture, lookup.uv)).clamp(0.0, 1.0),
        Heuristic::Reverse { ref of } => 1.0 - weight(of, lookup),
        Heuristic::Threshold { tau, ref of } => {
            if weight(of, lookup) >= tau {
                1.0
            } else {
                0.0
            }
        }
    }
}

/// What to expect of w0 without a hit, for choosing lights by power: its value where it is the same everywhere, else one half.
pub fn mean_weight(heuristic: &Heuristic) -> f64 {
    constant_weight(heuristic).unwrap_or(0.5)
}

/// w0 where it is the same everywhere.
fn constant_weight(heuristic: &Heuristic) -> Option<f64> {
    match heuristic {
        Heuristic::Constant { value } => Some(*value),
        Heuristic::Facing { .. } | Heuristic::Fresnel { .. } | Heuristic::Texture { .. } => None,
        Heuristic::Reverse { of } => constant_weight(of).map(|weight| 1.0 - weight),
        Heuristic::Threshold { tau, of } => constant_weight(of).map(|weight| if weight >= *tau { 1.0 } else { 0.0 }),
    }
}
