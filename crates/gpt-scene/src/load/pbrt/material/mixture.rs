//! Mixtures of two materials.

use std::rc::Rc;

use crate::load::error::SceneError;
use crate::load::file::material::{MaterialEntry, blend};
use crate::load::import::Relief;
use crate::load::pbrt::converter::Converter;
use crate::load::pbrt::graphics_state::MaterialName;
use crate::load::pbrt::parameter::{Entity, Kind};
use crate::load::pbrt::texture_entry::Use;
use crate::load::pbrt::texture_node::TextureNode;
use crate::spectrum::Spectrum;

impl Converter<'_> {
    /// The second one by `amount`, the first by the rest.
    pub(super) fn mixture(&mut self, entity: &Rc<Entity>) -> Result<MaterialEntry, SceneError> {
        let names = entity.find("materials", &[Kind::Text]).map(|parameter| parameter.texts().to_vec()).unwrap_or_default();
        let [first, second] = &names[..] else {
            return Err(entity.error("a mix needs \"string materials\" with the names of two materials"));
        };
        let spot = entity.spot_of("materials").clone();
        let first = self.material(&MaterialName::Named(first.clone()), &spot)?;
        let second = self.material(&MaterialName::Named(second.clone()), &spot)?;
        let (parts, relief) = self.parts([first, second], entity)?;
        let amount = self.float_node(entity, "amount")?.unwrap_or_else(|| TextureNode::constant(Spectrum::grey(0.5)));
        let share = self.input(&amount, Use::Share, entity.spot_of("amount"))?;
        let place = entity.spot.place();
        let weight = entity.possible(share.weight(&place))?;
        let [first, second] = parts;
        Ok(relief.given_to(MaterialEntry::from(blend::Keys::of([second, first], weight, &place))))
    }

    /// Parts of a blend without the maps that bend their normals, which the blend has where they are the same.
    pub(super) fn parts(&mut self, names: [String; 2], entity: &Entity) -> Result<([String; 2], Relief), SceneError> {
        let mut reliefs = Vec::new();
        let mut flat = names.clone();
        for name in &mut flat {
            let Some(mut entry) = self.entry_of(name).cloned() else { continue };
            let relief = Relief::take(&mut entry);
            if !relief.is_none() {
                let key = format!("(flat) {name}");
                *name = match self.variants.get(&key) {
                    Some(known) => known.clone(),
                    None => {
                        let made = self.add_material(&entity.spot, &format!("{name}, as it lies"), entry);
                        self.variants.insert(key, made.clone());
                        made
                    }
                };
            }
            reliefs.push(relief);
        }
        let relief = match &reliefs[..] {
            [first, rest @ ..] if rest.iter().all(|other| other == first) => first.clone(),
            _ => Relief::default(),
        };
        if relief.is_none() && reliefs.iter().any(|relief| !relief.is_none()) {
            let what = "map of normals or heights of one part of a mixture";
            self.drop(&entity.spot, what, "the part lies as the surface does");
        }
        Ok((flat, relief))
    }
}
