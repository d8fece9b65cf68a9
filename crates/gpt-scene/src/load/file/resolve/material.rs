//! `[[material]]`

use std::sync::Arc;

use crate::load::error::SceneError;
use crate::load::file::material::MaterialEntry;
use crate::load::file::reference::TextureName;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::Located;
use crate::scene::light_links::LinkMask;
use crate::scene::{BlendWeight, Material, MaterialKind, Relief, Texture, TextureId, TextureKind, check_blends};

/// Help where a material without emission names a light group.
const NO_EMISSION: &str = "this material has no `emission`";
const OF_PARTS: &str =
    "this material has no `emission` of its own, and each of those that it is made of names its group by itself";

impl Resolver<'_> {
    pub(super) fn materials(&mut self, written: &[MaterialEntry]) -> Result<(), SceneError> {
        self.material_names = self.register("material", written.iter().map(|entry| entry.common().name))?;
        for (id, entry) in written.iter().enumerate() {
            let material = self.material(entry).and_then(|material| self.with_relief(material, entry));
            let material = material.and_then(|material| self.with_interior(material, entry));
            let name = || entry.common().name.value.clone();
            // Something has to stand in its place, or others would have none.
            let kind = MaterialKind::Pass;
            let material = self.note(material).unwrap_or_else(|| Material {
                name: name(),
                kind,
                normal_map: None,
                emission: None,
                two_sided: true,
                interior: None,
            });
            self.scene.materials.push(material);
            let (written, emits) = (entry.common().light_group, entry.gives_light());
            let help = if entry.parts().is_empty() { NO_EMISSION } else { OF_PARTS };
            let group = self.light_group_of(written, emits, help);
            let group = self.note(group).unwrap_or(0);
            self.scene.light_groups.put_material(id, group);
            let link = self.link_of_material(entry);
            let link = self.note(link).unwrap_or(LinkMask::ALL);
            self.scene.light_links.put_material(id, link);
            let track = entry.track(id, self);
            if let Some(Some(track)) = self.note(track) {
                Arc::make_mut(&mut self.scene.animation).materials.push(track);
            }
        }
        let of_entry = self.make_transparent(written);
        if !self.errors.is_empty() {
            return Ok(());
        }
        // Materials stand in the order of their entries, and behind them what some of those are made of.
        check_blends(&self.scene.materials).and_then(|()| self.scene.check_links_of_blends()).map_err(|(id, message)| {
            let entry = id.checked_sub(written.len()).map_or(id, |behind| of_entry[behind]);
            self.error(&written[entry].common().name.place, message)
        })?;
        // Checks of parts follow blends to their ends.
        written.iter().try_for_each(|entry| entry.check_parts(self))
    }

    /// The mask of what surfaces of a material light, which has to give light itself, or by a part.
    fn link_of_material(&mut self, entry: &MaterialEntry) -> Result<LinkMask, SceneError> {
        let link = entry.common().link;
        if let Some(written) = link.only.or(link.all_but)
            && !entry.gives_light()
            && entry.parts().is_empty()
        {
            let message = format!("`lights_only` and `lights_all_but` are of what gives light: {NO_EMISSION}");
            return Err(self.error(&written.place, message));
        }
        self.link_mask(link)
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
                        interior: material.interior,
                    };
                    self.scene.light_groups.put_material(id, 0);
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
                        interior: material.interior,
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
                        interior: None,
                    };
                    self.scene.materials.extend([whole, nothing]);
                    let animation = Arc::make_mut(&mut self.scene.animation);
                    animation.materials.iter_mut().filter(|track| track.material == id).for_each(|track| track.material = count);
                    self.scene.light_groups.move_material(id, count);
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
            interior: None,
        })
    }

    /// A texture by which normals are perturbed.
    fn relief_texture(&self, name: &Located<TextureName>) -> Result<TextureId, SceneError> {
        let id = self.texture_id(name)?;
        if self.scene.textures[id].times.is_some() {
            let message = format!("normal and bump maps cannot be products, as the texture `{}` is by `times`", name.value.0);
            return Err(self.error(&name.place, message));
        }
        Ok(id)
    }

    pub(in crate::load::file) fn normal_map(&self, name: &Located<TextureName>) -> Result<TextureId, SceneError> {
        self.relief_texture(name)?;
        self.texture_of_directions(name, "a normal map")
    }

    pub(in crate::load::file) fn texture_of_directions(
        &self,
        name: &Located<TextureName>,
        what: &str,
    ) -> Result<TextureId, SceneError> {
        let id = self.texture_id(name)?;
        if self.linear_textures[id] {
            return Ok(id);
        }
        let message = format!("{what} holds directions, not colours: `{}` needs color_space = \"linear\"", name.value.0);
        Err(self.error(&name.place, message))
    }

    /// The material with a normal map that is scaled, or with a bump map: the same texture once more, which says how it bends normals.
    fn with_relief(&mut self, mut material: Material, entry: &MaterialEntry) -> Result<Material, SceneError> {
        let common = entry.common();
        for (key, scale, map) in
            [("normal_scale", common.normal_scale, common.normal_map), ("bump_scale", common.bump_scale, common.bump_map)]
        {
            if let (Some(scale), None) = (scale, map) {
                let message = format!("`{key}` belongs to `{}`, which is not there", key.replace("scale", "map"));
                return Err(self.error(&scale.place, message));
            }
        }
        let shadowing = common.normal_shadowing;
        if let (Some(shadowing), None, None) = (shadowing, common.normal_map, common.bump_map) {
            let message = "`normal_shadowing` belongs to `normal_map` or `bump_map`, of which there is none";
            return Err(self.error(&shadowing.place, message));
        }
        let is_shadowed = shadowing.is_some_and(|shadowing| shadowing.value);
        let is_mirrored = common.normal_mirroring.is_some_and(|mirroring| mirroring.value);
        if let (Some(mirroring), false) = (common.normal_mirroring, is_shadowed) {
            let message = "`normal_mirroring` belongs to `normal_shadowing = true`, which is not there";
            return Err(self.error(&mirroring.place, message));
        }
        let relief = match (common.bump_map, material.normal_map, common.normal_scale) {
            (Some(bump), Some(_), _) => {
                return Err(self.error(&bump.place, "a material has a normal map or a bump map, not both"));
            }
            (Some(bump), None, _) => {
                let id = self.relief_texture(bump)?;
                let is_image = matches!(self.scene.textures[id].kind, TextureKind::Image(_));
                let name = &bump.value.0;
                if let TextureKind::Checker { .. } = self.scene.textures[id].kind {
                    let message =
                        format!("the checker `{name}` rises in steps, and has no slopes for a bump map: take an image or noise");
                    return Err(self.error(&bump.place, message));
                }
                if is_image && !self.linear_textures[id] {
                    let message = format!("a bump map holds heights, not colours: `{name}` needs color_space = \"linear\"");
                    return Err(self.error(&bump.place, message));
                }
                Some((id, Relief::Heights(common.bump_scale.map_or(1.0, |scale| scale.value.0))))
            }
            (None, Some(id), Some(scale)) => Some((id, Relief::Normals(scale.value.0))),
            (None, Some(id), None) if is_shadowed => Some((id, Relief::Normals(1.0))),
            (None, ..) => None,
        };
        if let Some((id, relief)) = relief {
            let linear = self.linear_textures[id];
            let (shadows_perturbed_normals, mirrors_perturbed_normals) = (is_shadowed, is_mirrored);
            let texture = self.scene.textures[id].clone();
            self.scene.textures.push(Texture { relief, shadows_perturbed_normals, mirrors_perturbed_normals, ..texture });
            self.linear_textures.push(linear);
            material.normal_map = Some(self.scene.textures.len() - 1);
        }
        Ok(material)
    }
}
