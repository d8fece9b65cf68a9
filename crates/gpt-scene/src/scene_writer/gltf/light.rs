//! KHR_lights_punctual, in the units in which the importer reads it: watts for candela and lux.

use std::f64::consts::FRAC_PI_2;

use glam::{DAffine3, DQuat, DVec3};
use serde_json::{Value, json};

use super::Writer;
use super::node::columns;
use crate::scene::{FalloffCurve, Light};
use crate::spectrum::Spectrum;

impl Writer<'_> {
    pub fn lights(&mut self) {
        let scene = self.scene;
        for (index, light) in scene.lights.iter().enumerate() {
            let place = format!("light[{index}]");
            match light {
                Light::Point(light) => {
                    self.place_light(index, emitting("point", light.intensity), light.position, DVec3::NEG_Z);
                }
                Light::Directional(light) => {
                    self.place_light(index, emitting("directional", light.irradiance), DVec3::ZERO, light.direction);
                }
                Light::Spot(light) => {
                    if light.curve != FalloffCurve::Square && light.falloff_degrees < light.angle_degrees {
                        self.approximate(
                            "falloff of a spot light",
                            &place,
                            "it is the square of a line in the cosine of the angle",
                        );
                    }
                    if light.picture.is_some() {
                        self.drop("picture of a spot light", &place, "its light is as bright as without it");
                    }
                    if light.angle_degrees > 90.0 {
                        self.approximate("spot light of more than 90 degrees", &place, "it shines into half of all directions");
                    }
                    let outer = light.angle_degrees.to_radians().min(FRAC_PI_2);
                    // An inner angle is smaller than the outer one there.
                    let inner = light.falloff_degrees.to_radians().min(outer * (1.0 - 1e-9));
                    let mut written = emitting("spot", light.intensity);
                    written["spot"] = json!({ "innerConeAngle": inner, "outerConeAngle": outer });
                    self.place_light(index, written, light.position, light.direction);
                }
                Light::Projector(_) => self.drop("light `projector`", &place, "it gives no light"),
                Light::Environment(_) | Light::Sky(_) => {
                    let what = format!("light `{}`", light.kind_name());
                    self.drop(what, &place, "nothing shines from outside the scene");
                }
            }
        }
    }

    fn place_light(&mut self, index: usize, light: Value, position: DVec3, direction: DVec3) {
        let turn = DQuat::from_rotation_arc(DVec3::NEG_Z, direction.normalize_or(DVec3::NEG_Z));
        let map = DAffine3::from_rotation_translation(turn, position);
        let extension = self.uses("KHR_lights_punctual");
        let number = self.lists.lights.len();
        self.lists.lights.push(light);
        let node = json!({ "name": format!("light {index}"), "matrix": columns(&map), "extensions": { extension: { "light": number } } });
        self.lists.nodes.push(node);
    }
}

/// A light by a colour from 0 to 1 and its strength.
fn emitting(kind: &str, strength: Spectrum) -> Value {
    let most = strength.max_component();
    let colour = if most > 0.0 { strength / most } else { Spectrum::WHITE };
    json!({ "type": kind, "color": colour.to_rgb(), "intensity": most })
}
