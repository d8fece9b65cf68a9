//! `[[material]]`

use crate::load::error::SceneError;
use crate::load::file::material::MaterialEntry;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::Located;
use crate::scene::{Material, MaterialKind, TextureId, check_blends};

impl Resolver<'_> {
    pub(super) fn materials(&mut self, written: &[MaterialEntry]) -> Result<(), SceneError> {
        self.material_names = self.register("material", written.iter().map(|entry| entry.common().name))?;
        for entry in written {
            let material = self.material(entry);
            let name = || entry.common().name.value.clone();
            // Something has to stand in its place, or others would have none.
            let kind = MaterialKind::Pass;
            let material =
                self.note(material).unwrap_or_else(|| Material { name: name(), kind, normal_map: None, emission: None });
            self.scene.materials.push(material);
        }
        if !self.errors.is_empty() {
            return Ok(());
        }
        for entry in written {
            entry.check_parts(self)?;
        }
        // Materials stand in the order of their entries.
        check_blends(&self.scene.materials).map_err(|(id, message)| self.error(&written[id].common().name.span, message))
    }

    fn material(&self, entry: &MaterialEntry) -> Result<Material, SceneError> {
        let common = entry.common();
        Ok(Material {
            name: common.name.value.clone(),
            kind: entry.kind(self)?,
            normal_map: common.normal_map.map(|name| self.normal_map(name)).transpose()?,
            emission: entry.emission(self)?,
        })
    }

    fn normal_map(&self, name: &Located<String>) -> Result<TextureId, SceneError> {
        let id = self.texture_id(name)?;
        if self.linear_textures[id] {
            return Ok(id);
        }
        let message = format!("a normal map holds directions, not colours: `{}` needs color_space = \"linear\"", name.value);
        Err(self.error(&name.span, message))
    }
}
