//! Materials: a module for each kind, and `variant` for what shapes add to them.

mod coated;
mod glass;
mod metal;
mod mixture;
mod subsurface;
mod variant;

use std::rc::Rc;

use super::converter::{Converter, MaterialLooks};
use super::directives::unknown;
use super::graphics_state::MaterialName;
use super::parameter::Entity;
use super::spectrum::SpectrumKind;
use super::text::Spot;
use super::texture_entry::Use;
use super::texture_node::TextureNode;
use crate::load::error::SceneError;
use crate::load::file::colour::{Colour, Scalar};
use crate::load::file::material::{MaterialEntry, diffuse, diffuse_transmission, pass};
use crate::load::file::reference::TextureName;
use crate::load::file::syntax::ColorSpaceEntry;
use crate::load::file::value::{Fraction, Located};
use crate::load::import::Input;
use crate::spectrum::Spectrum;

/// Most materials within each other.
const DEEPEST: usize = 32;
/// Widths of microfacets below this are those of a smooth surface there.
const SMOOTH: f64 = 1e-3;

/// The widths of microfacets: the same in all directions, or along and across the texture coordinate u. None of a smooth surface.
#[derive(Default)]
struct Widths {
    alpha: Option<Located<Scalar<Fraction>>>,
    alpha_u: Option<Located<Scalar<Fraction>>>,
    alpha_v: Option<Located<Scalar<Fraction>>>,
}

impl Widths {
    fn are_smooth(&self) -> bool {
        self.alpha.is_none() && self.alpha_u.is_none()
    }
}

