//! Blends, and the weights by which they are made.

use super::Writer;
use super::directive::Number;
use super::made::{Made, Relief};
use crate::scene::{BlendWeight, MaterialId};
use crate::scene_writer::weights;

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
        if let Some(share) = weights::constant(weight) {
            return Number::Constant(if of_second { 1.0 - share } else { share });
        }
        if let Some((texture, value)) = weights::of_texels(weight) {
            let share = |texel: [f64; 4]| {
                let share = value(texel).clamp(0.0, 1.0);
                if of_second { 1.0 - share } else { share }
            };
            if weights::has_threshold(weight) {
                self.approximate("threshold of a weight", place, "texels are interpolated behind it");
            }
            return self.number_map(texture, &format!("share {weight:?} {of_second}"), place, &share);
        }
        let (share, instead) = weights::mean(weight);
        self.approximate(format!("weight {}", weights::name(weight)), place, instead);
        Number::Constant(if of_second { 1.0 - share } else { share })
    }
}
