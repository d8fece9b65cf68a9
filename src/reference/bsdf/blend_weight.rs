//! The weight of a blend's first material.

use super::fresnel::{dielectric_reflectance, normal_incidence_reflectance, schlick_reflectance};
use super::lookup::Lookup;
use crate::scene::BlendWeight;
use crate::spectrum::Spectrum;
use crate::texture;

/// w0 in [0, 1] at one hit. Nested weights are evaluated from the inside out, as plain numbers.
pub fn weight(blend_weight: &BlendWeight, lookup: &Lookup) -> f64 {
    let cosine = lookup.cosine;
    match *blend_weight {
        BlendWeight::Constant { value } => value,
        BlendWeight::Facing { power } => cosine.powf(power).clamp(0.0, 1.0),
        // Both sides are seen as from outside.
        BlendWeight::Fresnel { ior, exact: true } => 1.0 - dielectric_reflectance(cosine, ior),
        BlendWeight::Fresnel { ior, exact: false } => {
            1.0 - schlick_reflectance(cosine, Spectrum::grey(normal_incidence_reflectance(ior))).r()
        }
        BlendWeight::Front => f64::from(u8::from(lookup.front)),
        BlendWeight::Camera => f64::from(u8::from(lookup.by_camera)),
        BlendWeight::Up { axis, power } => lookup.normal.dot(axis).clamp(0.0, 1.0).powf(power),
        // A baked one is a texture.
        BlendWeight::Open { .. } => 1.0,
        BlendWeight::Texture { texture } => {
            texture::look_up(&lookup.scene.textures, texture, lookup.uv).luminance().clamp(0.0, 1.0)
        }
        BlendWeight::Channel { texture, channel, factor } => {
            (factor * texture::look_up_channel(&lookup.scene.textures, texture, channel, lookup.uv)).clamp(0.0, 1.0)
        }
        BlendWeight::Reverse { ref of } => 1.0 - weight(of, lookup),
        BlendWeight::Threshold { tau, ref of } => {
            if weight(of, lookup) >= tau {
                1.0
            } else {
                0.0
            }
        }
    }
}

/// The value of w0 to be expected without a hit, for choosing lights by power: its value where it is the same
/// everywhere, else one half.
pub fn mean_weight(blend_weight: &BlendWeight) -> f64 {
    constant_weight(blend_weight).unwrap_or(0.5)
}

/// w0 where it is the same everywhere.
fn constant_weight(blend_weight: &BlendWeight) -> Option<f64> {
    match blend_weight {
        BlendWeight::Constant { value } => Some(*value),
        BlendWeight::Facing { .. }
        | BlendWeight::Fresnel { .. }
        | BlendWeight::Front
        | BlendWeight::Camera
        | BlendWeight::Up { .. }
        | BlendWeight::Open { .. }
        | BlendWeight::Texture { .. }
        | BlendWeight::Channel { .. } => None,
        BlendWeight::Reverse { of } => constant_weight(of).map(|weight| 1.0 - weight),
        BlendWeight::Threshold { tau, of } => constant_weight(of).map(|weight| if weight >= *tau { 1.0 } else { 0.0 }),
    }
}
