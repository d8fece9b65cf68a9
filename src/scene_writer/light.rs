//! `[[light]]`

use super::value::{colour, direction, line, number, vector};
use super::writer::Writer;
use crate::scene::{Environment, EnvironmentRadiance, Light, MapRows};

impl Writer<'_> {
    pub fn light(&mut self, light: &Light) -> String {
        let keys = match light {
            Light::Environment(environment) => self.environment(environment),
            Light::Sky(sky) => [("zenith", sky.zenith), ("horizon", sky.horizon), ("ground", sky.ground)]
                .map(|(key, radiance)| line(key, &colour(radiance)))
                .concat(),
            Light::Point(point) => line("position", &vector(point.position)) + &line("intensity", &colour(point.intensity)),
            Light::Spot(spot) => [
                line("position", &vector(spot.position)),
                line("direction", &direction(spot.direction)),
                line("intensity", &colour(spot.intensity)),
                line("angle", &number(spot.angle_degrees)),
                line("falloff", &number(spot.falloff_degrees)),
            ]
            .concat(),
            Light::Directional(light) => {
                line("direction", &direction(light.direction)) + &line("irradiance", &colour(light.irradiance))
            }
        };
        format!("\n[[light]]\ntype = \"{}\"\n{keys}", light.kind_name())
    }

    fn environment(&mut self, environment: &Environment) -> String {
        let mut out = match &environment.radiance {
            EnvironmentRadiance::Constant(radiance) => line("radiance", &colour(*radiance)),
            EnvironmentRadiance::Map(image) => {
                let (file, _, scale) = self.image(image);
                let scale = if scale == 1.0 { String::new() } else { line("scale", &number(scale)) };
                line("file", &file) + &scale
            }
        };
        if environment.rotation_degrees != 0.0 {
            out += &line("rotate", &number(environment.rotation_degrees));
        }
        if environment.rows == MapRows::ToPoles {
            out += &line("rows", "\"to_poles\"");
        }
        out
    }
}
