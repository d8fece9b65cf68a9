//! KHR_lights_punctual, and EXT_lights_ies of points with a profile, in the units in which the importer reads them: watts for candela and lux.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use serde_json::{Value, json};

use super::Writer;
use super::container;
use super::node::columns;
use crate::load::lm_63;
use crate::scene::{AimedProfile, FalloffCurve, Light, PointLight};
use crate::spectrum::Spectrum;

impl Writer<'_> {
    pub fn lights(&mut self) {
        let scene = self.scene;
        for (index, light) in scene.lights.iter().enumerate() {
            let place = format!("light[{index}]");
            match light {
                Light::Point(PointLight { position, intensity, profile: Some(aimed) }) => {
                    self.place_profile(index, *intensity, *position, aimed);
                }
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
                    if light.profile.is_some() {
                        self.approximate("profile of a spot light", &place, "it is as strong without it");
                    }
                    let light = &light.without_profile();
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

    fn place_profile(&mut self, index: usize, intensity: Spectrum, position: DVec3, aimed: &AimedProfile) {
        let extension = self.uses("EXT_lights_ies");
        let address = Arc::as_ptr(&aimed.profile);
        let number = match self.made_profiles.get(&address) {
            Some(made) => *made,
            None => {
                let content = lm_63::written(&aimed.profile).into_bytes();
                let written = if self.is_binary {
                    json!({ "bufferView": self.buffer.picture(&content), "mimeType": "application/x-ies-lm-63" })
                } else {
                    let name = format!("profile-{}.ies", self.lists.profiles.len() + 1);
                    json!({ "uri": container::uri(&self.files.add_file(&name, content)) })
                };
                self.lists.profiles.push(written);
                self.made_profiles.insert(address, self.lists.profiles.len() - 1);
                self.lists.profiles.len() - 1
            }
        };
        let [zero, side, nadir] = aimed.axes();
        let map = DAffine3::from_mat3_translation(DMat3::from_cols(zero, side, -nadir), position);
        let (colour, most) = colour_and_strength(intensity);
        let light = json!({ "light": number, "multiplier": most, "color": colour.to_rgb() });
        self.lists
            .nodes
            .push(json!({ "name": format!("light {index}"), "matrix": columns(&map), "extensions": { extension: light } }));
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

/// A colour from 0 to 1, and by what it is multiplied.
fn colour_and_strength(strength: Spectrum) -> (Spectrum, f64) {
    let most = strength.max_component();
    (if most > 0.0 { strength / most } else { Spectrum::WHITE }, most)
}

/// A light by a colour from 0 to 1 and its strength.
fn emitting(kind: &str, strength: Spectrum) -> Value {
    let (colour, most) = colour_and_strength(strength);
    json!({ "type": kind, "color": colour.to_rgb(), "intensity": most })
}
