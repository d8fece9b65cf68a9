//! Light from everywhere: all of a scene's `infinite` lights are one environment here.
//!
//! Pictures are squares of equal areas there, in the light's own space; here they are resampled to a lat-long map of the world.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DVec3};
use rayon::prelude::*;

use super::converter::Converter;
use super::infinite_lights::{InfiniteLights, InfiniteMap};
use super::parameter::{Entity, Kind};
use super::spectrum::SpectrumKind;
use crate::equal_area_square::{direction_at, place_of};
use crate::load::error::SceneError;
use crate::load::file::light::{LightEntry, environment};
use crate::load::file::material::{MaterialEntry, pass};
use crate::load::file::shape::{ShapeEntry, rectangle};
use crate::scene::{ImageData, Texels};
use crate::spectrum::Spectrum;

/// Most rows of a map.
const MOST_ROWS: u32 = 2048;
const FEWEST_ROWS: u32 = 16;
/// Places along each side of a texel at which pictures are looked up.
const LOOKUPS: usize = 3;

impl Converter<'_> {
    pub(super) fn infinite_light(&mut self, entity: &Entity, map: &DAffine3) -> Result<(), SceneError> {
        self.portal(entity)?;
        let illuminance = entity.float("illuminance")?.filter(|value| *value > 0.0);
        let filename = entity.text("filename")?.map(str::to_owned);
        self.infinite.spot.get_or_insert_with(|| entity.spot.clone());
        let Some(written) = filename else {
            let colour = self.spectrum(entity, "L", SpectrumKind::Illuminant)?.unwrap_or(Spectrum::WHITE);
            // From all of the upper hemisphere alike, a radiance of 1 brings π.
            let factor = self.factor(entity)? * illuminance.map_or(1.0, |illuminance| illuminance / PI);
            self.infinite.constant += colour * factor;
            return Ok(());
        };
        if entity.has("L") {
            return Err(entity.spot_of("L").error("a light has either `L` or `filename`"));
        }
        let image = self.picture_named(entity, "filename", &written)?;
        let spot = entity.spot_of("filename").clone();
        if image.width != image.height {
            let (width, height) = (image.width, image.height);
            let error = spot.error(format!(
                "a picture of light from everywhere is a square whose texels cover equal areas, and this one has {width} x {height} texels"
            ));
            return Err(error.with_help("`imgtool makeequiarea` of pbrt makes one of a lat-long map"));
        }
        let mut scale = self.factor(entity)?;
        if let Some(illuminance) = illuminance {
            scale *= illuminance / illuminance_of(&image).max(f64::MIN_POSITIVE);
        }
        let to_light = map.matrix3.inverse();
        if !to_light.is_finite() {
            return Err(entity.error("the transform of the light flattens it"));
        }
        self.infinite.maps.push(InfiniteMap { image, to_light, scale });
        Ok(())
    }

    /// A rectangle through which all of the light comes there.
    fn portal(&mut self, entity: &Entity) -> Result<(), SceneError> {
        let numbers = entity.list("portal", Kind::Point3, 3)?;
        if numbers.is_empty() {
            return Ok(());
        }
        let spot = entity.spot_of("portal").clone();
        let corners: Vec<DVec3> = numbers.chunks_exact(3).map(DVec3::from_slice).collect();
        let &[a, b, c, d] = &corners[..] else { return Err(spot.error("a portal has four corners")) };
        let instead = "light that comes past it counts too; it guides where light is looked for";
        self.approximate(&spot, "portal of a light", instead);
        let size = (b - a).length().max((d - a).length());
        if (a + c - b - d).length() > 1e-3 * size || (b - a).cross(d - a).length() <= 1e-9 * size * size {
            return Ok(());
        }
        let place = spot.place();
        let key = "(portal)".to_owned();
        let material = match self.variants.get(&key) {
            Some(known) => known.clone(),
            None => {
                let name = self.scene.free_material_name("portal");
                let keys = pass::Keys { name: place.at(name.clone()), ..Default::default() };
                self.scene.file.material.push(MaterialEntry::from(keys));
                self.variants.insert(key, name.clone());
                name
            }
        };
        let mut keys = spot.possible(rectangle::Keys::of([a, b - a, d - a], &place))?;
        (keys.portal, keys.material) = (true, Some(place.at(material)));
        self.scene.file.shape.push(place.at(ShapeEntry::Rectangle(keys)));
        Ok(())
    }

    /// Adds the environment that all infinite lights are.
    pub(super) fn finish_infinite_lights(&mut self) -> Result<(), SceneError> {
        let InfiniteLights { constant, maps, spot } = std::mem::take(&mut self.infinite);
        let Some(spot) = spot else { return Ok(()) };
        let place = spot.place();
        let keys = if maps.is_empty() {
            let radiance = crate::load::file::colour::Rgb::of(constant);
            environment::Keys::constant(place.at(spot.possible(radiance)?))
        } else {
            let rows = maps.iter().map(|map| map.image.width).max().unwrap_or(FEWEST_ROWS).clamp(FEWEST_ROWS, MOST_ROWS);
            let instead = format!("it is resampled to a lat-long map of {} x {rows} texels", 2 * rows);
            self.approximate(&spot, "picture of light from everywhere", instead);
            let file = self.embedded("environment", &lat_long(&maps, constant, rows));
            let black = crate::load::file::colour::Rgb::of(Spectrum::BLACK);
            let constant = environment::Keys::constant(place.at(spot.possible(black)?));
            environment::Keys { radiance: None, file: Some(place.at(file)), ..constant }
        };
        self.scene.file.light.push(place.at(LightEntry::Environment(keys)));
        Ok(())
    }
}

