//! Weights of blends as what other formats know: numbers, and functions of a texture's texels.

use crate::math::luminance_f32;
use crate::scene::material::diffuse_reflectance;
use crate::scene::{BlendWeight, TextureId};

/// The weight, where it is the same everywhere.
pub fn constant(weight: &BlendWeight) -> Option<f64> {
    match weight {
        BlendWeight::Constant { value } => Some(value.clamp(0.0, 1.0)),
        BlendWeight::Reverse { of } => constant(of).map(|share| 1.0 - share),
        BlendWeight::Threshold { tau, of } => constant(of).map(|share| if share >= *tau { 1.0 } else { 0.0 }),
        _ => None,
    }
}

/// A function of a texture's texels.
pub type OfTexels<'w> = (TextureId, Box<dyn Fn([f64; 4]) -> f64 + 'w>);

/// The weight as a function of texels, if it is one.
pub fn of_texels(weight: &BlendWeight) -> Option<OfTexels<'_>> {
    match weight {
        BlendWeight::Texture { texture } => {
            Some((*texture, Box::new(|[r, g, b, _]| luminance_f32([r as f32, g as f32, b as f32]).into())))
        }
        BlendWeight::Channel { texture, channel, factor } => Some((*texture, Box::new(move |texel| channel.of(texel) * factor))),
        BlendWeight::Reverse { of } => {
            let (texture, value) = of_texels(of)?;
            Some((texture, Box::new(move |texel| 1.0 - value(texel).clamp(0.0, 1.0))))
        }
        BlendWeight::Threshold { tau, of } => {
            let (texture, value) = of_texels(of)?;
            Some((texture, Box::new(move |texel| if value(texel) >= *tau { 1.0 } else { 0.0 })))
        }
        _ => None,
    }
}

/// Some of it is a threshold.
pub fn has_threshold(weight: &BlendWeight) -> bool {
    match weight {
        BlendWeight::Threshold { .. } => true,
        BlendWeight::Reverse { of } => has_threshold(of),
        _ => false,
    }
}

/// Words for the weight behind "weight".
pub fn name(weight: &BlendWeight) -> &'static str {
    match weight {
        BlendWeight::Facing { .. } => "by the angle",
        BlendWeight::Fresnel { .. } => "by Fresnel's reflectance",
        BlendWeight::Front => "by the side that is seen",
        BlendWeight::Camera => "for the camera",
        BlendWeight::Up { .. } => "by the normal's direction",
        BlendWeight::Open { .. } => "by openness",
        BlendWeight::Reverse { of } | BlendWeight::Threshold { of, .. } => name(of),
        BlendWeight::Constant { .. } => "of a number",
        BlendWeight::Texture { .. } | BlendWeight::Channel { .. } => "of a texture",
    }
}

/// A number in place of a weight, and which one it is.
pub fn mean(weight: &BlendWeight) -> (f64, &'static str) {
    const MEAN: &str = "its mean over all directions is taken";
    match weight {
        BlendWeight::Constant { value } => (*value, MEAN),
        BlendWeight::Facing { power } => (2.0 / (power + 2.0), MEAN),
        BlendWeight::Fresnel { ior, .. } => (1.0 - diffuse_reflectance(ior.max(1.0)), MEAN),
        BlendWeight::Up { power, .. } => (0.5 / (power + 1.0), "its mean over all normals is taken"),
        BlendWeight::Front => (1.0, "both sides are as the front"),
        BlendWeight::Camera => (1.0, "it is seen in mirrors and shadows too"),
        BlendWeight::Open { .. } => (1.0, "all places are open"),
        BlendWeight::Texture { .. } | BlendWeight::Channel { .. } => (0.5, "half of each is taken"),
        BlendWeight::Reverse { of } => {
            let (share, instead) = mean(of);
            (1.0 - share, instead)
        }
        BlendWeight::Threshold { tau, of } => {
            let (share, instead) = mean(of);
            (if share >= *tau { 1.0 } else { 0.0 }, instead)
        }
    }
}
