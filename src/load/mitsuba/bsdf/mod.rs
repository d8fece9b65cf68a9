//! BSDFs: a module for each kind of plugin.

mod conductor;
mod dielectric;
mod diffuse;
mod old;
mod plastic;
mod principled;
mod wrapped;

use std::rc::Rc;

use super::Converter;
use super::plugin::Plugin;
use super::texture::Input;
use crate::load::error::SceneError;
use crate::load::import::{Entry, Keys, Value};

/// Most BSDFs within each other.
const DEEPEST: usize = 32;

/// What a BSDF became.
#[derive(Debug, Clone)]
pub struct Made {
    /// Index into [`Description::materials`].
    pub material: usize,
    /// It reflects or transmits on both sides, so that it is rendered as it is meant.
    pub two_sided: bool,
}

/// Keys of a material and whether both sides count.
type Keyed = (Keys, bool);

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
            None => self.default_bsdf(),
        };
        if !made.two_sided {
            let title = bsdf.map_or("no bsdf".to_owned(), |bsdf| bsdf.title());
            let what = format!("one-sided {title}");
            self.approximate(shape, &what, "it reflects on both sides");
        }
        let entry = &self.scene.materials[made.material];
        let plain = entry.keys.text("name").unwrap_or_default().to_owned();
        let Some(light) = light else { return Ok(plain) };
        let mut keys = entry.keys.clone();
        if light.constant().is_some_and(|radiance| radiance.max_element() == 0.0) {
            return Ok(plain);
        }
        if keys.text("type") == Some("pass") {
            self.approximate(shape, "light of a shape that is not there (`null`)", "the shape stops light");
            keys = Keys::new().with("name", "").with("type", "emissive").with("radiance", light.value());
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

    /// Mitsuba's surface without a BSDF is a grey diffuse one.
    fn default_bsdf(&mut self) -> Made {
        const NAME: &str = "(no bsdf)";
        let known = self.default_material;
        let material = known.unwrap_or_else(|| {
            let keys = Keys::new().with("name", NAME).with("type", "diffuse").with("reflectance", 0.5);
            self.scene.free_material_name(NAME);
            self.scene.materials.push(Entry { keys, ..Entry::default() });
            self.scene.materials.len() - 1
        });
        self.default_material = Some(material);
        Made { material, two_sided: false }
    }

    /// The material of a BSDF, made once.
    fn bsdf(&mut self, plugin: &Rc<Plugin>, depth: usize) -> Result<Made, SceneError> {
        if let Some(made) = self.materials.get(&Rc::as_ptr(plugin)) {
            return Ok(made.clone());
        }
        let (keys, two_sided) = self.bsdf_keys(plugin, depth)?;
        let wanted = if plugin.id.is_empty() { plugin.name.clone() } else { plugin.id.clone() };
        let name = self.scene.free_material_name(&wanted);
        let mut named = Keys::new().with("name", name);
        named.0.extend(keys.0.into_iter().filter(|(key, _)| *key != "name"));
        self.scene.materials.push(Entry { place: plugin.place.clone(), keys: named });
        let made = Made { material: self.scene.materials.len() - 1, two_sided };
        self.materials.insert(Rc::as_ptr(plugin), made.clone());
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

    /// The names of all BSDFs within another one.
    fn names_within(&mut self, plugin: &Rc<Plugin>, depth: usize) -> Result<Vec<(String, bool)>, SceneError> {
        let within: Vec<Rc<Plugin>> = plugin.children_of("bsdf").into_iter().cloned().collect();
        within.iter().map(|plugin| self.bsdf(plugin, depth + 1).map(|made| (self.name_of(&made), made.two_sided))).collect()
    }

    fn name_of(&self, made: &Made) -> String {
        self.scene.materials[made.material].keys.text("name").unwrap_or_default().to_owned()
    }

    /// A material beside the plugin's own.
    fn extra(&mut self, plugin: &Plugin, wanted: &str, keys: Keys) -> Value {
        let name = self.scene.free_material_name(wanted);
        let mut named = Keys::new().with("name", name.as_str());
        named.0.extend(keys.0);
        self.scene.materials.push(Entry { place: plugin.place.clone(), keys: named });
        Value::Text(name)
    }
}