/// The lat-long map of all lights: u = atan2(x, −z)/2π, v = acos(y)/π.
fn lat_long(maps: &[InfiniteMap], constant: Spectrum, rows: u32) -> ImageData {
    let (width, height) = (2 * rows as usize, rows as usize);
    let within = |place: usize, lookup: usize, side: usize| (place as f64 + (lookup as f64 + 0.5) / LOOKUPS as f64) / side as f64;
    let texel = |index: usize| {
        let mut sum = Spectrum::BLACK;
        for lookup in 0..LOOKUPS * LOOKUPS {
            let u = within(index % width, lookup % LOOKUPS, width);
            let v = within(index / width, lookup / LOOKUPS, height);
            let (turn, sine) = (TAU * u, (PI * v).sin());
            let direction = DVec3::new(sine * turn.sin(), (PI * v).cos(), -sine * turn.cos());
            sum += maps.iter().map(|map| map.scale * look_up(&map.image, map.to_light * direction)).sum::<Spectrum>();
        }
        (constant + sum / (LOOKUPS * LOOKUPS) as f64).max(Spectrum::BLACK).to_f32()
    };
    let texels = (0..width * height).into_par_iter().map(texel).collect();
    ImageData { width: width as u32, height: height as u32, texels: Texels::Float(texels), has_alpha: false }
}

/// The colour of a square picture in a direction, between its texels. Beyond a side, the square goes on with the same side turned by half.
fn look_up(image: &ImageData, direction: DVec3) -> Spectrum {
    let side = i64::from(image.width);
    let [x, y] = place_of(direction.normalize_or(DVec3::Z)).map(|place| place * side as f64 - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let texel = |column: i64, row: i64| {
        let (mut column, mut row) = (column, row);
        if !(0..side).contains(&column) {
            (column, row) = (if column < 0 { -1 - column } else { 2 * side - 1 - column }, side - 1 - row);
        }
        if !(0..side).contains(&row) {
            (column, row) = (side - 1 - column, if row < 0 { -1 - row } else { 2 * side - 1 - row });
        }
        let index = row.clamp(0, side - 1) * side + column.clamp(0, side - 1);
        Spectrum::from_f32(image.texels.color(index as usize).to_array())
    };
    let row = |row: i64| texel(left as i64, row).lerp(texel(left as i64 + 1, row), x - left);
    row(top as i64).lerp(row(top as i64 + 1), y - top)
}

/// The illuminance on what faces the light's +Z, by luminance.
fn illuminance_of(image: &ImageData) -> f64 {
    let side = image.width as usize;
    let at = |place: usize| (place as f64 + 0.5) / side as f64;
    let texel = |index: usize| {
        let cosine = direction_at([at(index % side), at(index / side)]).z.max(0.0);
        Spectrum::from_f32(image.texels.color(index).to_array()).luminance() * cosine
    };
    (0..side * side).map(texel).sum::<f64>() * 2.0 * TAU / (side * side) as f64
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;

    fn image(side: u32, radiance: impl Fn(DVec3) -> Spectrum) -> ImageData {
        let at = |place: u32| (f64::from(place) + 0.5) / f64::from(side);
        let texels =
            (0..side * side).map(|index| radiance(direction_at([at(index % side), at(index / side)])).to_f32()).collect();
        ImageData { width: side, height: side, texels: Texels::Float(texels), has_alpha: false }
    }

    /// A linear function of the direction comes back, also across the borders of the square.
    #[test]
    fn pictures_are_looked_up_in_their_directions() {
        let of = |direction: DVec3| Spectrum::from_rgb((direction * 0.5 + 0.5).to_array());
        let image = image(128, of);
        for step in 0..500_u32 {
            let (turn, height) = (f64::from(step) * 2.399, f64::from(step) / 250.0 - 0.999);
            let across = (1.0 - height * height).max(0.0).sqrt();
            let direction = DVec3::new(across * turn.cos(), across * turn.sin(), height);
            let found = look_up(&image, direction);
            assert!(found.distance(of(direction)) < 0.02, "{direction}: {found}");
        }
        // The control: another direction.
        assert!(look_up(&image, DVec3::X).distance(of(DVec3::Y)) > 0.5);
    }

    #[test]
    fn a_bright_sky_of_1_brings_pi() {
        let whole = illuminance_of(&image(64, |_| Spectrum::WHITE));
        assert!((whole - PI).abs() < 1e-2, "{whole}");
        let below = illuminance_of(&image(64, |direction| if direction.z < 0.0 { Spectrum::WHITE } else { Spectrum::BLACK }));
        assert!(below < 0.05, "the control: {below}");
    }

    #[test]
    fn maps_lie_as_the_world_does() {
        let up = image(64, |direction| Spectrum::grey((20.0 * (direction.z - 1.0)).exp()));
        // The light's +Z is the world's +Y.
        let map = InfiniteMap { image: up, to_light: DMat3::from_rotation_x(std::f64::consts::FRAC_PI_2), scale: 2.0 };
        let found = lat_long(&[map], Spectrum::grey(0.25), 32);
        let row = |row: usize| f64::from(found.texels.color(row * 64 + 5).x);
        assert!((row(0) - 2.2).abs() < 0.15 && (row(31) - 0.25).abs() < 1e-3, "{} {}", row(0), row(31));
    }
}
