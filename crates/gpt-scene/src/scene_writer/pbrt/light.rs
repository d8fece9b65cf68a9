//! Lights that are not surfaces.

use glam::{DAffine3, DVec3};

use super::Writer;
use super::directive::{Directive, transform};
use super::environment;
use crate::scene::{Environment, EnvironmentRadiance, FalloffCurve, Light, PointLight};
use crate::spectrum::Spectrum;

/// Texels along a side of the map of a light's profile.
const PROFILE_SIDE: u32 = 256;

impl Writer<'_> {
    /// All lights; those at a place are within what is around the camera.
    pub fn lights(&mut self) {
        let scene = self.scene;
        for (index, light) in scene.lights.iter().enumerate() {
            let place = format!("light[{index}]");
            let Some(directive) = self.light(light, &place) else { continue };
            let medium = scene.camera_medium.filter(|_| !light.is_environment());
            // A light that a map describes stands at the origin of its own space.
            let moved =
                if let Light::Point(PointLight { position, profile: Some(_), .. }) = light { Some(*position) } else { None };
            if medium.is_none() && moved.is_none() {
                self.push(directive);
                continue;
            }
            let medium = medium.map(|medium| self.media.get(medium).to_owned());
            self.attributes(|writer| {
                if let Some(medium) = medium {
                    writer.push(Directive::new("MediumInterface", &["", &medium]));
                }
                if let Some(position) = moved {
                    writer.line(transform("Transform", &DAffine3::from_translation(position)));
                }
                writer.push(directive);
            });
        }
    }

    fn light(&mut self, light: &Light, place: &str) -> Option<Directive> {
        let source = |kind: &str| Directive::new("LightSource", &[kind]);
        Some(match light {
            Light::Point(light) => {
                let Some(aimed) = &light.profile else {
                    return Some(source("point").rgb("I", light.intensity).point("from", light.position));
                };
                let side = PROFILE_SIDE;
                self.approximate("profile of a light", place, format!("it is an octahedral map of {side} × {side} texels"));
                let content = environment::octahedral(side, |direction| Spectrum::grey(aimed.candela(direction)));
                let name = self.files.add_file(&format!("profile-{}.exr", self.files.len() + 1), content);
                source("goniometric").rgb("I", light.intensity).string("filename", &name)
            }
            Light::Spot(light) => {
                if light.curve != FalloffCurve::Smooth && light.falloff_degrees < light.angle_degrees {
                    self.approximate("falloff of a spot light", place, "it is a smooth step in the cosine of the angle");
                }
                if light.picture.is_some() {
                    self.drop("picture of a spot light", place, "its light is as bright as without it");
                }
                if light.profile.is_some() {
                    self.approximate("profile of a spot light", place, "it is as strong without it");
                }
                let light = &light.without_profile();
                let target = light.position + light.direction;
                let spot = source("spot").rgb("I", light.intensity).point("from", light.position).point("to", target);
                spot.float("coneangle", light.angle_degrees).float("conedeltaangle", light.angle_degrees - light.falloff_degrees)
            }
            Light::Directional(light) => {
                source("distant").rgb("L", light.irradiance).point("from", DVec3::ZERO).point("to", light.direction)
            }
            Light::Projector(_) => {
                self.drop("light `projector`", place, "it gives no light");
                return None;
            }
            Light::Environment(Environment { radiance: EnvironmentRadiance::Constant(radiance), .. }) => {
                source("infinite").rgb("L", *radiance)
            }
            Light::Environment(light) => {
                let EnvironmentRadiance::Map(map) = &light.radiance else { return None };
                let side = environment::side_for(map.width, map.height);
                self.approximate(
                    "environment map",
                    place,
                    format!("it is resampled to the {side} × {side} texels of an octahedral map of equal areas"),
                );
                let content = environment::octahedral(side, |direction| environment::radiance(light, map, direction));
                let name = self.files.add_file(&format!("environment-{}.exr", self.files.len() + 1), content);
                source("infinite").string("filename", &name)
            }
            Light::Sky(sky) => {
                let side = environment::SKY_SIDE;
                self.approximate("light `sky`", place, format!("it is an octahedral map of {side} × {side} texels"));
                let content = environment::octahedral(side, |direction| {
                    if direction.y >= 0.0 { sky.horizon.lerp(sky.zenith, direction.y) } else { sky.ground }
                });
                let name = self.files.add_file(&format!("environment-{}.exr", self.files.len() + 1), content);
                source("infinite").string("filename", &name)
            }
        })
    }
}
