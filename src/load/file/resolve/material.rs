//! `[[material]]`

use crate::load::error::SceneError;
use crate::load::file::material::MaterialEntry;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::Located;
use crate::scene::{BlendWeight, Material, MaterialKind, TextureId, check_blends};

impl Resolver<'_> {
    pub(super) fn materials(&mut self, written: &[MaterialEntry]) -> Result<(), SceneError> {
        self.material_names = self.register("material", written.iter().map(|entry| entry.common().name))?;
        for entry in written {
            let material = self.material(entry);
            let name = || entry.common().name.value.clone();
            // Something has to stand in its place, or others would have none.
            let kind = MaterialKind::Pass;
            let material = self.note(material).unwrap_or_else(|| Material {
                name: name(),
                kind,
                normal_map: None,
                emission: None,
                two_sided: true,
            });
            self.scene.materials.push(material);
        }
        let of_entry = self.make_transparent(written);
        if !self.errors.is_empty() {
            return Ok(());
        }
        for entry in written {
            entry.check_parts(self)?;
        }
        // Materials stand in the order of their entries, and behind them what some of those are made of.
        check_blends(&self.scene.materials).map_err(|(id, message)| {
            let entry = id.checked_sub(written.len()).map_or(id, |behind| of_entry[behind]);
            self.error(&written[entry].common().name.span, message)
        })
    }

    /// Makes each material with an opacity a blend of what it was and of nothing. Which entry each material belongs to that is added for it.
    fn make_transparent(&mut self, written: &[MaterialEntry]) -> Vec<usize> {
        let mut of_entry = Vec::new();
        for (id, entry) in written.iter().enumerate() {
            let Some(opacity) = entry.common().opacity else { continue };
            let weight = opacity.value.weight(self);
            let Some(weight) = self.note(weight) else { continue };
            let material = &mut self.scene.materials[id];
            match weight {
                _ if matches!(material.kind, MaterialKind::Pass) => {}
                BlendWeight::Constant { value: 1.0 } => {}
                BlendWeight::Constant { value: 0.0 } => {
                    *material = Material {
                        kind: MaterialKind::Pass,
                        normal_map: None,
                        emission: None,
                        name: material.name.clone(),
                        two_sided: true,
                    };
                }
                weight => {
                    let count = written.len() + of_entry.len();
                    let blend = Material {
                        name: material.name.clone(),
                        kind: MaterialKind::Blend { materials: [count, count + 1], weight },
                        // The parts lie on one surface: its normals are the blend's own.
                        normal_map: material.normal_map.take(),
                        emission: None,
                        two_sided: true,
                    };
                    let mut whole = std::mem::replace(material, blend);
                    let name = |what: &str| format!("{} ({what})", entry.common().name.value);
                    whole.name = name("where it is");
                    let nothing = Material {
                        name: name("where it is not"),
                        kind: MaterialKind::Pass,
                        normal_map: None,
                        emission: None,
                        two_sided: true,
                    };
                    self.scene.materials.extend([whole, nothing]);
                    of_entry.extend([id, id]);
                }
            }
        }
        of_entry
    }

    fn material(&self, entry: &MaterialEntry) -> Result<Material, SceneError> {
        let common = entry.common();
        Ok(Material {
            name: common.name.value.clone(),
            kind: entry.kind(self)?,
            normal_map: common.normal_map.map(|name| self.normal_map(name)).transpose()?,
            emission: entry.emission(self)?,
            two_sided: entry.two_sided(self)?,
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
