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

use self::keyed::{Keyed, NestedBsdfs, black, grey, nothing};
use super::converter::Converter;
use super::plugin::Plugin;
use crate::load::error::SceneError;
use crate::load::file::colour::Colour;
use crate::load::file::material::blend_weight::BlendWeightEntry;
use crate::load::file::material::{MaterialEntry, blend, diffuse as diffuse_entry};
use crate::load::import::{Input, Relief};
use crate::load::place::Place;
use crate::spectrum::Spectrum;

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
            None if self.is_bare_boundary(shape) => self.bare_boundary(&shape.at()),
            None => shape.possible(self.default_bsdf(light.is_some(), &shape.at()))?,
        };
        let plain = self.name_of(made);
        let Some(light) = light else { return Ok(plain) };
        if light.constant().is_some_and(|radiance| radiance.max_component() == 0.0) {
            return Ok(plain);
        }
        let place = shape.at();
        let mut entry = self.scene.file.material[made].clone();
        if matches!(entry, MaterialEntry::Pass(_)) {
            // An emitting null surface lets all light through, and adds its own.
            let black = self.extra(shape, "black", black());
            let through = shape.possible(BlendWeightEntry::constant(1.0))?;
            entry = MaterialEntry::from(blend::Keys::of([plain.clone(), black], through, &place));
        }
        let common = entry.common_mut();
        *common.name = place.at(String::new());
        *common.emission = Some(place.at(shape.possible(light.colour(&place))?));
        // Surfaces with equal scattering and emission share one material.
        let key = format!("{entry:?}");
        if let Some(known) = self.emissive_materials.get(&key) {
            return Ok(known.clone());
        }
        let wanted = if shape.id.is_empty() { format!("{plain}, giving light") } else { shape.id.clone() };
        let name = self.scene.free_material_name(&wanted);
        *entry.common_mut().name = place.at(name.clone());
        self.scene.file.material.push(entry);
        self.emissive_materials.insert(key, name.clone());
        Ok(name)
    }

    /// Mitsuba's surface without a BSDF is a grey diffuse one, and black where it gives light.
    fn default_bsdf(&mut self, is_emitter: bool, place: &Place) -> Result<usize, String> {
        if let Some(known) = self.default_materials[usize::from(is_emitter)] {
            return Ok(known);
        }
        let (name, reflectance) = if is_emitter { ("(no bsdf, a lamp)", 0.0) } else { ("(no bsdf)", 0.5) };
        let name = place.at(self.scene.free_material_name(name));
        let (reflectance, two_sided) = (Colour::constant(Spectrum::grey(reflectance))?, Some(place.at(false)));
        let keys = diffuse_entry::Keys { name, reflectance, two_sided, ..Default::default() };
        self.scene.file.material.push(MaterialEntry::from(keys));
        let made = self.scene.file.material.len() - 1;
        self.default_materials[usize::from(is_emitter)] = Some(made);
        Ok(made)
    }

    /// The boundary of a medium, which is not there itself.
    fn bare_boundary(&mut self, place: &Place) -> usize {
        if let Some(known) = self.default_materials[2] {
            return known;
        }
        let mut entry = nothing();
        *entry.common_mut().name = place.at(self.scene.free_material_name("(no bsdf, a boundary)"));
        self.scene.file.material.push(entry);
        let made = self.scene.file.material.len() - 1;
        self.default_materials[2] = Some(made);
        made
    }

    /// The material of a BSDF, made once.
    fn bsdf(&mut self, plugin: &Rc<Plugin>, depth: usize) -> Result<usize, SceneError> {
        let key = (Rc::as_ptr(plugin), self.both_sides, self.attributes.as_ref().map(|(mesh, _)| *mesh));
        if let Some(made) = self.materials.get(&key) {
            return Ok(*made);
        }
        let (mut entry, two_sided) = self.bsdf_entry(plugin, depth)?;
        if !two_sided {
            self.make_sided(&mut entry, plugin);
        }
        let wanted = if plugin.id.is_empty() { plugin.name.clone() } else { plugin.id.clone() };
        *entry.common_mut().name = plugin.at().at(self.scene.free_material_name(&wanted));
        self.scene.file.material.push(entry);
        let made = self.scene.file.material.len() - 1;
        self.materials.insert(key, made);
        Ok(made)
    }

    fn bsdf_entry(&mut self, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
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
            "dielectric" | "roughdielectric" | "thindielectric" => dielectric::dielectric(self, plugin),
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
            "null" => Ok((nothing(), true)),
            other => {
                for property in &plugin.properties {
                    property.used.set(true);
                }
                plugin.children.iter().for_each(|child| child.used.set(true));
                let what = format!("bsdf `{other}`");
                self.drop(plugin, &what, "a diffuse grey of 0.5 stands for it");
                Ok((plugin.possible(grey(0.5))?, true))
            }
        }
    }

    /// A BSDF within another one.
    fn within(&mut self, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
        let within = plugin.first_of("bsdf").cloned();
        let within = within.ok_or_else(|| plugin.error(format!("{} needs a bsdf within", plugin.title())))?;
        self.bsdf_entry(&within, depth + 1)
    }

    /// Lets a material reflect on its front alone. A blend leaves that to its parts.
    fn make_sided(&self, entry: &mut MaterialEntry, plugin: &Plugin) {
        let is_whole = matches!(
            entry,
            MaterialEntry::Blend(_)
                | MaterialEntry::Pass(_)
                | MaterialEntry::Emissive(_)
                | MaterialEntry::Glass(_)
                | MaterialEntry::RoughGlass(_)
        );
        if !self.both_sides && !is_whole {
            *entry.common_mut().two_sided = Some(plugin.at().at(false));
        }
    }

    /// All BSDFs within another one, whose normals are its own.
    fn parts(&mut self, plugin: &Rc<Plugin>, depth: usize) -> Result<NestedBsdfs, SceneError> {
        let within: Vec<Rc<Plugin>> = plugin.children_of("bsdf").into_iter().cloned().collect();
        let mut parts = NestedBsdfs::default();
        let mut maps = Vec::new();
        for part in &within {
            let made = self.bsdf(part, depth + 1)?;
            let mut entry = self.scene.file.material[made].clone();
            let relief = Relief::take(&mut entry);
            let name = self.name_of(made);
            parts.names.push(match relief.is_none() {
                true => name,
                false => self.extra(part, &format!("{name}, as it lies"), entry),
            });
            maps.push(relief);
        }
        match &maps[..] {
            [first, rest @ ..] if rest.iter().all(|map| map == first) => parts.relief = first.clone(),
            _ => {}
        }
        if parts.relief.is_none() && maps.iter().any(|map| !map.is_none()) {
            self.drop(plugin, "map of normals or heights of one part of a blend", "the part lies as the surface does");
        }
        Ok(parts)
    }

    fn name_of(&self, made: usize) -> String {
        self.scene.file.material[made].name().to_owned()
    }

    /// A material beside the plugin's own; its name.
    fn extra(&mut self, plugin: &Plugin, wanted: &str, mut entry: MaterialEntry) -> String {
        self.make_sided(&mut entry, plugin);
        let name = self.scene.free_material_name(wanted);
        *entry.common_mut().name = plugin.at().at(name.clone());
        self.scene.file.material.push(entry);
        name
    }
}
