//! Emitters that are not surfaces.

use std::f64::consts::PI;
use std::rc::Rc;

use glam::DVec3;

use super::converter::Converter;
use super::input::Input;
use super::plugin::Plugin;
use crate::load::error::SceneError;
use crate::load::import::{Entry, FileReference, Keys, world_direction};

impl Converter<'_> {
    pub fn emitter(&mut self, plugin: &Rc<Plugin>) -> Result<(), SceneError> {
        plugin.visited.set(true);
        plugin.without_effect(&["sampling_weight", "id"]);
        let keys = match plugin.name.as_str() {
            "point" => {
                let position = match plugin.vector("position")? {
                    Some(position) => position,
                    None => plugin.transform("to_world")?.translation,
                };
                let intensity = self.constant(plugin, "intensity")?;
                Keys::of_type("point")
                    .with("position", self.world.transform_point3(position))
                    .with("intensity", intensity.value())
            }
            "spot" => self.spot(plugin)?,
            "directional" => {
                let direction = match plugin.vector("direction")? {
                    Some(direction) => direction,
                    None => plugin.transform("to_world")?.matrix3.z_axis,
                };
                let direction = self.direction(plugin, direction)?;
                let irradiance = self.constant(plugin, "irradiance")?;
                Keys::of_type("directional").with("direction", direction).with("irradiance", irradiance.value())
            }
            "constant" => {
                let radiance = self.constant(plugin, "radiance")?;
                Keys::of_type("environment").with("radiance", radiance.value())
            }
            "envmap" => self.environment_map(plugin)?,
            "sky" | "sunsky" | "sun" | "directionalarea" | "collimated" | "projector" | "area" | "perspective" => {
                return self.emitter_without_likeness(plugin);
            }
            other => {
                let what = format!("emitter `{other}`");
                self.drop(plugin, &what, "it gives no light");
                return Ok(());
            }
        };
        self.scene.lights.push(Entry { place: plugin.place.clone(), keys });
        Ok(())
    }

    fn emitter_without_likeness(&mut self, plugin: &Rc<Plugin>) -> Result<(), SceneError> {
        let what = format!("emitter `{}`", plugin.name);
        for property in &plugin.properties {
            property.used.set(true);
        }
        if plugin.name == "area" {
            return Err(plugin.error("an area emitter belongs into a shape"));
        }
        if !["sky", "sunsky", "sun"].contains(&plugin.name.as_str()) {
            self.drop(plugin, &what, "it gives no light");
            return Ok(());
        }
        // Typical of a clear day, in the units of Mitsuba's models: the sky is about 0.1 of the sun's irradiance.
        self.approximate(plugin, &what, "a plain blue sky, and a sun without extent");
        let place = plugin.place.clone();
        if plugin.name != "sun" {
            let keys = Keys::of_type("sky")
                .with("zenith", DVec3::new(0.03, 0.05, 0.1))
                .with("horizon", DVec3::new(0.09, 0.11, 0.13))
                .with("ground", DVec3::splat(0.02));
            self.scene.lights.push(Entry { place: place.clone(), keys });
        }
        if plugin.name != "sky" {
            let toward = plugin.vector("sun_direction")?.unwrap_or(DVec3::new(0.4, 0.7, 0.3));
            let direction = self.direction(plugin, -toward)?;
            let keys = Keys::of_type("directional").with("direction", direction).with("irradiance", DVec3::new(1.4, 1.3, 1.1));
            self.scene.lights.push(Entry { place, keys });
        }
        Ok(())
    }

    /// A colour of light; of a texture its place is taken by 1.
    fn constant(&mut self, plugin: &Plugin, name: &str) -> Result<Input, SceneError> {
        let input = self.light_colour(plugin, name, 1.0)?;
        let Some(colour) = input.constant() else {
            let what = format!("texture of {}", plugin.title());
            self.drop(plugin, &what, "1 is taken for it");
            return Ok(Input::grey(1.0));
        };
        if colour.min_element() < 0.0 {
            return Err(plugin.error(format!("`{name}` is below 0")));
        }
        Ok(Input::Constant(colour))
    }

    fn direction(&self, plugin: &Plugin, direction: DVec3) -> Result<DVec3, SceneError> {
        world_direction(&self.world, direction)
            .ok_or_else(|| plugin.error(format!("the direction of {} has no length", plugin.title())))
    }

    /// Mitsuba's light falls in proportion to the angle, ours as a smooth step of its cosine.
    fn spot(&mut self, plugin: &Plugin) -> Result<Keys, SceneError> {
        let map = plugin.transform("to_world")?;
        let cutoff = plugin.number_or("cutoff_angle", 20.0)?;
        let beam = plugin.number_or("beam_width", 0.75 * cutoff)?;
        if !(cutoff > 0.0 && cutoff <= 90.0 && beam >= 0.0) {
            return Err(plugin.error(format!("`cutoff_angle` is above 0 and at most 90 degrees, not {cutoff}")));
        }
        if beam < cutoff {
            self.approximate(
                plugin,
                "falloff of a spot light",
                "it is smooth in the cosine of the angle, not straight in the angle",
            );
        }
        let intensity = self.constant(plugin, "intensity")?;
        if plugin.child("texture").is_some() {
            self.drop(plugin, "texture of emitter `spot`", "1 is taken for it");
        }
        Ok(Keys::of_type("spot")
            .with("position", self.world.transform_point3(map.translation))
            .with("direction", self.direction(plugin, map.matrix3.z_axis)?)
            .with("intensity", intensity.value())
            .with("angle", cutoff)
            .with("falloff", beam.min(cutoff)))
    }

    fn environment_map(&mut self, plugin: &Plugin) -> Result<Keys, SceneError> {
        plugin.without_effect(&["mis_compensation", "cache", "gamma"]);
        let written = plugin.text("filename")?.ok_or_else(|| plugin.error("an environment map needs the string `filename`"))?;
        let path = self.reader.find(written).ok_or_else(|| plugin.error(format!("there is no file {written}")))?;
        let scale = plugin.number_or("scale", 1.0)?;
        // Upright once the world is turned.
        let turn = self.world.matrix3 * plugin.transform("to_world")?.matrix3;
        if turn.determinant() <= 0.0 {
            self.drop(plugin, "mirroring `to_world` of an environment map", "the map is not mirrored");
        }
        let degrees = turn.x_axis.z.atan2(turn.x_axis.x) * -180.0 / PI;
        // Mitsuba's columns lie as ours do; its first and last row lie on the poles.
        let keys = Keys::of_type("environment").with("file", FileReference::Disk(path)).with("rows", "to_poles");
        let keys = if scale == 1.0 { keys } else { keys.with("scale", scale) };
        Ok(keys.with("rotate", degrees))
    }
}

/// The radiance of a shape's emitter.
pub fn area_radiance(converter: &mut Converter, plugin: &Rc<Plugin>) -> Result<Option<Input>, SceneError> {
    plugin.visited.set(true);
    plugin.without_effect(&["sampling_weight"]);
    if plugin.name != "area" {
        let what = format!("emitter `{}` of a shape", plugin.name);
        converter.drop(plugin, &what, "the shape gives no light");
        return Ok(None);
    }
    let radiance = converter.light_colour(plugin, "radiance", 1.0)?;
    if radiance.constant().is_some_and(|radiance| radiance.min_element() < 0.0) {
        return Err(plugin.error("`radiance` is below 0"));
    }
    Ok(Some(radiance))
}
