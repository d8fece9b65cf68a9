//! BSDFs: a module for each kind of plugin.

mod conductor;
mod dielectric;
mod diffuse;
mod keyed;
mod old;
mod plastic;
mod principled;
mod wrapped;

use std::rc::Rc;

use self::keyed::{Keyed, Parts, without_relief};
use super::converter::Converter;
use super::input::Input;
use super::plugin::Plugin;
use crate::load::error::SceneError;
use crate::load::import::{Entry, Keys, Value};

/// Most BSDFs within each other.
const DEEPEST: usize = 32;

impl Converter<'_> {
    /// The name of the material of a shape with this BSDF that gives this light.
    pub fn surface_material(
        &mut self,
        shape: &Rc<Plugin>,
        bsdf: Option<&Rc<Plugin>>,
        light: Option<Input>,
    ) -> Result<String, SceneError> {
        let made = match bsdf {
            Some(bsdf) => self.bsdf(bsdf, 0)?,
            None => self.default_bsdf(light.is_some()),
        };
        let entry = &self.scene.materials[made];
        let plain = entry.keys.text("name").unwrap_or_default().to_owned();
        let Some(light) = light else { return Ok(plain) };
        let mut keys = entry.keys.clone();
        if light.constant().is_some_and(|radiance| radiance.max_element() == 0.0) {
            return Ok(plain);
        }
        if keys.text("type") == Some("pass") {
            // It lets all light through, and adds its own.
            let black = self.extra(shape, "black", Keys::of_type("diffuse").with("reflectance", 0.0));
            let through = Keys::of_type("constant").with("value", 1.0);
            keys = Keys::new().with("name", "").with("type", "blend").with("materials", vec![Value::Text(plain.clone()), black]);
            keys = keys.with("weight", through).with("emission", light.value());
        } else {
            keys.set("emission", light.value());
        }
        // The same surface with the same light is one material.
        let key = format!("{:?}", keys.0.iter().filter(|(key, _)| *key != "name").collect::<Vec<_>>());
        if let Some(known) = self.lamps.get(&key) {
            return Ok(known.clone());
        }
        let wanted = if shape.id.is_empty() { format!("{plain}, giving light") } else { shape.id.clone() };
        let name = self.scene.free_material_name(&wanted);
        keys.set("name", name.as_str());
        self.scene.materials.push(Entry { place: shape.place.clone(), keys });
        self.lamps.insert(key, name.clone());
        Ok(name)
    }

    /// Mitsuba's surface without a BSDF is a grey diffuse one, and black where it gives light.
    fn default_bsdf(&mut self, is_lamp: bool) -> usize {
        let known = self.default_materials[usize::from(is_lamp)];
        let material = known.unwrap_or_else(|| {
            let (name, reflectance) = if is_lamp { ("(no bsdf, a lamp)", 0.0) } else { ("(no bsdf)", 0.5) };
            let name = self.scene.free_material_name(name);
            let keys = Keys::new().with("name", name).with("type", "diffuse").with("reflectance", reflectance);
            self.scene.materials.push(Entry { keys: keys.with("two_sided", false), ..Entry::default() });
            self.scene.materials.len() - 1
        });
        self.default_materials[usize::from(is_lamp)] = Some(material);
        material
    }

    /// The material of a BSDF, made once.
    fn bsdf(&mut self, plugin: &Rc<Plugin>, depth: usize) -> Result<usize, SceneError> {
        let key = (Rc::as_ptr(plugin), self.both_sides, self.attributes.as_ref().map(|(mesh, _)| *mesh));
        if let Some(made) = self.materials.get(&key) {
            return Ok(*made);
        }
        let (keys, two_sided) = self.bsdf_keys(plugin, depth)?;
        let keys = if two_sided { keys } else { self.sided(keys) };
        let wanted = if plugin.id.is_empty() { plugin.name.clone() } else { plugin.id.clone() };
        let name = self.scene.free_material_name(&wanted);
        let mut named = Keys::new().with("name", name);
        named.0.extend(keys.0.into_iter().filter(|(key, _)| *key != "name"));
        self.scene.materials.push(Entry { place: plugin.place.clone(), keys: named });
        let made = self.scene.materials.len() - 1;
        self.materials.insert(key, made);
        Ok(made)
    }

    fn bsdf_keys(&mut self, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
        if depth > DEEPEST {
            return Err(plugin.error(format!("BSDFs lie more than {DEEPEST} deep within each other")));
        }
        plugin.visited.set(true);
        plugin.without_effect(&["id"]);
        match plugin.name.as_str() {
            "diffuse" | "lambertian" => diffuse::diffuse(self, plugin),
            "roughdiffuse" => diffuse::rough(self, plugin),
            "difftrans" => diffuse::transmitting(self, plugin),
            "conductor" | "roughconductor" | "mirror" => conductor::conductor(self, plugin),
            "dielectric" | "roughdielectric" => dielectric::dielectric(self, plugin),
            "thindielectric" => dielectric::thin(self, plugin),
            "plastic" | "roughplastic" => plastic::plastic(self, plugin),
            "principled" | "principledthin" | "disney" => principled::principled(self, plugin),
            "phong" | "ward" => old::phong(self, plugin),
            "coating" | "roughcoating" => old::coating(self, plugin, depth),
            "twosided" => wrapped::two_sided(self, plugin, depth),
            "mask" | "opacity" => wrapped::mask(self, plugin, depth),
            "bumpmap" | "bump" => wrapped::bump_map(self, plugin, depth),
            "normalmap" => wrapped::normal_map(self, plugin, depth),
            "blendbsdf" => wrapped::blend(self, plugin, depth),
            "mixturebsdf" => wrapped::mixture(self, plugin, depth),
            "null" => Ok((Keys::of_type("pass"), true)),
            other => {
                for property in &plugin.properties {
                    property.used.set(true);
                }
                plugin.children.iter().for_each(|child| child.used.set(true));
                let what = format!("bsdf `{other}`");
                self.drop(plugin, &what, "a diffuse grey of 0.5 stands for it");
                Ok((Keys::of_type("diffuse").with("reflectance", 0.5), true))
            }
        }
    }

    /// The keys of a BSDF within another one.
    fn within(&mut self, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
        let within = plugin.first_of("bsdf").cloned();
        let within = within.ok_or_else(|| plugin.error(format!("{} needs a bsdf within", plugin.title())))?;
        self.bsdf_keys(&within, depth + 1)
    }

    /// One that reflects on its front alone. A blend leaves that to its parts.
    fn sided(&self, keys: Keys) -> Keys {
        let is_whole = matches!(keys.text("type"), Some("blend" | "pass" | "emissive" | "glass" | "rough_glass"));
        if self.both_sides || is_whole { keys } else { keys.with("two_sided", false) }
    }

    /// All BSDFs within another one, whose normals are its own.
    fn parts(&mut self, plugin: &Rc<Plugin>, depth: usize) -> Result<Parts, SceneError> {
        let within: Vec<Rc<Plugin>> = plugin.children_of("bsdf").into_iter().cloned().collect();
        let mut parts = Parts::default();
        let mut maps = Vec::new();
        for part in &within {
            let made = self.bsdf(part, depth + 1)?;
            let (relief, others) = without_relief(self.scene.materials[made].keys.clone());
            let name = self.name_of(made);
            parts.names.push(match relief.is_empty() {
                true => Value::Text(name),
                false => self.extra(part, &format!("{name}, as it lies"), others),
            });
            maps.push(relief);
        }
        match &maps[..] {
            [first, rest @ ..] if rest.iter().all(|map| map == first) => parts.relief = first.clone(),
            _ => {}
        }
        if parts.relief.is_empty() && maps.iter().any(|map| !map.is_empty()) {
            self.drop(plugin, "map of normals or heights of one part of a blend", "the part lies as the surface does");
        }
        Ok(parts)
    }

    fn name_of(&self, made: usize) -> String {
        self.scene.materials[made].keys.text("name").unwrap_or_default().to_owned()
    }

    /// A material beside the plugin's own.
    fn extra(&mut self, plugin: &Plugin, wanted: &str, keys: Keys) -> Value {
        let keys = self.sided(keys);
        let name = self.scene.free_material_name(wanted);
        let mut named = Keys::new().with("name", name.as_str());
        named.0.extend(keys.0);
        self.scene.materials.push(Entry { place: plugin.place.clone(), keys: named });
        Value::Text(name)
    }
}
