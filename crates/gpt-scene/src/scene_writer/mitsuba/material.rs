//! Materials and their textures.

use std::collections::HashMap;

use toml::{Table, Value};

use super::Writer;
use super::keys::{Keys, as_number, colour, entries, flag, number, numbers, table, text};
use super::xml::Element;
use crate::load::SceneError;
use crate::scene::TextureKind;
use crate::scene_writer::pictures::grey_picture;
use crate::spectrum::Spectrum;

/// Mitsuba's name of one of our presets.
const PRESETS: [(&str, &str); 4] = [("gold", "Au"), ("copper", "Cu"), ("silver", "Ag"), ("aluminium", "Al")];

impl<'w> Writer<'w> {
    /// Says a material; its place in reports.
    pub fn material(&mut self, material: &Keys<'_>) -> Result<String, SceneError> {
        // Shapes say what it gives off and what it holds.
        for key in ["emission", "emission_two_sided", "radiance", "interior", "attenuation_color", "attenuation_distance"] {
            let _ = material.contains_key(key);
        }
        let name = text(material, "name").unwrap_or_default().to_owned();
        let place = format!("material `{name}`");
        let bsdf = self.bsdf(material, &place)?;
        if material.contains_key("thin_film_thickness") {
            self.drop("thin_film_thickness", &place, "there is no film");
        }
        if material.contains_key("abbe_number") {
            self.drop("abbe_number", &place, "all colours are bent alike");
        }
        for key in ["cauchy", "sellmeier"] {
            if material.contains_key(key) {
                self.drop(key, &place, "an index of refraction of 1.5 is taken");
            }
        }
        if material.contains_key("diffuse_transmission") {
            self.drop("diffuse_transmission", &place, "light does not come through");
        }
        let kind = text(material, "type").unwrap_or_default();
        let is_transparent = ["glass", "rough_glass", "pass"].contains(&kind);
        let is_shadowed = flag(material, "normal_shadowing") == Some(true);
        let is_mirrored = flag(material, "normal_mirroring") == Some(true);
        let bsdf = match text(material, "normal_map") {
            Some(texture) => {
                let map = self.texture(texture, "normalmap", true)?;
                let element = Element::new("bsdf", "normalmap").boolean("use_shadowing_function", is_shadowed);
                element.boolean("flip_invalid_normals", is_mirrored).with(map).with(bsdf)
            }
            None => bsdf,
        };
        if number(material, "normal_scale").is_some_and(|scale| scale != 1.0) {
            self.drop("normal_scale", &place, "the map is as strong as it is");
        }
        let bsdf = match text(material, "bump_map") {
            Some(texture) => {
                let map = self.texture(texture, "bump", true)?;
                let scale = number(material, "bump_scale").unwrap_or(1.0);
                let element = Element::new("bsdf", "bumpmap").float("scale", scale);
                element.boolean("use_shadowing_function", is_shadowed).with(map).with(bsdf)
            }
            None => bsdf,
        };
        let one_sided = flag(material, "two_sided") == Some(false) && kind != "emissive";
        // A blend of see-through parts cannot be two-sided there.
        // One side and the other are said by the blend.
        let has_sides = table(material, "weight").is_some_and(|weight| text(weight, "type") == Some("front"));
        let bsdf = if is_transparent || one_sided || has_sides || self.lets_light_through(&name, 0) {
            bsdf
        } else {
            Element::new("bsdf", "twosided").with(bsdf)
        };
        self.xml.push(bsdf.id(&name));
        Ok(place)
    }

