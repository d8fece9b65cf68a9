//! KHR_lights_punctual. Candela and lux are taken for watts, as nits of emission are.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use glam::{DAffine3, DVec3};

use super::importer::Importer;
use super::json::{Light, Node};
use crate::load::file::colour::Rgb;
use crate::load::file::light::{LightEntry, directional, point, spot};
use crate::load::file::value::{Checked, Exactly};
use crate::load::import::world_direction;
use crate::spectrum::Spectrum;

const NAME: &str = "KHR_lights_punctual";

impl Importer<'_> {
    pub fn light(&mut self, node: &Node, map: DAffine3, index: usize) -> Result<(), String> {
        let Some(reference) = node.extensions.get(NAME) else { return Ok(()) };
        let number =
            reference.get("light").and_then(serde_json::Value::as_u64).ok_or_else(|| format!("{NAME}: it names no light"))?;
        let lights = self.root.extensions.get(NAME).and_then(|lights| lights.get("lights"));
        let light = lights
            .and_then(|lights| lights.get(number as usize))
            .ok_or_else(|| format!("there is no {NAME}.lights[{number}]"))?;
        let light =
            <Light as serde::Deserialize>::deserialize(light).map_err(|error| format!("{NAME}.lights[{number}]: {error}"))?;
        let key = format!("nodes[{index}]");
        let stated = Spectrum::from_rgb(light.color.unwrap_or([1.0; 3])) * light.intensity.unwrap_or(1.0);
        let colour = stated.max(Spectrum::BLACK);
        if !stated.is_finite() {
            return Err(format!("{NAME}.lights[{number}]: its light is out of range"));
        }
        if colour != stated {
            self.approximate("light below 0", &key, "it is taken for 0");
        }
        if light.range.is_some() && light.r#type != "directional" {
            self.drop("range of a light", &key, "its light reaches everywhere");
        }
        let direction = world_direction(&map, DVec3::NEG_Z).ok_or("its transform leaves no direction")?;
        let place = self.place(&key);
        let position = Exactly::of(map.translation.to_array())?;
        let (direction, strength) = (place.at(Exactly::of(direction.to_array())?), Rgb::of(colour)?);
        let entry = match light.r#type.as_str() {
            "point" => LightEntry::Point(point::Keys {
                position,
                intensity: strength,
                profile: None,
                direction: None,
                front: None,
                keyframes: None,
                interpolation: None,
                node: None,
                light_group: None,
                lights_only: None,
                lights_all_but: None,
            }),
            "directional" => LightEntry::Directional(directional::Keys {
                direction,
                irradiance: strength,
                keyframes: None,
                interpolation: None,
                node: None,
                light_group: None,
                lights_only: None,
                lights_all_but: None,
            }),
            "spot" => {
                let cone = light.spot.clone().unwrap_or_default();
                let stated = [cone.inner_cone_angle.unwrap_or(0.0), cone.outer_cone_angle.unwrap_or(FRAC_PI_4)];
                let outer = stated[1].min(FRAC_PI_2);
                let inner = stated[0].max(0.0).min(outer);
                if outer <= 0.0 {
                    self.drop("spot light without a cone", &key, "it is left out");
                    return Ok(());
                }
                if [inner, outer] != stated {
                    self.approximate(
                        "cone of a spot light",
                        &key,
                        "its angles are taken within 0 and a right angle, the inner within the outer",
                    );
                }
                let [inner, outer] = [inner, outer].map(f64::to_degrees);
                LightEntry::Spot(spot::Keys {
                    position,
                    direction,
                    intensity: strength,
                    angle: Checked::of(outer)?,
                    falloff: Some(place.at(Checked::of(inner)?)),
                    curve: Some(spot::CurveName::Square),
                    texture: None,
                    up: None,
                    profile: None,
                    front: None,
                    keyframes: None,
                    interpolation: None,
                    node: None,
                    light_group: None,
                    lights_only: None,
                    lights_all_but: None,
                })
            }
            other => {
                self.drop(format!("light of type `{other}`"), &key, "it is left out");
                return Ok(());
            }
        };
        self.scene.file.light.push(place.at(entry));
        Ok(())
    }
}
