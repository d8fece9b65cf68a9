//! Blends, and the weights by which they are made.

use super::Writer;
use super::directive::Number;
use super::material::{Made, Relief};
use crate::math::luminance_f32;
use crate::scene::material::diffuse_reflectance;
use crate::scene::{BlendWeight, MaterialId, TextureId};

impl Writer<'_> {
    /// A blend: a mixture, or a surface that is there by a share.
    pub fn blend(&mut self, id: MaterialId, parts: [MaterialId; 2], weight: &BlendWeight, relief: Option<Relief>) -> Made {
        let place = self.place_of(id);
        let [first, second] = parts.map(|part| self.material(part, relief));
        match (&first.name, &second.name) {
            (None, None) => Made::nothing(),
            (Some(_), None) => {
                let share = self.weight(weight, false, &place);
                let alpha = self.product(first.alpha, share, &place);
                Made { name: first.name, alpha }
            }
            (None, Some(_)) => {
                let share = self.weight(weight, true, &place);
                let alpha = self.product(second.alpha, share, &place);
                Made { name: second.name, alpha }
            }
            (Some(a), Some(b)) => {
                let is_opaque = |made: &Made| made.alpha == Number::Constant(1.0);
                if !is_opaque(&first) || !is_opaque(&second) {
                    self.approximate("part of a blend that is not everywhere", &place, "it is there everywhere");
                }
                // The amount is that of the second there.
                let amount = self.weight(weight, true, &place);
                let names = [a.clone(), b.clone()];
                let wanted = self.materials.get(id).to_owned();
                // Its parts are bent, and it has no map of its own there.
                let mix = self.define(
                    &wanted,
                    |directive| {
                        let directive = directive.string("type", "mix").strings("materials", &[&names[0], &names[1]]);
                        directive.number("amount", &amount)
                    },
                    None,
                    &place,
                );
                Made::opaque(mix)
            }
        }
    }

    fn product(&mut self, a: Number, b: Number, place: &str) -> Number {
        match (a, b) {
            (Number::Constant(a), Number::Constant(b)) => Number::Constant(a * b),
            (one @ Number::Texture(_), Number::Constant(1.0)) | (Number::Constant(1.0), one @ Number::Texture(_)) => one,
            (one @ Number::Texture(_), _) | (_, one @ Number::Texture(_)) => {
                self.approximate("opacity within an opacity", place, "that by a texture alone counts");
                one
            }
        }
    }

    /// The weight of the first part of a blend, or of the second one.
    fn weight(&mut self, weight: &BlendWeight, of_second: bool, place: &str) -> Number {
        if let Some(share) = self.constant_weight(weight) {
            return Number::Constant(if of_second { 1.0 - share } else { share });
        }
        if let Some((texture, value)) = of_texels(weight) {
            let share = |texel: [f64; 4]| {
                let share = value(texel).clamp(0.0, 1.0);
                if of_second { 1.0 - share } else { share }
            };
            if has_threshold(weight) {
                self.approximate("threshold of a weight", place, "texels are interpolated behind it");
            }
            return self.number_map(texture, &format!("share {weight:?} {of_second}"), place, &share);
        }
        let (share, instead) = mean(weight);
        self.approximate(format!("weight {}", name(weight)), place, instead);
        Number::Constant(if of_second { 1.0 - share } else { share })
    }

    /// The weight, where it is the same everywhere.
    pub fn constant_weight(&self, weight: &BlendWeight) -> Option<f64> {
        match weight {
            BlendWeight::Constant { value } => Some(value.clamp(0.0, 1.0)),
            BlendWeight::Reverse { of } => self.constant_weight(of).map(|share| 1.0 - share),
            BlendWeight::Threshold { tau, of } => self.constant_weight(of).map(|share| if share >= *tau { 1.0 } else { 0.0 }),
            _ => None,
        }
    }
}

/// A function of a texture's texels.
type OfTexels<'w> = (TextureId, Box<dyn Fn([f64; 4]) -> f64 + 'w>);

/// The weight as a function of texels, if it is one.
fn of_texels(weight: &BlendWeight) -> Option<OfTexels<'_>> {
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

fn has_threshold(weight: &BlendWeight) -> bool {
    match weight {
        BlendWeight::Threshold { .. } => true,
        BlendWeight::Reverse { of } => has_threshold(of),
        _ => false,
    }
}

fn name(weight: &BlendWeight) -> &'static str {
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
fn mean(weight: &BlendWeight) -> (f64, &'static str) {
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
