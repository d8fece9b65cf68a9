//! Lights that are not surfaces, and the light of those that are.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DVec3};

use super::converter::Converter;
use super::parameter::Entity;
use super::spectrum::SpectrumKind;
use super::world::LightRecord;
use crate::equal_area_square::place_of;
use crate::load::error::SceneError;
use crate::load::file::colour::Rgb;
use crate::load::file::light::profile::{ProfileEntry, ProfileTable};
use crate::load::file::light::{LightEntry, directional, point, spot};
use crate::load::file::syntax::{TextureFilterEntry, WrapEntry};
use crate::load::file::value::{Checked, Exactly, NonNegative, Vector};
use crate::load::import::{Input, world_direction};
use crate::load::place::Place;
use crate::spectrum::Spectrum;

/// Degrees between the angles of the table that is made of a picture of all directions.
const GONIOMETRIC_STEP: f64 = 2.0;

/// The light of a shape.
pub struct AreaLight {
    pub radiance: Input,
    pub both_sides: bool,
    /// The power that each sphere, disk, cylinder or triangle gives off, where it is said, for a radiance of luminance 1.
    pub power: Option<f64>,
}

impl Converter<'_> {
    /// A light that is no shape's.
    pub fn light(&mut self, record: &LightRecord) -> Result<(), SceneError> {
        let LightRecord { entity, maps } = record;
        if maps[0] != maps[1] {
            self.approximate(&entity.spot, "motion of a light", "it rests where its transform begins");
        }
        let [map, _] = maps;
        let entry = match entity.name.as_str() {
            "point" => self.point_light(entity, map)?,
            "spot" => self.spot_light(entity, map)?,
            "distant" => self.distant_light(entity, map)?,
            "goniometric" => self.goniometric_light(entity, map)?,
            "infinite" => return self.infinite_light(entity, map),
            other => {
                entity.all_without_effect();
                self.drop(&entity.spot, format!("LightSource `{other}`"), "it gives no light");
                return Ok(());
            }
        };
        self.scene.file.light.push(entity.spot.place().at(entry));
        Ok(())
    }

    /// The colour of a light, with its factor.
    pub fn strength(&mut self, entity: &Entity, name: &str) -> Result<Spectrum, SceneError> {
        let colour = self.spectrum(entity, name, SpectrumKind::Illuminant)?.unwrap_or(Spectrum::WHITE);
        Ok(colour * self.factor(entity)?)
    }

    /// The factor of all light of an entity.
    pub fn factor(&self, entity: &Entity) -> Result<f64, SceneError> {
        let scale = entity.float_or("scale", 1.0)?;
        if !(scale >= 0.0 && scale.is_finite()) {
            return Err(entity.spot_of("scale").error(format!("`scale` is at least 0, and not {scale}")));
        }
        Ok(scale * self.exposure)
    }

    fn point_light(&mut self, entity: &Entity, map: &DAffine3) -> Result<LightEntry, SceneError> {
        let mut intensity = self.strength(entity, "I")?;
        if let Some(power) = power_of(entity)? {
            intensity *= power / (2.0 * TAU);
        }
        self.point_at(entity, map, intensity)
    }

    fn point_at(&mut self, entity: &Entity, map: &DAffine3, intensity: Spectrum) -> Result<LightEntry, SceneError> {
        let position = map.transform_point3(entity.point_or("from", DVec3::ZERO)?);
        Ok(LightEntry::Point(point::Keys {
            position: vector(entity, position)?,
            intensity: rgb(entity, intensity)?,
            profile: None,
            direction: None,
            front: None,
            keyframes: None,
            interpolation: None,
            node: None,
            light_group: None,
            lights_only: None,
            lights_all_but: None,
        }))
    }

    /// A light whose intensity a picture of all directions says.
    fn goniometric_light(&mut self, entity: &Entity, map: &DAffine3) -> Result<LightEntry, SceneError> {
        let mut intensity = self.strength(entity, "I")?;
        let mut mean = 1.0;
        let mut profile = None;
        if let Some(written) = entity.text("filename")?.map(str::to_owned) {
            let image = self.picture_named(entity, "filename", &written)?;
            let texels: Vec<f64> = image.texels.colors().map(|texel| Spectrum::from_f32(texel.to_array()).mean()).collect();
            mean = texels.iter().sum::<f64>() / texels.len().max(1) as f64;
            if image.width != image.height {
                let message = format!("the picture of a light is a square, and not {} x {} texels", image.width, image.height);
                return Err(entity.spot_of("filename").error(message));
            }
            if mean > 0.0 {
                let instead = format!("its picture is a table of candela, every {GONIOMETRIC_STEP} degrees, without colours");
                self.approximate(&entity.spot, "LightSource `goniometric`", instead);
                let is_mirrored = map.matrix3.determinant() < 0.0;
                profile =
                    Some(entity.possible(goniometric_table(&texels, image.width as usize, is_mirrored, &entity.spot.place()))?);
            }
        }
        match power_of(entity)? {
            Some(power) => intensity *= power / (2.0 * TAU) / if profile.is_some() { mean } else { 1.0 },
            None => intensity *= if profile.is_some() { 1.0 } else { mean },
        }
        let mut light = self.point_at(entity, map, intensity)?;
        if let (Some(table), LightEntry::Point(keys)) = (profile, &mut light) {
            let place = entity.spot.place();
            keys.profile = Some(place.at(ProfileEntry::Table(table)));
            keys.direction = Some(place.at(self.direction(entity, map, DVec3::Z)?));
            keys.front = Some(place.at(self.direction(entity, map, DVec3::X)?));
        }
        Ok(light)
    }

    fn spot_light(&mut self, entity: &Entity, map: &DAffine3) -> Result<LightEntry, SceneError> {
        let (from, to) = (entity.point_or("from", DVec3::ZERO)?, entity.point_or("to", DVec3::Z)?);
        let (angle, delta) = (entity.float_or("coneangle", 30.0)?, entity.float_or("conedeltaangle", 5.0)?);
        if !(angle > 0.0 && angle <= 90.0) {
            return Err(entity
                .spot_of("coneangle")
                .error(format!("`coneangle` is above 0 and at most 90 degrees here, and not {angle}")));
        }
        let falloff = angle - delta;
        if !(0.0..=angle).contains(&falloff) {
            let message = format!("`conedeltaangle` is from 0 to `coneangle`, {angle} degrees, and not {delta}");
            return Err(entity.spot_of("conedeltaangle").error(message));
        }
        let mut intensity = self.strength(entity, "I")?;
        if let Some(power) = power_of(entity)? {
            let [end, start] = [angle, falloff].map(|angle| angle.to_radians().cos());
            intensity *= power / (TAU * ((1.0 - start) + (start - end) / 2.0));
        }
        let place = entity.spot.place();
        Ok(LightEntry::Spot(spot::Keys {
            position: vector(entity, map.transform_point3(from))?,
            direction: place.at(self.direction(entity, map, to - from)?),
            intensity: rgb(entity, intensity)?,
            angle: entity.possible(Checked::of(angle))?,
            falloff: Some(place.at(entity.possible(Checked::of(falloff))?)),
            curve: None,
            up: None,
            texture: None,
            profile: None,
            front: None,
            keyframes: None,
            interpolation: None,
            node: None,
            light_group: None,
            lights_only: None,
            lights_all_but: None,
        }))
    }

    fn distant_light(&mut self, entity: &Entity, map: &DAffine3) -> Result<LightEntry, SceneError> {
        let (from, to) = (entity.point_or("from", DVec3::ZERO)?, entity.point_or("to", DVec3::Z)?);
        let mut irradiance = self.strength(entity, "L")?;
        if let Some(illuminance) = entity.float("illuminance")?.filter(|value| *value > 0.0) {
            irradiance *= illuminance;
        }
        Ok(LightEntry::Directional(directional::Keys {
            direction: entity.spot.place().at(self.direction(entity, map, to - from)?),
            irradiance: rgb(entity, irradiance)?,
            keyframes: None,
            interpolation: None,
            node: None,
            light_group: None,
            lights_only: None,
            lights_all_but: None,
        }))
    }

    fn direction(&self, entity: &Entity, map: &DAffine3, direction: DVec3) -> Result<Vector, SceneError> {
        let direction = world_direction(map, direction);
        let direction = direction.ok_or_else(|| entity.error(format!("the direction of {} has no length", entity.title())))?;
        vector(entity, direction)
    }

    /// The light of a shape.
    pub fn area_light(&mut self, entity: &Entity) -> Result<Option<AreaLight>, SceneError> {
        if entity.name != "diffuse" {
            entity.all_without_effect();
            self.drop(&entity.spot, format!("AreaLightSource `{}`", entity.name), "the shape gives no light");
            return Ok(None);
        }
        let both_sides = entity.flag_or("twosided", false)?;
        let power = power_of(entity)?;
        let Some(written) = entity.text("filename")?.map(str::to_owned) else {
            let radiance = Input::Constant(self.strength(entity, "L")?);
            self.report_unused(entity);
            return Ok(Some(AreaLight { radiance, both_sides, power }));
        };
        if entity.has("L") {
            return Err(entity.spot_of("L").error("a light has either `L` or `filename`"));
        }
        let spot = entity.spot_of("filename").clone();
        let found = self.files.find(&self.folder, &written);
        let path = found.ok_or_else(|| spot.error(format!("there is no file {written}")))?.path;
        let factor = self.factor(entity)?;
        let key = format!("(light) {}", path.display());
        let texture = match self.made_textures.get(&key) {
            Some(known) => known.clone(),
            None => {
                let made = self.plain_picture(&path, &spot, |entry| {
                    (entry.wrap, entry.filter) = (Some(WrapEntry::Clamp), Some(TextureFilterEntry::Nearest));
                });
                self.made_textures.insert(key, made.clone());
                made
            }
        };
        // The power is that of a picture of its mean.
        let power = match power {
            Some(power) => {
                let image = self.picture(&path, &spot)?;
                let mean = image.texels.colors().map(|texel| Spectrum::from_f32(texel.to_array())).sum::<Spectrum>();
                Some(power / (mean.luminance() / image.texels.len().max(1) as f64).max(f64::MIN_POSITIVE))
            }
            None => None,
        };
        let radiance = match texture {
            Input::Texture(name, own) => Input::Texture(name, own * factor),
            Input::Constant(colour) => Input::Constant(colour * factor),
        };
        self.report_unused(entity);
        Ok(Some(AreaLight { radiance, both_sides, power }))
    }

    /// The picture that a light names.
    pub fn picture_named(&self, entity: &Entity, name: &str, written: &str) -> Result<crate::scene::ImageData, SceneError> {
        let spot = entity.spot_of(name);
        let found = self.files.find(&self.folder, written);
        let path = found.ok_or_else(|| spot.error(format!("there is no file {written}")))?.path;
        self.picture(&path, spot)
    }
}

