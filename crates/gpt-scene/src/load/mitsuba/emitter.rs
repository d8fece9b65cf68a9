//! Emitters that are not surfaces.

use std::f64::consts::PI;
use std::rc::Rc;

use glam::{DAffine2, DAffine3, DMat2, DMat3, DVec2, DVec3};

use super::converter::Converter;
use super::plugin::Plugin;
use crate::load::error::{SceneError, show};
use crate::load::file::colour::Rgb;
use crate::load::file::light::{LightEntry, directional, environment, point, projector, sky, spot};
use crate::load::file::reference::{FileOr, TextureName};
use crate::load::file::shape::TransformEntry;
use crate::load::file::syntax::TextureEntry;
use crate::load::file::value::{Checked, Exactly, Located, NonNegative, Number, Vector};
use crate::load::image_file::Pictures;
use crate::load::import::Input;
use crate::scene::light::is_rotation;
use crate::spectrum::Spectrum;

impl Converter<'_> {
    pub fn emitter(&mut self, plugin: &Rc<Plugin>) -> Result<(), SceneError> {
        plugin.visited.set(true);
        plugin.without_effect(&["sampling_weight", "id"]);
        // The medium that a path is in is what counts, not what the emitter says.
        let _ = plugin.children_of("medium");
        let entry = match plugin.name.as_str() {
            "point" => {
                let position = match plugin.vector("position")? {
                    Some(position) => position,
                    None => plugin.transform("to_world")?.translation,
                };
                let intensity = self.constant(plugin, "intensity")?;
                LightEntry::Point(point::Keys {
                    position: vector(plugin, position)?,
                    intensity: rgb(plugin, intensity)?,
                    profile: None,
                    direction: None,
                    front: None,
                    keyframes: None,
                    interpolation: None,
                    node: None,
                    light_group: None,
                    lights_only: None,
                    lights_all_but: None,
                })
            }
            "spot" => LightEntry::Spot(self.spot(plugin)?),
            "projector" => LightEntry::Projector(self.projector(plugin)?),
            "directional" => {
                let direction = match plugin.vector("direction")? {
                    Some(direction) => direction,
                    None => plugin.transform("to_world")?.matrix3.z_axis,
                };
                let direction = self.direction(plugin, direction)?;
                let irradiance = self.constant(plugin, "irradiance")?;
                sun(plugin, direction, irradiance)?
            }
            "constant" => {
                let radiance = plugin.at().at(rgb(plugin, self.constant(plugin, "radiance")?)?);
                LightEntry::Environment(environment::Keys::constant(radiance))
            }
            "envmap" => LightEntry::Environment(self.environment_map(plugin)?),
            "sky" | "sunsky" | "sun" | "directionalarea" | "collimated" | "area" | "perspective" => {
                return self.emitter_without_likeness(plugin);
            }
            other => {
                let what = format!("emitter `{other}`");
                self.drop(plugin, &what, "it gives no light");
                return Ok(());
            }
        };
        self.scene.file.light.push(plugin.at().at(entry));
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
        let place = plugin.at();
        if plugin.name != "sun" {
            let keys = sky::Keys {
                zenith: rgb(plugin, Spectrum::new(0.03, 0.05, 0.1))?,
                horizon: rgb(plugin, Spectrum::new(0.09, 0.11, 0.13))?,
                ground: rgb(plugin, Spectrum::grey(0.02))?,
                light_group: None,
                lights_only: None,
                lights_all_but: None,
            };
            self.scene.file.light.push(place.at(LightEntry::Sky(keys)));
        }
        if plugin.name != "sky" {
            let toward = plugin.vector("sun_direction")?.unwrap_or(DVec3::new(0.4, 0.7, 0.3));
            let direction = self.direction(plugin, -toward)?;
            let entry = sun(plugin, direction, Spectrum::new(1.4, 1.3, 1.1))?;
            self.scene.file.light.push(place.at(entry));
        }
        Ok(())
    }

    /// A colour of light; of a texture its place is taken by 1.
    fn constant(&mut self, plugin: &Plugin, name: &str) -> Result<Spectrum, SceneError> {
        let input = self.light_colour(plugin, name, 1.0)?;
        let Some(colour) = input.constant() else {
            let what = format!("texture of {}", plugin.title());
            self.drop(plugin, &what, "1 is taken for it");
            return Ok(Spectrum::WHITE);
        };
        if colour.min_component() < 0.0 {
            return Err(plugin.error(format!("`{name}` is below 0")));
        }
        Ok(colour)
    }

    fn direction(&self, plugin: &Plugin, direction: DVec3) -> Result<DVec3, SceneError> {
        direction.try_normalize().ok_or_else(|| plugin.error(format!("the direction of {} has no length", plugin.title())))
    }

    /// A colour of light that may be a texture, which is looked up in the plane across a light's direction: `flips` say whether its u and its
    /// v run to the left and down there.
    fn projected(&mut self, plugin: &Plugin, name: &str, flips: [bool; 2]) -> Result<Input, SceneError> {
        let [x, y] = flips.map(|flipped| if flipped { (-1.0, 1.0) } else { (1.0, 0.0) });
        let map = DAffine2 { matrix2: DMat2::from_diagonal(DVec2::new(x.0, y.0)), translation: DVec2::new(x.1, y.1) };
        let input = self.light_texture(plugin, name, map)?;
        match input.constant() {
            Some(colour) if colour.min_component() < 0.0 => Err(plugin.error(format!("`{name}` is below 0"))),
            _ => Ok(input),
        }
    }

    /// The position of a light and its axis, where its pictures' upper edge is, and whether `to_world` mirrors.
    fn aim(&self, plugin: &Plugin) -> Result<Aim, SceneError> {
        let map = plugin.transform("to_world")?;
        Ok(Aim {
            position: vector(plugin, map.translation)?,
            direction: plugin.at().at(vector(plugin, self.direction(plugin, map.matrix3.z_axis)?)?),
            up: plugin.at().at(vector(plugin, self.direction(plugin, map.matrix3.y_axis)?)?),
            mirrors: map.matrix3.determinant() < 0.0,
        })
    }

    /// Its texture covers the square around the cone; u grows to the left of it.
    fn spot(&mut self, plugin: &Plugin) -> Result<spot::Keys, SceneError> {
        let cutoff = plugin.number_or("cutoff_angle", 20.0)?;
        let beam = plugin.number_or("beam_width", 0.75 * cutoff)?;
        if !(cutoff > 0.0 && cutoff <= 90.0 && beam >= 0.0) {
            return Err(plugin.error(format!("`cutoff_angle` is above 0 and at most 90 degrees, not {cutoff}")));
        }
        let Aim { position, direction, up, mirrors } = self.aim(plugin)?;
        let mut intensity = self.constant(plugin, "intensity")?;
        let mut texture = None;
        if plugin.child("texture").is_some() {
            match self.projected(plugin, "texture", [!mirrors, false])? {
                Input::Constant(colour) => intensity *= colour,
                Input::Texture(name, factor) => {
                    intensity *= factor;
                    texture = Some(plugin.at().at(TextureName(name)));
                }
            }
        }
        Ok(spot::Keys {
            position,
            direction,
            intensity: rgb(plugin, intensity)?,
            angle: plugin.possible(Checked::of(cutoff))?,
            falloff: Some(plugin.at().at(plugin.possible(Checked::of(beam.min(cutoff)))?)),
            curve: (beam < cutoff).then_some(spot::CurveName::Linear),
            up: Some(up).filter(|_| texture.is_some()),
            texture,
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

    /// Mitsuba's `irradiance` is π times as much. Its picture stands upright for what looks along with the light.
    fn projector(&mut self, plugin: &Plugin) -> Result<projector::Keys, SceneError> {
        let scale = PI * plugin.number_or("scale", 1.0)?;
        let Aim { position, direction, up, mirrors } = self.aim(plugin)?;
        let irradiance = self.projected(plugin, "irradiance", [mirrors, true])?;
        let aspect = self.aspect_of(plugin, &irradiance)?;
        let half_width = self.half_width(plugin, aspect)?;
        let (factor, texture) = match irradiance {
            Input::Constant(colour) => (colour, None),
            Input::Texture(name, factor) => (factor, Some(plugin.at().at(TextureName(name)))),
        };
        Ok(projector::Keys {
            position,
            direction,
            up: Some(up),
            irradiance: rgb(plugin, factor * scale)?,
            vfov: plugin.possible(Checked::of(2.0 * (half_width / aspect).atan().to_degrees()))?,
            aspect: Some(plugin.possible(Checked::of(aspect))?),
            texture,
            light_group: None,
            lights_only: None,
            lights_all_but: None,
        })
    }

    /// Width over height of a texture's picture; 1 of what has none.
    fn aspect_of(&self, plugin: &Plugin, input: &Input) -> Result<f64, SceneError> {
        let Input::Texture(name, _) = input else { return Ok(1.0) };
        let entry = self.scene.file.texture.iter().find(|entry| entry.name() == name);
        let Some(TextureEntry::Image(image)) = entry else { return Ok(1.0) };
        let FileOr::OnDisk(path) = &image.file.value else { return Ok(1.0) };
        let picture = Pictures::new(self.files.clone()).read_file(path, None);
        let picture = picture.map_err(|reason| plugin.error(format!("{}: {reason}", show(path))))?;
        Ok(f64::from(picture.image.width) / f64::from(picture.image.height))
    }

    fn environment_map(&mut self, plugin: &Plugin) -> Result<environment::Keys, SceneError> {
        plugin.without_effect(&["mis_compensation", "cache", "gamma"]);
        let written = plugin.text("filename")?.ok_or_else(|| plugin.error("an environment map needs the string `filename`"))?;
        let path = self.reader.find(written).ok_or_else(|| plugin.error(format!("there is no file {written}")))?;
        let scale = plugin.number_or("scale", 1.0)?;
        let mut turn = plugin.transform("to_world")?.matrix3;
        let mirrors = turn.determinant() < 0.0;
        if mirrors {
            turn.x_axis = -turn.x_axis;
        }
        let stated = [turn.x_axis, turn.y_axis, turn.z_axis].map(|axis| axis.normalize_or_zero());
        let stated = DMat3::from_cols(stated[0], stated[1], stated[2]);
        let (x, y) = ((stated.x_axis - stated.y_axis * stated.x_axis.dot(stated.y_axis)).normalize_or_zero(), stated.y_axis);
        let turn = DMat3::from_cols(x, y, x.cross(y));
        if !is_rotation(&turn) {
            return Err(plugin.error("the `to_world` of an environment map flattens it"));
        }
        if !stated.abs_diff_eq(turn, 1e-6) {
            self.approximate(plugin, "`to_world` of an environment map that shears", "the map is turned and not sheared");
        }
        // Upright maps have one angle.
        let is_upright = (y - DVec3::Y).length() < 1e-9;
        let degrees = if is_upright { x.z.atan2(x.x) * -180.0 / PI } else { 0.0 };
        let transform = DAffine3::from_mat3(if is_upright { DMat3::IDENTITY } else { turn });
        // Mitsuba's columns lie as ours do; its first and last row lie on the poles.
        let place = plugin.at();
        let scale = if scale == 1.0 { None } else { Some(place.at(plugin.possible(Checked::of(scale))?)) };
        Ok(environment::Keys {
            radiance: None,
            file: Some(place.at(FileOr::OnDisk(path))),
            daylight: None,
            scale,
            rotate: Some(plugin.possible(Number::of(degrees))?),
            transform: plugin.possible(TransformEntry::of_map(&transform, &place))?,
            mirror: mirrors.then(|| place.at(true)),
            rows: Some(environment::Rows::ToPoles),
            keyframes: None,
            interpolation: None,
            light_group: None,
            lights_only: None,
            lights_all_but: None,
        })
    }
}

/// Position of a light, and the direction in which it shines.
struct Aim {
    position: Vector,
    direction: Located<Vector>,
    up: Located<Vector>,
    mirrors: bool,
}

fn vector(plugin: &Plugin, value: DVec3) -> Result<Vector, SceneError> {
    plugin.possible(Exactly::of(value.to_array()))
}

fn rgb(plugin: &Plugin, colour: Spectrum) -> Result<Rgb<NonNegative>, SceneError> {
    plugin.possible(Rgb::of(colour))
}

fn sun(plugin: &Plugin, direction: DVec3, irradiance: Spectrum) -> Result<LightEntry, SceneError> {
    Ok(LightEntry::Directional(directional::Keys {
        direction: plugin.at().at(vector(plugin, direction)?),
        irradiance: rgb(plugin, irradiance)?,
        keyframes: None,
        interpolation: None,
        node: None,
        light_group: None,
        lights_only: None,
        lights_all_but: None,
    }))
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
    if radiance.constant().is_some_and(|radiance| radiance.min_component() < 0.0) {
        return Err(plugin.error("`radiance` is below 0"));
    }
    Ok(Some(radiance))
}