    /// All materials, each behind the parts that it blends: what is named stands above there.
    pub fn parts_first(&self) -> Vec<&'w Table> {
        let all = entries(self.scene, "material");
        let by_name: HashMap<&str, usize> =
            all.iter().enumerate().filter_map(|(index, material)| Some((text(*material, "name")?, index))).collect();
        let (mut is_done, mut ordered) = (vec![false; all.len()], Vec::with_capacity(all.len()));
        for start in 0..all.len() {
            // A blend waits below its parts; that none is a part of itself was found before.
            let mut waiting = vec![start];
            while let Some(&index) = waiting.last() {
                let parts = all[index].get("materials").and_then(Value::as_array).into_iter().flatten();
                let mut parts = parts.filter_map(Value::as_str).filter_map(|part| by_name.get(part).copied());
                if let Some(part) = parts.find(|part| !is_done[*part]) {
                    waiting.push(part);
                    continue;
                }
                waiting.pop();
                if !std::mem::replace(&mut is_done[index], true) {
                    ordered.push(all[index]);
                }
            }
        }
        ordered
    }

    fn named(&self, name: &str) -> Option<&Table> {
        entries(self.scene, "material").into_iter().find(|material| text(*material, "name") == Some(name))
    }

    /// True where the material, or a part of it at any depth, looks up a texture.
    pub fn shows_texture(&self, name: &str, depth: usize) -> bool {
        let Some(material) = self.named(name) else { return false };
        let is_texture = |(key, value): (&String, &Value)| {
            let names = ["normal_map", "bump_map", "coat_normal_map"];
            names.contains(&key.as_str()) || value.as_table().is_some_and(|of| of.contains_key("texture"))
        };
        let parts = material.get("materials").and_then(Value::as_array);
        let mut parts = parts.into_iter().flatten().filter_map(Value::as_str);
        material.iter().any(is_texture) || depth < 100 && parts.any(|part| self.shows_texture(part, depth + 1))
    }

    /// A part of it does, at any depth.
    fn lets_light_through(&self, name: &str, depth: usize) -> bool {
        let Some(material) = self.named(name) else { return false };
        match text(material, "type") {
            Some("glass" | "rough_glass" | "pass") => true,
            Some("blend") if depth < 100 => {
                let parts = material.get("materials").and_then(Value::as_array);
                parts.into_iter().flatten().filter_map(Value::as_str).any(|part| self.lets_light_through(part, depth + 1))
            }
            _ => false,
        }
    }

    fn bsdf(&mut self, material: &Keys<'_>, place: &str) -> Result<Element, SceneError> {
        Ok(match text(material, "type").unwrap_or_default() {
            "diffuse" => self.with_colour(Element::new("bsdf", "diffuse"), "reflectance", material, "reflectance")?,
            "mirror" => self.with_colour(Element::new("bsdf", "conductor"), "specular_reflectance", material, "reflectance")?,
            "conductor" => self.conductor(material, place)?,
            "glass" | "rough_glass" => self.glass(material, place)?,
            "plastic" => {
                let rough = self.alpha(material).is_some();
                let element = Element::new("bsdf", if rough { "roughplastic" } else { "plastic" });
                let element = element.float("int_ior", number(material, "ior").unwrap_or(1.5)).float("ext_ior", 1.0);
                let element = self.with_colour(element, "diffuse_reflectance", material, "reflectance")?;
                let element = self.with_colour(element, "specular_reflectance", material, "specular_reflectance")?;
                let element = element.boolean("nonlinear", flag(material, "nonlinear") == Some(true));
                if rough { self.facets(element, material, place)? } else { element }
            }
            "principled" => {
                self.approximate("material of type `principled`", place, "Mitsuba's, whose base is no Lambertian one");
                let element = self.with_colour(Element::new("bsdf", "principled"), "base_color", material, "base_color")?;
                if material.contains_key("anisotropy") {
                    self.drop("anisotropy", place, "microfacets are as wide along all directions");
                }
                if material.contains_key("coat_normal_map") {
                    self.drop("coat_normal_map", place, "the coat lies as the rest does");
                } else if material.contains_key("clearcoat")
                    && ["normal_map", "bump_map"].iter().any(|key| material.contains_key(key))
                {
                    self.approximate("coat over a normal or bump map", place, "the map bends the coat too");
                }
                let share = |key: &str, default: f64| number(material, key).unwrap_or(default);
                element
                    .float("metallic", share("metallic", 1.0))
                    .float("roughness", share("roughness", 1.0))
                    .float("spec_trans", share("transmission", 0.0))
                    .float("clearcoat", share("clearcoat", 0.0))
                    .float("eta", share("ior", 1.5).max(1.001))
            }
            "emissive" => Element::new("bsdf", "diffuse").rgb("reflectance", Spectrum::BLACK),
            "pass" => Element::new("bsdf", "null"),
            "blend" => self.blend(material, place)?,
            "layered" => self.layered(material, place)?,
            other => {
                self.drop(&format!("material of type `{other}`"), place, "a diffuse surface stands for it");
                let key = ["diffuse", "albedo"].into_iter().find(|key| material.contains_key(key)).unwrap_or("reflectance");
                self.with_colour(Element::new("bsdf", "diffuse"), "reflectance", material, key)?
            }
        })
    }

    fn conductor(&mut self, material: &Keys<'_>, place: &str) -> Result<Element, SceneError> {
        let rough = self.alpha(material).is_some() || material.contains_key("alpha_u") || material.contains_key("roughness_u");
        let element = Element::new("bsdf", if rough { "roughconductor" } else { "conductor" });
        let preset = text(material, "preset");
        let element = match PRESETS.iter().find(|(ours, _)| Some(*ours) == preset) {
            Some((_, theirs)) => element.string("material", theirs),
            None if material.contains_key("eta") => element.rgb("eta", colour(material, "eta")).rgb("k", colour(material, "k")),
            // A surface that reflects all light does so at every angle.
            None if number(material, "reflectance") == Some(1.0) => element.string("material", "none"),
            None => {
                self.approximate("conductor by its reflectance", place, "its reflectance does not rise at grazing angles");
                self.with_colour(element.string("material", "none"), "specular_reflectance", material, "reflectance")?
            }
        };
        let element = match material.contains_key("reflectance") && number(material, "reflectance") != Some(1.0) {
            true => element,
            false => self.with_colour(element, "specular_reflectance", material, "specular_reflectance")?,
        };
        if rough { self.facets(element, material, place) } else { Ok(element) }
    }

    fn glass(&mut self, material: &Keys<'_>, place: &str) -> Result<Element, SceneError> {
        let thin = flag(material, "thin") == Some(true);
        let rough = text(material, "type") == Some("rough_glass");
        if rough && (thin || material.contains_key("exponent")) {
            self.drop("rough glass that is thin, or Phong's", place, "smooth glass is taken");
        }
        let rough = rough && !thin && !material.contains_key("exponent");
        let kind = match (thin, rough) {
            (true, _) => "thindielectric",
            (false, true) => "roughdielectric",
            (false, false) => "dielectric",
        };
        let ior = number(material, "ior").unwrap_or(1.5);
        let element = Element::new("bsdf", kind).float("int_ior", ior).float("ext_ior", 1.0);
        let element = self.with_colour(element, "specular_reflectance", material, "reflectance")?;
        let element = self.with_colour(element, "specular_transmittance", material, "transmittance")?;
        if rough { self.facets(element, material, place) } else { Ok(element) }
    }

    /// `alpha`, or the square of `roughness`, where they are numbers.
    fn alpha(&self, material: &Keys<'_>) -> Option<Value> {
        let squared = number(material, "roughness").map(|roughness| Value::Float(roughness * roughness));
        material.get("alpha").cloned().or(squared).or_else(|| material.get("roughness").cloned())
    }

    fn facets(&mut self, mut element: Element, material: &Keys<'_>, place: &str) -> Result<Element, SceneError> {
        if text(material, "masking") != Some("separable") {
            self.approximate("height-correlated masking", place, "it is separate there: 1 to 2 % darker at grazing angles");
        }
        element = element.string("distribution", text(material, "distribution").unwrap_or("ggx"));
        let pairs = [("alpha_u", "alpha_v", false), ("roughness_u", "roughness_v", true)];
        for (u, v, squared) in pairs {
            if let (Some(x), Some(y)) = (number(material, u), number(material, v)) {
                let alpha = |value: f64| if squared { value * value } else { value };
                return Ok(element.float("alpha_u", alpha(x)).float("alpha_v", alpha(y)));
            }
        }
        match self.alpha(material) {
            Some(Value::Table(of)) => {
                if material.contains_key("roughness") {
                    self.approximate("texture of roughness", place, "it is taken for its square");
                }
                self.drop_others(&of, &["texture"], place);
                let name = text(&of, "texture").unwrap_or_default().to_owned();
                Ok(element.with(self.texture(&name, "alpha", true)?))
            }
            Some(value) => Ok(element.float("alpha", as_number(&value).unwrap_or(0.0).max(1e-4))),
            None => Ok(element.float("alpha", 1e-4)),
        }
    }

    fn blend(&mut self, material: &Keys<'_>, place: &str) -> Result<Element, SceneError> {
        let parts: Vec<String> = material
            .get("materials")
            .and_then(Value::as_array)
            .map(|parts| parts.iter().filter_map(Value::as_str).map(str::to_owned).collect())
            .unwrap_or_default();
        let weight = table(material, "weight");
        let kind = weight.and_then(|weight| text(weight, "type")).unwrap_or_default();
        let [first, second] = &parts[..] else { return Ok(Element::new("bsdf", "null")) };
        // A share of what is behind is a mask there, and only a mask lets shadow rays through.
        let is_mask = self.named(second).is_some_and(|part| text(part, "type") == Some("pass"));
        if kind == "front" {
            return Ok(Element::new("bsdf", "twosided").reference(first).reference(second));
        }
        let share = if is_mask { "opacity" } else { "weight" };
        // Mitsuba's weight is the second one's share.
        let element = Element::new("bsdf", if is_mask { "mask" } else { "blendbsdf" });
        let element = match (kind, weight) {
            ("constant", Some(weight)) => element.float(share, number(weight, "value").unwrap_or(1.0)),
            ("texture", Some(weight)) => {
                let name = text(weight, "texture").unwrap_or_default().to_owned();
                let channel = text(weight, "channel").map(str::to_owned);
                self.drop_others(weight, &["type", "texture", "channel"], place);
                element.with(self.texture_behind(&name, share, true, "", channel.as_deref())?)
            }
            (other, _) => {
                self.approximate(&format!("weight `{other}` of a blend"), place, "one half of each is taken");
                element.float(share, 0.5)
            }
        };
        Ok(if is_mask { element.reference(first) } else { element.reference(second).reference(first) })
    }

    /// Smooth glass on a diffuse base, with nothing between them, is plastic whose colour deepens.
    fn layered(&mut self, material: &Keys<'_>, place: &str) -> Result<Element, SceneError> {
        let names = material.get("interfaces").and_then(Value::as_array).into_iter().flatten();
        let interfaces: Vec<Table> = names.filter_map(Value::as_str).filter_map(|name| self.named(name)).cloned().collect();
        for key in ["slabs", "model", "mirrored"] {
            let _ = material.contains_key(key);
        }
        let is = |place: usize, kind: &str| interfaces.get(place).is_some_and(|table| text(table, "type") == Some(kind));
        let is_plain = ["slabs", "model"].iter().all(|key| !material.contains_key(key));
        let alike = |table: &Table| {
            ["thin", "reflectance", "transmittance", "thin_film_thickness"].iter().all(|key| !table.contains_key(*key))
        };
        if interfaces.len() == 2 && is(0, "glass") && is(1, "diffuse") && is_plain && alike(&interfaces[0]) {
            let element = Element::new("bsdf", "plastic")
                .float("int_ior", number(&interfaces[0], "ior").unwrap_or(1.5))
                .float("ext_ior", 1.0);
            let element = element.boolean("nonlinear", true);
            return self.with_colour(element, "diffuse_reflectance", &Keys::of(&interfaces[1]), "reflectance");
        }
        self.drop("material of type `layered`", place, "its last interface stands for it");
        match interfaces.last() {
            Some(last) => self.bsdf(&Keys::of(last), place),
            None => Ok(Element::new("bsdf", "null")),
        }
    }

    /// The light of a material; None where it gives none.
    pub fn emission(&mut self, name: &str, place: &str) -> Option<Element> {
        let material = self.named(name)?.clone();
        let is_emissive = text(&material, "type") == Some("emissive");
        let (key, both) = if is_emissive { ("radiance", "two_sided") } else { ("emission", "emission_two_sided") };
        let value = material.get(key)?;
        if flag(&material, both) == Some(true) {
            self.drop("light from both sides", place, "it leaves the front");
        }
        if let Some(of) = value.as_table().filter(|of| of.contains_key("texture")) {
            self.drop_others(of, &["texture"], place);
        }
        let emitter = Element::new("emitter", "area");
        Some(match value.as_table().and_then(|of| text(of, "texture")) {
            Some(texture) => match self.texture(texture, "radiance", false) {
                Ok(texture) => emitter.with(texture),
                Err(_) => emitter.rgb("radiance", Spectrum::WHITE),
            },
            None => emitter.rgb("radiance", colour(&material, key)),
        })
    }

    /// The plugin with a colour, a constant or a texture, where one is written.
    fn with_colour(&mut self, element: Element, theirs: &str, material: &Keys<'_>, ours: &str) -> Result<Element, SceneError> {
        match material.get(ours) {
            None => Ok(element),
            Some(Value::Table(of)) => {
                let place = format!("material `{}`", text(material, "name").unwrap_or_default());
                self.drop_others(of, &["texture"], &place);
                let name = text(of, "texture").unwrap_or_default();
                Ok(element.with(self.texture(name, theirs, false)?))
            }
            Some(_) => Ok(element.rgb(theirs, colour(material, ours))),
        }
    }

    /// The name of a picture of one channel of a texture's; None of a texture that is no image.
    fn picture_of_channel(&mut self, name: &str, channel: &str) -> Option<String> {
        let texture = self.original.textures.iter().find(|texture| texture.name == name)?;
        let TextureKind::Image(image) = &texture.kind else { return None };
        let index = ["r", "g", "b", "a"].iter().position(|own| *own == channel)?;
        let picture = grey_picture(&image.image, &|texel| texel[index]);
        Some(self.files.add_file(&format!("{channel}-of-{}.exr", self.files.len() + 1), picture))
    }

    fn texture(&mut self, name: &str, role: &str, is_number: bool) -> Result<Element, SceneError> {
        self.texture_behind(name, role, is_number, "", None)
    }

    /// A texture whose coordinates are first changed by these steps, or a channel of it as a grey.
    pub fn texture_behind(
        &mut self,
        name: &str,
        role: &str,
        is_number: bool,
        before: &str,
        channel: Option<&str>,
    ) -> Result<Element, SceneError> {
        let found = entries(self.scene, "texture").into_iter().find(|texture| text(*texture, "name") == Some(name));
        let Some(texture) = found.map(Keys::of) else {
            return Err(SceneError::in_file(self.name, format!("there is no texture named `{name}`")));
        };
        let place = format!("texture `{}`", text(&texture, "name").unwrap_or(name));
        let scale = numbers(&texture, "scale").filter(|scale| scale.len() == 2).unwrap_or(vec![1.0, 1.0]);
        let offset = numbers(&texture, "offset").filter(|offset| offset.len() == 2).unwrap_or(vec![0.0, 0.0]);
        let turn = number(&texture, "rotation").map_or(String::new(), |degrees| format!("<rotate z=\"1\" angle=\"{degrees}\"/>"));
        let (u, v, x, y) = (scale[0], scale[1], offset[0], offset[1]);
        let kind = text(&texture, "type").unwrap_or_default();
        let element = match kind {
            "image" => {
                let own = self.file(text(&texture, "file").unwrap_or_default());
                let grey = channel.and_then(|channel| self.picture_of_channel(name, channel));
                let raw = grey.is_some() || text(&texture, "color_space") == Some("linear");
                let _ = text(&texture, "color_space");
                let mut filter = text(&texture, "filter").unwrap_or("bilinear");
                if filter == "triangle" {
                    self.approximate(
                        "colours of vertices",
                        &place,
                        "they are a picture, in which neighbours run into each other",
                    );
                    filter = "bilinear";
                }
                let file = grey.unwrap_or(own);
                // v runs downward over a picture there.
                let steps = format!(
                    "{before}<scale x=\"{u}\" y=\"{v}\"/>{turn}<translate x=\"{x}\" y=\"{y}\"/><scale y=\"-1\"/><translate y=\"1\"/>"
                );
                Element::new("texture", "bitmap")
                    .named(role)
                    .string("filename", &file)
                    .boolean("raw", raw)
                    .string("filter_type", filter)
                    .string("wrap_mode", text(&texture, "wrap").unwrap_or("repeat"))
                    .transform("to_uv", &steps)
            }
            "checker" => {
                // Two squares along each unit there.
                let steps = format!(
                    "{before}<scale x=\"{u}\" y=\"{v}\"/>{turn}<translate x=\"{x}\" y=\"{y}\"/><scale x=\"0.5\" y=\"0.5\"/>"
                );
                // Fields of numbers lie the other way round there.
                let (first, second) = if is_number { ("color1", "color0") } else { ("color0", "color1") };
                Element::new("texture", "checkerboard")
                    .named(role)
                    .rgb(first, colour(&texture, "a"))
                    .rgb(second, colour(&texture, "b"))
                    .transform("to_uv", &steps)
            }
            other => {
                self.drop(&format!("texture of type `{other}`"), &place, "the mean of its colours is taken");
                let mean = 0.5 * (colour(&texture, "a") + colour(&texture, "b"));
                Element::new("texture", "checkerboard").named(role).rgb("color0", mean).rgb("color1", mean)
            }
        };
        if matches!(kind, "image" | "checker") {
            self.drop_rest(&texture, &place);
        }
        Ok(element)
    }
}