impl Converter<'_> {
    /// The name of a material, which is made once.
    pub fn material(&mut self, name: &MaterialName, spot: &Spot) -> Result<String, SceneError> {
        if let Some(known) = self.materials.get(name) {
            return Ok(known.clone());
        }
        let world = self.world.clone();
        let (entity, wanted) = match name {
            MaterialName::Written(number) => {
                let entity = &world.materials[*number];
                (entity, if entity.name.is_empty() { "interface".to_owned() } else { entity.name.clone() })
            }
            MaterialName::Named(name) => {
                let known = world.named_materials.get(name);
                (known.ok_or_else(|| unknown("material", name, spot, world.named_materials.keys()))?, name.clone())
            }
        };
        if self.materials_within.contains(name) {
            return Err(entity.error(format!("the material `{wanted}` lies within itself")));
        }
        if self.materials_within.len() >= DEEPEST {
            return Err(entity.error(format!("materials lie more than {DEEPEST} deep within each other")));
        }
        self.materials_within.push(name.clone());
        let made = self.material_entry(entity, &wanted)?;
        self.materials_within.pop();
        let made = self.add_material(&entity.spot, &wanted, made);
        self.report_unused(entity);
        self.materials.insert(name.clone(), made.clone());
        Ok(made)
    }

    fn material_entry(&mut self, entity: &Rc<Entity>, wanted: &str) -> Result<MaterialEntry, SceneError> {
        let mut entry = match entity.name.as_str() {
            "diffuse" => self.diffuse(entity, 0.5)?,
            "coateddiffuse" => self.coated_diffuse(entity, wanted)?,
            "coatedconductor" => self.coated_metal(entity, wanted)?,
            "conductor" => self.metal(entity)?,
            "dielectric" => self.glass(entity)?,
            "thindielectric" => self.thin_glass(entity)?,
            "diffusetransmission" => self.diffuse_transmission(entity)?,
            "subsurface" => self.subsurface(entity, wanted)?,
            // A mixture's parts have maps of their own.
            "mix" => return self.mixture(entity),
            "interface" | "none" | "" => return Ok(MaterialEntry::from(pass::Keys::default())),
            other => {
                entity.all_without_effect();
                let what = format!("Material `{other}`");
                if ["measured", "hair"].contains(&other) {
                    self.drop(&entity.spot, what, "a diffuse grey of 0.5 stands for it");
                } else {
                    let instead = "a diffuse grey of 0.5 stands for it; version 4 has no material of this name";
                    self.drop(&entity.spot, what, instead);
                }
                return self.grey(entity, 0.5);
            }
        };
        self.bend(entity, &mut entry)?;
        Ok(entry)
    }

    fn grey(&mut self, entity: &Entity, value: f64) -> Result<MaterialEntry, SceneError> {
        let reflectance = entity.possible(Colour::constant(Spectrum::grey(value)))?;
        Ok(MaterialEntry::from(diffuse::Keys { reflectance, ..Default::default() }))
    }

    fn diffuse(&mut self, entity: &Entity, default: f64) -> Result<MaterialEntry, SceneError> {
        let reflectance = self.albedo(entity, "reflectance", default)?;
        let reflectance = entity.possible(reflectance.colour(&entity.spot.place()))?;
        Ok(MaterialEntry::from(diffuse::Keys { reflectance, ..Default::default() }))
    }

    fn diffuse_transmission(&mut self, entity: &Entity) -> Result<MaterialEntry, SceneError> {
        let scale = entity.float_or("scale", 1.0)?;
        let mut shares = [self.albedo(entity, "reflectance", 0.25)?, self.albedo(entity, "transmittance", 0.25)?];
        for share in &mut shares {
            *share = match std::mem::replace(share, Input::grey(0.0)) {
                Input::Constant(colour) => Input::Constant((colour * scale).clamp(Spectrum::BLACK, Spectrum::WHITE)),
                Input::Texture(name, factor) => Input::Texture(name, factor * scale.clamp(0.0, 1.0)),
            };
        }
        if let [Input::Constant(up), Input::Constant(down)] = shares
            && (up + down).max_component() > 1.0
        {
            self.approximate(&entity.spot, "reflectance and transmittance above 1 together", "their sum is 1");
            let most = (up + down).map(|sum| sum.max(1.0));
            shares = [Input::Constant(up / most), Input::Constant(down / most)];
        }
        let place = entity.spot.place();
        let [reflectance, transmittance] = shares.map(|share| share.colour(&place));
        let (reflectance, transmittance) = (entity.possible(reflectance)?, entity.possible(transmittance)?);
        Ok(MaterialEntry::from(diffuse_transmission::Keys { reflectance, transmittance, ..Default::default() }))
    }

    /// A share of light.
    fn albedo(&mut self, entity: &Entity, name: &str, default: f64) -> Result<Input, SceneError> {
        let node = self.spectrum_node(entity, name, SpectrumKind::Albedo)?;
        let node = node.unwrap_or_else(|| TextureNode::constant(Spectrum::grey(default)));
        self.input(&node, Use::Albedo, entity.spot_of(name))
    }

    /// The widths of microfacets by `roughness`, or `uroughness` and `vroughness`, behind a prefix.
    fn widths(&mut self, entity: &Entity, prefix: &str) -> Result<Widths, SceneError> {
        let remaps = entity.flag_or("remaproughness", true)?;
        let used = if remaps { Use::Root } else { Use::Share };
        let both = self.float_node(entity, &format!("{prefix}roughness"))?;
        let mut width = |name: &str| -> Result<Input, SceneError> {
            let name = format!("{prefix}{name}");
            let node = self.float_node(entity, &name)?.or_else(|| both.clone());
            let node = node.unwrap_or_else(|| TextureNode::constant(Spectrum::BLACK));
            if node.as_constant().is_some_and(|value| value.r() < 0.0) {
                return Err(entity.spot_of(&name).error(format!("`{name}` is below 0")));
            }
            self.input(&node, used, entity.spot_of(&name))
        };
        let (along, across) = (width("uroughness")?, width("vroughness")?);
        let is_smooth = |input: &Input| input.constant().is_some_and(|width| width.r() < SMOOTH);
        if is_smooth(&along) && is_smooth(&across) {
            return Ok(Widths::default());
        }
        let place = entity.spot.place();
        let scalar = |input: &Input| entity.possible(input.scalar(&place)).map(|alpha| Some(place.at(alpha)));
        if along == across {
            return Ok(Widths { alpha: scalar(&along)?, ..Widths::default() });
        }
        Ok(Widths { alpha: None, alpha_u: scalar(&along)?, alpha_v: scalar(&across)? })
    }

    /// A number for which there can be no texture here: the mean of one is taken, and reported.
    fn plain_number(&mut self, entity: &Entity, name: &str, default: f64) -> Result<f64, SceneError> {
        let Some(node) = self.float_node(entity, name)? else { return Ok(default) };
        if node.as_constant().is_none() {
            let what = format!("texture of `{name}` of {}", entity.title());
            self.approximate(entity.spot_of(name), what, "its mean is taken");
        }
        Ok(self.mean_of(&node).mean())
    }

    /// A colour for which there can be no texture here.
    fn plain_colour(&mut self, entity: &Entity, name: &str, kind: SpectrumKind) -> Result<Option<Spectrum>, SceneError> {
        let Some(node) = self.spectrum_node(entity, name, kind)? else { return Ok(None) };
        if node.as_constant().is_none() {
            let what = format!("texture of `{name}` of {}", entity.title());
            self.approximate(entity.spot_of(name), what, "its mean is taken");
        }
        Ok(Some(self.mean_of(&node)))
    }

    /// Gives a material the map that bends its normals.
    fn bend(&mut self, entity: &Entity, entry: &mut MaterialEntry) -> Result<(), SceneError> {
        let place = entity.spot.place();
        if let Some(written) = entity.text("normalmap")?.map(str::to_owned) {
            let spot = entity.spot_of("normalmap");
            let found = self.files.find(&self.folder, &written);
            let path = found.ok_or_else(|| spot.error(format!("there is no file {written}")))?.path;
            let input = self.plain_picture(&path, spot, |entry| entry.color_space = Some(ColorSpaceEntry::Linear));
            if let Input::Texture(name, _) = input {
                *entry.common_mut().normal_map = Some(place.at(TextureName(name)));
            }
        }
        if let Some(node) = self.float_node(entity, "displacement")? {
            let spot = entity.spot_of("displacement");
            if entry.common().normal_map.is_some() {
                self.drop(spot, "displacement beside a normal map", "the normal map counts");
            } else if let Input::Texture(name, _) = self.input(&node, Use::Heights, spot)? {
                let is_picture = self.scene.file.texture.iter().rev().find(|entry| entry.name() == name);
                if is_picture.is_some_and(|entry| matches!(entry, crate::load::file::syntax::TextureEntry::Image(_))) {
                    *entry.common_mut().bump_map = Some(place.at(TextureName(name)));
                } else {
                    self.drop(spot, "displacement by a checkerboard", "it has steps and no slopes, and bends no normals");
                }
            }
        }
        Ok(())
    }

    /// Adds a material to the description; its name.
    fn add_material(&mut self, spot: &Spot, wanted: &str, mut entry: MaterialEntry) -> String {
        let name = self.scene.free_material_name(wanted);
        *entry.common_mut().name = spot.place().at(name.clone());
        self.looks.insert(name.clone(), self.looks_of(&entry));
        self.scene.file.material.push(entry);
        name
    }

    fn looks_of(&self, entry: &MaterialEntry) -> MaterialLooks {
        let mut is_textured = match entry {
            MaterialEntry::Conductor(keys) => keys.alpha_u.is_some(),
            MaterialEntry::RoughGlass(keys) => keys.alpha_u.is_some(),
            _ => false,
        };
        entry.clone().each_texture(&mut |_| is_textured = true);
        let common = entry.common();
        let own = MaterialLooks {
            is_textured,
            is_bent: common.normal_map.is_some() || common.bump_map.is_some(),
            is_nothing: matches!(entry, MaterialEntry::Pass(_)),
            tells_sides: match entry {
                MaterialEntry::Glass(keys) => !keys.thin,
                MaterialEntry::RoughGlass(_) => true,
                _ => false,
            },
        };
        // A stack looks alike from both sides.
        let is_blend = matches!(entry, MaterialEntry::Blend(_));
        let parts = entry.parts().iter().filter_map(|part| self.looks.get(&part.value));
        parts.fold(own, |all, part| MaterialLooks {
            is_textured: all.is_textured || part.is_textured,
            is_bent: all.is_bent || part.is_bent,
            tells_sides: all.tells_sides || is_blend && part.tells_sides,
            ..all
        })
    }

    /// The entry of a material that was made.
    fn entry_of(&self, name: &str) -> Option<&MaterialEntry> {
        // The one made last is asked for first.
        self.scene.file.material.iter().rev().find(|entry| entry.name() == name)
    }
}
