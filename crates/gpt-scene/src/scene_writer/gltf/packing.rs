//! Numbers of materials in the channels of textures that glTF reads them from.

use std::sync::Arc;

use serde_json::{Value, json};

use super::Writer;
use super::draft::Share;
use super::texture::{Pictured, Role};
use crate::scene::texture::{mean_of_channel, mean_of_texture};
use crate::scene::{BlendWeight, Channel, ImageData, TextureId};
use crate::scene_writer::inputs::{Colour, ColourMap, Scalar, ScalarMap};
use crate::scene_writer::weights;
use crate::spectrum::Spectrum;

/// Factors beside a texture, if there is one.
pub struct Factors<const N: usize> {
    pub factors: [f64; N],
    pub texture: Option<Value>,
}

impl Writer<'_> {
    /// Numbers that share a texture, each in a channel of its own. What has none of them is 1 there.
    pub fn numbers<const N: usize>(&mut self, wanted: [(Channel, Scalar); N], place: &str) -> Factors<N> {
        let mut factors = wanted.map(|(_, scalar)| scalar.constant().unwrap_or(1.0));
        let maps: Vec<(usize, Channel, ScalarMap)> = wanted
            .iter()
            .enumerate()
            .filter_map(|(index, (channel, scalar))| match scalar {
                Scalar::Map(map) => Some((index, *channel, *map)),
                Scalar::Constant(_) => None,
            })
            .collect();
        let Some(&(_, _, first)) = maps.first() else { return Factors { factors, texture: None } };
        let is_possible = |factor: f64| (0.0..=1.0).contains(&factor);
        let is_as_it_is = |(_, channel, map): &(usize, Channel, ScalarMap)| {
            map.texture == first.texture && map.channel == *channel && !map.is_squared && is_possible(map.factor)
        };
        let Some(pictured) = self.pictured(first.texture, place) else {
            for (index, _, map) in maps {
                let mean = mean_of_channel(&self.scene.textures, map.texture, map.channel);
                factors[index] = map.of_texel([mean; 4]);
            }
            return Factors { factors, texture: None };
        };
        self.report_product(first.texture, place);
        if maps.iter().all(is_as_it_is) {
            maps.iter().for_each(|(index, _, map)| factors[*index] = map.factor);
            let image = self.image(&pictured.image, Role::Numbers, place);
            return Factors { factors, texture: Some(self.reference(&pictured, image, place)) };
        }
        let mut channels: [Option<(Pictured, ScalarMap)>; 4] = [None, None, None, None];
        for (index, channel, mut map) in maps.iter().copied() {
            let own = if map.texture == first.texture { Some(pictured.clone()) } else { self.pictured(map.texture, place) };
            let Some(own) = own else {
                factors[index] = map.of_texel([mean_of_channel(&self.scene.textures, map.texture, map.channel); 4]);
                continue;
            };
            if !lie_alike(&own, &pictured) {
                self.approximate(
                    "textures that lie otherwise than one that they share a picture with",
                    place,
                    "they lie as that does",
                );
            }
            // A factor stays one, where it can.
            if !map.is_squared && is_possible(map.factor) {
                factors[index] = std::mem::replace(&mut map.factor, 1.0);
            }
            channels[channel as usize] = Some((own, map));
        }
        let size = channels
            .iter()
            .flatten()
            .fold([1, 1], |[width, height], (own, _)| [own.image.width.max(width), own.image.height.max(height)]);
        let texels = texels(size, |x, y| {
            std::array::from_fn(|channel| match &channels[channel] {
                Some((own, map)) => map.of_texel(texel_at(&own.image, size, x, y)) as f32,
                None => 1.0,
            })
        });
        let key =
            format!("numbers {:?}", channels.iter().map(|channel| channel.as_ref().map(|(_, map)| map)).collect::<Vec<_>>());
        let image = self.made_image(key, size, &texels, Role::Numbers, place);
        Factors { factors, texture: Some(self.reference(&pictured, image, place)) }
    }

    /// A colour with its texture. Factors are from 0 to `most`.
    pub fn colour(&mut self, colour: Colour, most: f64, place: &str) -> (Spectrum, Option<Value>) {
        let map = match colour {
            Colour::Constant(value) => return (self.possible(value, most, place), None),
            Colour::Map(map) => map,
        };
        let Some(pictured) = self.pictured(map.texture, place) else {
            return (self.possible(self.mean(map), most, place), None);
        };
        self.report_product(map.texture, place);
        let is_possible = map.factor.min_component() >= 0.0 && map.factor.max_component() <= most;
        if map.is_plain() && is_possible {
            let image = self.image(&pictured.image, Role::Colour, place);
            return (map.factor, Some(self.reference(&pictured, image, place)));
        }
        // Texels are from 0 to 1, and as bright as the factor says.
        let size = [pictured.image.width, pictured.image.height];
        let value = |x, y| map.of_texel(texel_at(&pictured.image, size, x, y));
        let brightest = (0..size[0] * size[1]).map(|at| value(at % size[0], at / size[0]).max_component()).fold(0.0, f64::max);
        let factor = brightest.clamp(1.0, most);
        let texels = texels(size, |x, y| {
            let [red, green, blue] = (value(x, y) / factor).to_f32();
            [red, green, blue, 1.0]
        });
        let image = self.made_image(format!("colours {map:?}"), size, &texels, Role::Colour, place);
        (Spectrum::grey(factor), Some(self.reference(&pictured, image, place)))
    }

    /// The base colour and the opacity, which share a texture; None of the opacity: 1.
    pub fn base(&mut self, colour: Colour, share: Option<&Share>, place: &str) -> ([f64; 4], Option<Value>) {
        let with_alpha = |colour: Spectrum, alpha: f64| [colour.r(), colour.g(), colour.b(), alpha];
        let (weight, is_rest) = match share {
            None | Some(Share::Constant(_)) => {
                let alpha = if let Some(Share::Constant(alpha)) = share { *alpha } else { 1.0 };
                let (factor, texture) = self.colour(colour, 1.0, place);
                return (with_alpha(factor, alpha), texture);
            }
            Some(Share::Texels { weight, is_rest }) => (weight, *is_rest),
        };
        let Some((id, value)) = weights::of_texels(weight) else { return (with_alpha(Spectrum::WHITE, 1.0), None) };
        let alpha = |texel: [f64; 4]| {
            let share = value(texel).clamp(0.0, 1.0);
            if is_rest { 1.0 - share } else { share }
        };
        let Some(pictured) = self.pictured(id, place) else {
            let mean = mean_of_texture(&self.scene.textures, id);
            let (factor, texture) = self.colour(colour, 1.0, place);
            return (with_alpha(factor, alpha(with_alpha(mean, 1.0))), texture);
        };
        self.report_product(id, place);
        // The alpha of the base colour's own texture.
        if let (BlendWeight::Channel { channel: Channel::A, factor: share, .. }, Colour::Map(map), false) =
            (weight, colour, is_rest)
            && (map.texture, map.is_plain(), (0.0..=1.0).contains(share)) == (id, true, true)
            && map.factor.max_component() <= 1.0
        {
            let image = self.image(&pictured.image, Role::Colour, place);
            return (with_alpha(map.factor, *share), Some(self.reference(&pictured, image, place)));
        }
        let (factor, own) = match colour {
            Colour::Constant(value) => (self.possible(value, 1.0, place), None),
            Colour::Map(map) => match self.pictured(map.texture, place) {
                Some(own) => (Spectrum::WHITE, Some((own, map))),
                None => (self.possible(self.mean(map), 1.0, place), None),
            },
        };
        let mut size = [pictured.image.width, pictured.image.height];
        if let Some((own, _)) = &own {
            size = [size[0].max(own.image.width), size[1].max(own.image.height)];
            if !lie_alike(own, &pictured) {
                self.approximate(
                    "texture of opacity that lies otherwise than the colour's",
                    place,
                    "it lies as the colour's does",
                );
            }
        }
        let texels = texels(size, |x, y| {
            let colour = own.as_ref().map_or(Spectrum::WHITE, |(own, map)| map.of_texel(texel_at(&own.image, size, x, y)));
            let [red, green, blue] = colour.to_f32();
            [red, green, blue, alpha(texel_at(&pictured.image, size, x, y)) as f32]
        });
        let key = format!("base {:?} {weight:?} {is_rest}", own.as_ref().map(|(_, map)| map));
        let image = self.made_image(key, size, &texels, Role::Colour, place);
        let lying = own.map_or(pictured, |(own, _)| own);
        (with_alpha(factor, 1.0), Some(self.reference(&lying, image, place)))
    }

    /// The direction and strength of anisotropy, which share a texture.
    pub fn anisotropy(&mut self, strength: Scalar, direction: Option<TextureId>, place: &str) -> (f64, Option<Value>) {
        let Some(direction) = direction else {
            return match strength {
                Scalar::Constant(strength) => (strength, None),
                // A texture states a direction too: along u.
                Scalar::Map(map) => match self.pictured(map.texture, place) {
                    Some(own) => {
                        let size = [own.image.width, own.image.height];
                        let along_u = |x, y| [1.0, 0.5, map.of_texel(texel_at(&own.image, size, x, y)) as f32, 1.0];
                        let image =
                            self.made_image(format!("along u {map:?}"), size, &texels(size, along_u), Role::Numbers, place);
                        (1.0, Some(self.reference(&own, image, place)))
                    }
                    None => (map.of_texel([mean_of_channel(&self.scene.textures, map.texture, map.channel); 4]), None),
                },
            };
        };
        let [red, green] = [Channel::R, Channel::G]
            .map(|channel| (channel, Scalar::Map(ScalarMap { texture: direction, channel, factor: 1.0, is_squared: false })));
        let Factors { factors: [_, _, strength], texture } = self.numbers([red, green, (Channel::B, strength)], place);
        (strength, texture)
    }

    fn mean(&self, map: ColourMap) -> Spectrum {
        let mean = mean_of_texture(&self.scene.textures, map.texture);
        map.of_texel([mean.r(), mean.g(), mean.b(), 1.0])
    }

    fn possible(&mut self, value: Spectrum, most: f64, place: &str) -> Spectrum {
        let possible = value.clamp(Spectrum::BLACK, Spectrum::grey(most));
        if possible.distance(value) > 1e-9 {
            self.approximate("colour beyond 1", place, "the nearest possible one is taken");
        }
        possible
    }

    fn report_product(&mut self, id: TextureId, place: &str) {
        if self.scene.textures[id].times.is_some_and(|other| !self.is_paint(other)) {
            self.drop("texture by which another is multiplied", place, "the other is as it is");
        }
    }

    /// A normal map, if it is a picture of directions.
    pub fn directions(&mut self, id: TextureId, scale: f64, place: &str) -> Option<Value> {
        let pictured = self.pictured(id, place)?;
        let image = self.image(&pictured.image, Role::Numbers, place);
        let mut info = self.reference(&pictured, image, place);
        if scale != 1.0 {
            info["scale"] = json!(scale);
        }
        Some(info)
    }
}

fn lie_alike(a: &Pictured, b: &Pictured) -> bool {
    let of = |pictured: &Pictured| (pictured.wrap, pictured.filter, pictured.scale, pictured.transform, pictured.by_second_uvs);
    of(a) == of(b)
}

fn texels(size: [u32; 2], texel: impl Fn(u32, u32) -> [f32; 4]) -> Vec<[f32; 4]> {
    (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y])).map(|[x, y]| texel(x, y)).collect()
}

/// The texel of an image that lies where another of that size has the texel at x and y.
fn texel_at(image: &Arc<ImageData>, [width, height]: [u32; 2], x: u32, y: u32) -> [f64; 4] {
    let along = |at: u32, of: u32, own: u32| (u64::from(at) * u64::from(own) / u64::from(of)) as usize;
    let index = along(y, height, image.height) * image.width as usize + along(x, width, image.width);
    image.texels.get(index).map(f64::from)
}
