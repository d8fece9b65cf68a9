//! `[[medium]]`, and what materials enclose.

use crate::load::error::SceneError;
use crate::load::file::material::MaterialEntry;
use crate::load::file::medium::MediumEntry;
use crate::load::file::resolver::Resolver;
use crate::scene::{Material, MaterialKind};

impl Resolver<'_> {
    pub(super) fn media(&mut self, written: &[MediumEntry]) -> Result<(), SceneError> {
        self.medium_names = self.register("medium", written.iter().map(|entry| &entry.name))?;
        for entry in written {
            let medium = entry.resolve(self);
            let medium = self.note(medium);
            let group =
                self.light_group_of(entry.light_group.as_ref(), entry.emission.is_some(), "this medium has no `emission`");
            let group = self.note(group).unwrap_or(0);
            self.scene.light_groups.put_medium(self.scene.media.len(), group);
            let receiver = self.receiver(entry.receiver.as_ref());
            let receiver = self.note(receiver).unwrap_or(0);
            self.scene.light_links.put_medium(self.scene.media.len(), receiver);
            self.scene.media.extend(medium);
        }
        // A medium that is wrong has no number, so that names behind it would mean others.
        if self.errors.is_empty() { Ok(()) } else { Err(self.errors.remove(0)) }
    }

    /// The material with the medium that its entry names.
    pub(super) fn with_interior(&self, mut material: Material, entry: &MaterialEntry) -> Result<Material, SceneError> {
        let Some(name) = entry.common().interior else { return Ok(material) };
        let error = |message: &str| Err(self.error(&name.place, message));
        match &material.kind {
            MaterialKind::Glass { thin: true, .. } | MaterialKind::RoughGlass { thin: true, .. } => {
                return error("a `thin` wall encloses nothing, so it has no `interior`");
            }
            MaterialKind::Principled(principled) if principled.thin => {
                return error("a `thin` wall encloses nothing, so it has no `interior`");
            }
            MaterialKind::Principled(principled) if principled.subsurface.is_some() => {
                return error("a material has `interior` or `subsurface`, not both: both say what its body does to light");
            }
            MaterialKind::Principled(principled) if principled.attenuation.is_some() => {
                return error(
                    "a material has `interior` or `attenuation_color`, not both: both say what its body takes of light",
                );
            }
            _ => material.interior = Some(self.medium_id(name)?),
        }
        Ok(material)
    }
}
