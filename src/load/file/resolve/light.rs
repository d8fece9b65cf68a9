//! `[[light]]`

use std::sync::Arc;

use crate::load::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::syntax::{EnvironmentLight, LightEntry, SpotLight};
use crate::load::file::value::{LARGEST, Located, vector};
use crate::scene::{Environment, EnvironmentRadiance, ImageData, Light};

impl Resolver<'_> {
    pub(super) fn lights(&mut self, written: &[Located<LightEntry>]) -> Result<(), SceneError> {
        for entry in written {
            let light = match &entry.value {
                LightEntry::Environment(light) => Light::Environment(self.environment(entry, light)?),
                LightEntry::Sky(sky) => Light::Environment(Environment {
                    radiance: EnvironmentRadiance::Sky { zenith: sky.zenith.0, horizon: sky.horizon.0, ground: sky.ground.0 },
                    rotation_degrees: 0.0,
                }),
                LightEntry::Point(point) => Light::Point { position: vector(point.position), intensity: point.intensity.0 },
                LightEntry::Spot(spot) => self.spot(spot)?,
                LightEntry::Directional(light) => {
                    Light::Directional { direction: self.direction(&light.direction)?, irradiance: light.irradiance.0 }
                }
            };
            let is_environment = |light: &Light| matches!(light, Light::Environment(_));
            if is_environment(&light) && self.scene.lights.iter().any(is_environment) {
                return Err(self.error(&entry.span, "a scene has one environment or sky, this is the second"));
            }
            self.scene.lights.push(light);
        }
        Ok(())
    }

    fn environment(&mut self, entry: &Located<LightEntry>, light: &EnvironmentLight) -> Result<Environment, SceneError> {
        let scale = light.scale.as_ref().map_or(1.0, |scale| scale.value.0);
        let radiance = match (&light.radiance, &light.file) {
            (Some(radiance), None) => EnvironmentRadiance::Constant(radiance.value.0 * scale),
            (None, Some(file)) => {
                let image = self.image(file, None)?;
                let texels: Vec<_> = image.texels.iter().map(|&texel| texel * scale as f32).collect();
                if let Some(written) = light.scale.as_ref()
                    && texels.iter().any(|texel| texel.max_element() > LARGEST as f32)
                {
                    let message = format!("the map's radiance times {} is too large: more than 1e18", scale);
                    return Err(self.error(&written.span, message));
                }
                EnvironmentRadiance::Map(Arc::new(ImageData { texels, ..(*image).clone() }))
            }
            (Some(radiance), Some(_)) => {
                return Err(self.error(&radiance.span, "an environment has either `radiance` or `file`"));
            }
            (None, None) => return Err(self.error(&entry.span, "an environment needs the key `radiance` or `file`")),
        };
        Ok(Environment { radiance, rotation_degrees: light.rotate.map_or(0.0, |rotate| rotate.0) })
    }

    fn spot(&self, spot: &SpotLight) -> Result<Light, SceneError> {
        let angle = spot.angle.0;
        let falloff = spot.falloff.as_ref().map_or(angle, |falloff| falloff.value.0);
        if let Some(written) = &spot.falloff
            && falloff > angle
        {
            return Err(self.error(&written.span, format!("`falloff` is at most `angle`, {angle} degrees")));
        }
        Ok(Light::Spot {
            position: vector(spot.position),
            direction: self.direction(&spot.direction)?,
            intensity: spot.intensity.0,
            angle_degrees: angle,
            falloff_degrees: falloff,
        })
    }
}
