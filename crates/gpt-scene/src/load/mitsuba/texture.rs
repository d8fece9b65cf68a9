//! Textures, and parameters that may come from one.
//!
//! Texture coordinates stay Mitsuba's, whose v runs downward over a picture; ours runs upward, so pictures are turned over.

use std::rc::Rc;

use glam::{DAffine2, DMat2, DVec2};

use super::colour::Role;
use super::converter::Converter;
use super::input::Texels;
use super::plugin::{Plugin, PropertyValue, SpectralCurve};
use crate::load::error::SceneError;
use crate::load::file::colour::Rgb;
use crate::load::file::syntax::{CheckerEntry, TextureEntry};
use crate::load::file::value::{Exactly, Number};
use crate::load::import::Input;
use crate::spectrum::Spectrum;

impl Converter<'_> {
    /// A colour of light that leaves something: any amount.
    pub fn light_colour(&mut self, plugin: &Plugin, name: &str, default: f64) -> Result<Input, SceneError> {
        self.input(plugin, name, Role::Light, Texels::Colours, default)
    }

    /// A share of light, at most 1.
    pub fn reflectance(&mut self, plugin: &Plugin, name: &str, default: f64) -> Result<Input, SceneError> {
        match self.input(plugin, name, Role::Surface, Texels::Colours, default)? {
            Input::Constant(colour) => {
                if colour.max_component() > 1.0 + 1e-6 {
                    let what = format!("{}: `{name}` above 1", plugin.title());
                    self.approximate(plugin, &what, "1 is taken, since more would make energy");
                }
                Ok(Input::Constant(colour.clamp(Spectrum::BLACK, Spectrum::WHITE)))
            }
            texture => Ok(texture),
        }
    }

    /// A property of a surface for each colour, of any size.
    pub fn surface_number(&mut self, plugin: &Plugin, name: &str, default: f64) -> Result<Input, SceneError> {
        self.input(plugin, name, Role::Surface, Texels::Colours, default)
    }

    /// A number for which there can be no texture here: the mean of one is taken, and reported.
    pub fn plain_number(&mut self, plugin: &Plugin, name: &str, default: f64) -> Result<f64, SceneError> {
        let input = self.scalar(plugin, name, default)?;
        let mean = self.mean(&input);
        if input.constant().is_none() {
            let what = format!("texture of `{name}` of {}", plugin.title());
            self.approximate(plugin, &what, "its mean is taken");
        }
        Ok(mean.r())
    }

    /// A number, perhaps from a texture.
    pub fn scalar(&mut self, plugin: &Plugin, name: &str, default: f64) -> Result<Input, SceneError> {
        Ok(match self.input(plugin, name, Role::Surface, Texels::Numbers, default)? {
            // A colour in place of a number is the mean of its channels there.
            Input::Constant(colour) => Input::Constant(grey_of(colour)),
            texture => texture,
        })
    }

    fn input(&mut self, plugin: &Plugin, name: &str, role: Role, texels: Texels, default: f64) -> Result<Input, SceneError> {
        if let Some(texture) = plugin.child(name).cloned() {
            return self.texture(&texture, role, texels);
        }
        Ok(match plugin.value(name) {
            None => Input::grey(default),
            Some(PropertyValue::Number(number)) => Input::grey(*number),
            Some(PropertyValue::Rgb(colour)) => Input::Constant(*colour),
            Some(PropertyValue::Spectrum(spectrum)) => Input::Constant(spectrum.color(role)),
            Some(PropertyValue::Vector(vector)) if plugin.name == "rawconstant" => {
                Input::Constant(Spectrum::from_rgb(vector.to_array()))
            }
            Some(PropertyValue::Text(_) | PropertyValue::Flag(_) | PropertyValue::Vector(_) | PropertyValue::Transform(_)) => {
                return Err(plugin.error(format!("`{name}` of {} is no colour", plugin.title())));
            }
        })
    }

    /// Converts a texture, or a plugin of a spectrum.
    pub fn texture(&mut self, plugin: &Rc<Plugin>, role: Role, texels: Texels) -> Result<Input, SceneError> {
        plugin.visited.set(true);
        let key = (Rc::as_ptr(plugin), role == Role::Light, texels, self.attributes.as_ref().map(|(mesh, _)| *mesh));
        if let Some(known) = self.textures.get(&key) {
            return Ok(known.clone());
        }
        let input = self.new_texture(plugin, role, texels)?;
        self.textures.insert(key, input.clone());
        Ok(input)
    }

    fn new_texture(&mut self, plugin: &Rc<Plugin>, role: Role, texels: Texels) -> Result<Input, SceneError> {
        match plugin.name.as_str() {
            "bitmap" => self.bitmap(plugin, texels, DAffine2::IDENTITY),
            "checkerboard" => self.checkerboard(plugin, role, texels, DAffine2::IDENTITY),
            "mesh_attribute" => {
                let name = plugin.text("name")?.ok_or_else(|| plugin.error("a mesh attribute needs the string `name`"))?;
                let known = self.attributes.as_ref().and_then(|(_, attributes)| attributes.get(name).cloned());
                let Some(input) = known else {
                    let what = format!("attribute `{name}` of a mesh that has none of this name");
                    self.drop(plugin, &what, "a grey of 0.5 is taken");
                    return Ok(Input::grey(0.5));
                };
                self.scaled(plugin, input)
            }
            "rgb" | "srgb" | "uniform" | "srgb_d65" | "rawconstant" => {
                let name = if plugin.has("value") { "value" } else { "color" };
                let colour = self.input(plugin, name, role, texels, 1.0)?;
                self.scaled(plugin, colour)
            }
            // A texture within is taken as it is in modes of three colours.
            "d65" if plugin.children.iter().any(|child| is_texture(&child.plugin)) => {
                let within = plugin.children.iter().find(|child| is_texture(&child.plugin));
                within.iter().for_each(|child| child.used.set(true));
                plugin.without_effect(&["scale"]);
                within.map_or(Ok(Input::grey(1.0)), |child| self.texture(&child.plugin, role, texels))
            }
            "d65" => {
                let colour = self.input(plugin, "color", role, texels, 1.0)?;
                self.scaled(plugin, colour)
            }
            "blackbody" => {
                let kelvin = plugin.number_or("temperature", 5000.0)?;
                self.scaled(plugin, Input::Constant(SpectralCurve::BlackBody(kelvin, 1.0).color(role)))
            }
            "regular" | "irregular" => super::spectrum::sampled(plugin).map(|spectrum| Input::Constant(spectrum.color(role))),
            "scale" => {
                let Some(within) = plugin.first_of("texture").cloned() else {
                    return self.input(plugin, "value", role, texels, 1.0);
                };
                let colour = self.texture(&within, role, texels)?;
                self.scaled(plugin, colour)
            }
            other => {
                let what = format!("texture `{other}`");
                self.drop(plugin, &what, "a grey of 0.5 is taken");
                Ok(Input::grey(0.5))
            }
        }
    }

    /// Times the plugin's factor.
    fn scaled(&mut self, plugin: &Plugin, colour: Input) -> Result<Input, SceneError> {
        let factor = self.input(plugin, "scale", Role::Light, Texels::Numbers, 1.0)?.constant().unwrap_or(Spectrum::WHITE);
        Ok(match colour {
            Input::Constant(colour) => Input::Constant(colour * factor),
            Input::Texture(name, own) => Input::Texture(name, own * factor),
        })
    }

    /// A colour of light that may be a texture, whose texture coordinates this map gives.
    pub fn light_texture(&mut self, plugin: &Plugin, name: &str, map: DAffine2) -> Result<Input, SceneError> {
        let Some(texture) = plugin.child(name).cloned() else { return self.light_colour(plugin, name, 1.0) };
        texture.visited.set(true);
        match texture.name.as_str() {
            "bitmap" => self.bitmap(&texture, Texels::Colours, map),
            "checkerboard" => self.checkerboard(&texture, Role::Light, Texels::Colours, map),
            _ => self.texture(&texture, Role::Light, Texels::Colours),
        }
    }

    /// The map of texture coordinates as scale, rotation and offset.
    pub fn place_texture(&mut self, plugin: &Plugin, entry: &mut TextureEntry, map: DAffine2) -> Result<(), SceneError> {
        let (x, y) = (map.matrix2.x_axis, map.matrix2.y_axis);
        if x.dot(y).abs() > 1e-9 * x.length() * y.length() {
            self.approximate(plugin, "shear of texture coordinates", "they are turned and scaled alone");
        }
        // A turn by half is a scale by -1, which reads better and is exact.
        let is_straight = x.y == 0.0;
        let scale =
            if is_straight { [x.x, y.y] } else { [x.length(), map.matrix2.determinant() / x.length().max(f64::MIN_POSITIVE)] };
        if let (Some(written), true) = (entry.scale_mut(), scale != [1.0; 2]) {
            *written = Some(plugin.possible(Exactly::of(scale))?);
        }
        let common = entry.common_mut();
        if !is_straight {
            *common.rotation = Some(plugin.possible(Number::of(x.y.atan2(x.x).to_degrees()))?);
        }
        if map.translation != DVec2::ZERO {
            *common.offset = Some(plugin.possible(Exactly::of(map.translation.to_array()))?);
        }
        Ok(())
    }

    fn checkerboard(&mut self, plugin: &Rc<Plugin>, role: Role, texels: Texels, before: DAffine2) -> Result<Input, SceneError> {
        let mut colours = [Spectrum::BLACK; 2];
        for (colour, (name, default)) in colours.iter_mut().zip([("color0", 0.4), ("color1", 0.2)]) {
            let input = self.input(plugin, name, role, Texels::Colours, default)?;
            if input.constant().is_none() {
                self.approximate(plugin, "texture within a checkerboard", "its mean is taken");
            }
            *colour = self.mean(&input);
        }
        // Mitsuba's checkerboard of numbers (`eval_1`) has the fields of its checkerboard of colours (`eval`) the other way round.
        // A colour counts as a number by the mean of its channels.
        if texels != Texels::Colours {
            colours.swap(0, 1);
            colours = colours.map(grey_of);
        }
        // Two squares along each unit.
        let map = DAffine2::from_scale(DVec2::splat(2.0)) * uv_map(plugin)? * before;
        let mut entry = TextureEntry::Checker(CheckerEntry {
            name: plugin.at().at(String::new()),
            a: plugin.possible(Rgb::of(colours[0]))?,
            b: plugin.possible(Rgb::of(colours[1]))?,
            scale: None,
            rotation: None,
            offset: None,
            second_uvs: None,
            bends_by_first_uvs: None,
            times: None,
        });
        self.place_texture(plugin, &mut entry, map)?;
        Ok(self.add_texture(plugin, "checkerboard", entry))
    }

    /// Adds a texture, which it gives a name.
    pub fn add_texture(&mut self, plugin: &Plugin, otherwise: &str, mut entry: TextureEntry) -> Input {
        let wanted = if plugin.id.is_empty() { otherwise } else { &plugin.id };
        let name = self.scene.free_texture_name(wanted);
        *entry.common_mut().name = plugin.at().at(name.clone());
        self.scene.file.texture.push(entry);
        Input::Texture(name, Spectrum::WHITE)
    }
}

/// The mean of its channels.
fn grey_of(colour: Spectrum) -> Spectrum {
    let is_grey = colour.min_component() == colour.max_component();
    if is_grey { colour } else { Spectrum::grey(colour.sum() / 3.0) }
}

fn is_texture(plugin: &Plugin) -> bool {
    ["texture", "spectrum"].contains(&plugin.kind.as_str())
}

/// `to_uv` in the plane.
pub fn uv_map(plugin: &Plugin) -> Result<DAffine2, SceneError> {
    let map = plugin.transform("to_uv")?;
    let (x, y) = (map.matrix3.x_axis.truncate(), map.matrix3.y_axis.truncate());
    Ok(DAffine2 { matrix2: DMat2::from_cols(x, y), translation: map.translation.truncate() })
}
