//! `[[material]]`

use crate::load::error::SceneError;
use crate::load::file::material::MaterialEntry;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::Located;
use crate::scene::{Material, TextureId, check_blends};

impl Resolver<'_> {
    pub(super) fn materials(&mut self, written: &[MaterialEntry]) -> Result<(), SceneError> {
        self.material_names = self.register("material", written.iter().map(|entry| entry.common().name))?;
        for entry in written {
            let common = entry.common();
            let material = Material {
                name: common.name.value.clone(),
                kind: entry.kind(self)?,
                normal_map: common.normal_map.map(|name| self.normal_map(name)).transpose()?,
                emission: entry.emission(self)?,
            };
            self.scene.materials.push(material);
        }
        for entry in written {
            entry.check_parts(self)?;
        }
        // Materials stand in the order of their entries.
        check_blends(&self.scene.materials).map_err(|(id, message)| self.error(&written[id].common().name.span, message))
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