impl AreaLight {
    /// The radiance of surfaces of this area each.
    pub fn radiance_of(&self, area: f64) -> Input {
        let sides = if self.both_sides { 2.0 } else { 1.0 };
        let factor = self.power.map_or(1.0, |power| power / (PI * sides * area));
        match &self.radiance {
            Input::Constant(colour) => Input::Constant(*colour * factor),
            Input::Texture(name, own) => Input::Texture(name.clone(), *own * factor),
        }
    }
}

/// The candela of a square of equal areas, whose +z is nadir and whose +x is the side of horizontal angle 0; `is_mirrored`: its space is left-handed.
fn goniometric_table(texels: &[f64], side: usize, is_mirrored: bool, place: &Place) -> Result<ProfileTable, String> {
    let candela = |vertical: f64, horizontal: f64| {
        let [(down_sine, down_cosine), (sine, cosine)] = [vertical, horizontal].map(|degrees| degrees.to_radians().sin_cos());
        let across = if is_mirrored { sine } else { -sine };
        let place = place_of(DVec3::new(down_sine * cosine, down_sine * across, down_cosine));
        let [column, row] = place.map(|place| ((place * side as f64) as usize).min(side - 1));
        texels[row * side + column]
    };
    let angles = |last: f64| (0..=(last / GONIOMETRIC_STEP) as u32).map(|step| f64::from(step) * GONIOMETRIC_STEP);
    let number = Checked::<NonNegative>::of;
    let plane =
        |horizontal: f64| angles(180.0).map(|vertical| number(candela(vertical, horizontal))).collect::<Result<Vec<_>, _>>();
    // The first and the last plane are one.
    let turn = |horizontal: f64| plane(horizontal % 360.0);
    Ok(ProfileTable {
        vertical: place.at(angles(180.0).map(number).collect::<Result<_, _>>()?),
        horizontal: Some(place.at(angles(360.0).map(number).collect::<Result<_, _>>()?)),
        candela: place.at(angles(360.0).map(turn).collect::<Result<_, _>>()?),
    })
}

/// A power above 0; other numbers say nothing there.
fn power_of(entity: &Entity) -> Result<Option<f64>, SceneError> {
    Ok(entity.float("power")?.filter(|power| *power > 0.0))
}

fn vector(entity: &Entity, value: DVec3) -> Result<Vector, SceneError> {
    entity.possible(Exactly::of(value.to_array()))
}

pub fn rgb(entity: &Entity, colour: Spectrum) -> Result<Rgb<NonNegative>, SceneError> {
    entity.possible(Rgb::of(colour))
}
