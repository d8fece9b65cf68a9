//! Sensors that measure a number instead of taking a picture.

use std::rc::Rc;

use glam::{DAffine3, DVec3};

use super::converter::Converter;
use super::plugin::Plugin;
use crate::load::error::SceneError;
use crate::load::file::meter::{DistantKeys, IrradianceKeys, MeterEntry, RadianceKeys};
use crate::load::file::value::{Checked, Exactly, Vector};
use crate::load::import::is_uniform;

/// True of sensors that are meters.
pub fn is_meter(sensor: &Plugin) -> bool {
    matches!(sensor.name.as_str(), "irradiancemeter" | "radiancemeter" | "distant")
}

impl Converter<'_> {
    /// A meter that stands by itself.
    ///
    /// # Errors
    /// Parameters that make no sense.
    pub fn meter(&mut self, plugin: &Rc<Plugin>) -> Result<(), SceneError> {
        visit(plugin);
        let place = plugin.at();
        if plugin.name == "irradiancemeter" {
            self.drop(plugin, "irradiance meter on no shape", "it is left out");
            return Ok(());
        }
        let to_world = plugin.transform("to_world")?;
        let stated = plugin.vector("direction")?;
        let direction = place.at(given(plugin, stated.unwrap_or(to_world.matrix3.z_axis))?);
        let name = place.at(self.meter_name(plugin));
        let entry = if plugin.name == "radiancemeter" {
            let origin = plugin.vector("origin")?;
            let position = given(plugin, origin.unwrap_or(to_world.translation))?;
            MeterEntry::Radiance(RadianceKeys { name, position, direction, medium: None })
        } else {
            if !plugin.children_of("shape").is_empty() {
                self.approximate(plugin, "shape as the target of a distant sensor", "one ray goes through the scene's origin");
            }
            let target = plugin.vector("target")?;
            if target.is_none() && plugin.children_of("shape").is_empty() {
                self.approximate(plugin, "distant sensor of the whole scene", "one ray goes through the scene's origin");
            }
            let target = target.unwrap_or(DVec3::ZERO);
            MeterEntry::Distant(DistantKeys { name, direction, target: Some(given(plugin, target)?), size: None })
        };
        self.scene.file.meter.push(place.at(entry));
        Ok(())
    }

    /// The meters of irradiance on a shape, which `map` puts into the world.
    ///
    /// # Errors
    /// Numbers that are out of range.
    pub fn meters_on(&mut self, shape: &Rc<Plugin>, map: DAffine3) -> Result<(), SceneError> {
        let sensors: Vec<Rc<Plugin>> = shape.children_of("sensor").into_iter().cloned().collect();
        for sensor in &sensors {
            visit(sensor);
            let measures = matches!(shape.name.as_str(), "rectangle" | "disk" | "sphere") && sensor.name == "irradiancemeter";
            if !measures {
                let what = format!("sensor `{}` on a shape of type `{}`", sensor.name, shape.name);
                self.drop(sensor, &what, "it is left out; meters of irradiance stand on rectangles, disks and spheres");
                continue;
            }
            let [along_x, along_y, along_z] = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis];
            let flipped = shape.flag("flip_normals", false)?;
            let inside_out = shape.name == "sphere" && flipped != (map.matrix3.determinant() < 0.0);
            if shape.name != "rectangle" && !is_uniform(&map) || inside_out {
                let fault = if inside_out { "turned inside out" } else { "stretched" };
                let what = format!("sensor `irradiancemeter` on a {} that is {fault}", shape.name);
                self.drop(
                    sensor,
                    &what,
                    "it is left out; meters of irradiance stand on round disks and on the outsides of spheres",
                );
                continue;
            }
            let place = sensor.at();
            let mut keys = IrradianceKeys {
                name: place.at(self.meter_name(sensor)),
                position: None,
                normal: None,
                corner: None,
                edge_u: None,
                edge_v: None,
                center: None,
                radius: None,
                medium: None,
            };
            if shape.name == "rectangle" {
                let [mut edge_u, mut edge_v] = [2.0 * along_x, 2.0 * along_y];
                if flipped {
                    std::mem::swap(&mut edge_u, &mut edge_v);
                }
                keys.corner = Some(given(sensor, map.transform_point3(DVec3::new(-1.0, -1.0, 0.0)))?);
                keys.edge_u = Some(given(sensor, edge_u)?);
                keys.edge_v = Some(place.at(given(sensor, edge_v)?));
            } else if shape.name == "disk" {
                let front = if flipped { -along_z } else { along_z };
                keys.center = Some(given(sensor, map.translation)?);
                keys.normal = Some(place.at(given(sensor, front)?));
                keys.radius = Some(sensor.possible(Checked::of(along_x.length()))?);
            } else {
                let center = shape.vector("center")?.unwrap_or(DVec3::ZERO);
                let radius = shape.number_or("radius", 1.0)? * along_x.length();
                keys.center = Some(given(sensor, map.transform_point3(center))?);
                keys.radius = Some(sensor.possible(Checked::of(radius))?);
            }
            self.scene.file.meter.push(place.at(MeterEntry::Irradiance(keys)));
        }
        Ok(())
    }

    /// The sensor's id, or its type and a number.
    fn meter_name(&self, sensor: &Plugin) -> String {
        let number = self.scene.file.meter.len() + 1;
        if sensor.id.is_empty() { format!("{} {number}", sensor.name) } else { sensor.id.clone() }
    }
}

/// A vector of a scene file.
fn given(plugin: &Plugin, value: DVec3) -> Result<Vector, SceneError> {
    plugin.possible(Exactly::of(value.to_array()))
}

/// The film and the sampler of a meter say nothing of what it measures.
fn visit(plugin: &Rc<Plugin>) {
    plugin.visited.set(true);
    plugin.without_effect(&["near_clip", "far_clip", "srf"]);
    for child in plugin.children.iter().filter(|child| matches!(child.plugin.kind.as_str(), "film" | "sampler" | "rfilter")) {
        child.used.set(true);
        child.plugin.visited.set(true);
        for within in &child.plugin.children {
            within.used.set(true);
            within.plugin.visited.set(true);
        }
    }
}
