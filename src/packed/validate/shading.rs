//! Materials, blends, textures and lights.

use super::Check;
use crate::packed::blend_weight::{self, WeightKind};
use crate::packed::constants::NONE;
use crate::packed::layers;
use crate::packed::light::PackedWarp;
use crate::packed::light::record::{
    LIGHT_BY_SOLID_ANGLE, LIGHT_FORM_SHIFT, LIGHT_FORMS, LIGHT_MOVES, LIGHT_REVERSED, LIGHT_TWO_SIDED, LIGHT_VARIES,
    LIGHT_WARPED, LightKind, PORTAL_SHIFT, PackedLight,
};
use crate::packed::material::{self, PackedMaterial};
use crate::packed::scene::PackedScene;
use crate::packed::shape::PrimitiveKind;
use crate::packed::texture::{self, PackedTexture, PackedTextureKind, TexelFormat};
use crate::sampling::cell_grid::FACINGS;
use crate::sampling::light_cells::table as light_cells;
use crate::sampling::{HierarchicalWarp, light_tree};
use crate::scene::LobeKind;
use crate::scene::material::FORMS;
use crate::scene::validate::MOST_OCTAVES;

/// Most texels along a side of an image: kernels compute with twice as many in signed numbers.
const LONGEST_SIDE: u32 = 1 << 30;

/// Inner nodes of a quadtree over a grid.
fn inner_nodes(width: u32, height: u32) -> u64 {
    let levels = HierarchicalWarp::levels_over(width, height);
    let at = |level: u32| u64::from(width.div_ceil(1 << level)) * u64::from(height.div_ceil(1 << level));
    (1..=levels).map(at).sum()
}

/// True where `count` records from `first` on stand within `length`.
fn is_within(first: u32, count: u32, length: usize) -> bool {
    u64::from(first) + u64::from(count) <= length as u64
}

impl PackedScene {
    pub(super) fn check_materials(&self) -> Check {
        let materials = &self.materials;
        if materials.scene_ids.len() != materials.materials.len() {
            return Err(format!("{} materials are {} of the scene's", materials.materials.len(), materials.scene_ids.len()));
        }
        for (index, material) in materials.materials.iter().enumerate() {
            self.check_material(material).map_err(|message| format!("material {index} {message}"))?;
        }
        materials.media.check(self.textures.texel_words())?;
        for (index, part) in materials.parts.iter().enumerate() {
            let count = part.factor_count & !material::PART_FRONT_ONLY;
            if !is_within(part.first_factor, count, materials.weights.len()) {
                return Err(format!("part {index} has {count} factors from {} on", part.first_factor));
            }
        }
        for (index, layer) in materials.layers.iter().enumerate() {
            layer.check(materials.media.phases.len()).map_err(|message| format!("layer {index} {message}"))?;
            // No interface is a stack: kernels walk through one stack at a time.
            if materials.materials[layer.interface as usize].kind() == material::LAYERED {
                return Err(format!("layer {index} has material {}, a stack, for its interface", layer.interface));
            }
        }
        for (index, weight) in materials.weights.iter().enumerate() {
            let kind = weight.kind_and_flags & 255;
            let known = kind <= WeightKind::Up as u32 && weight.kind_and_flags & !(255 | blend_weight::FLAGS) == 0;
            let is_axis = kind == WeightKind::Up as u32;
            let is_beyond = weight.looks_up() && weight.texture as usize >= self.textures.textures.len();
            if !known || is_beyond || (!is_axis && weight.looks_up() != (weight.texture != NONE)) {
                return Err(format!("weight {index} is of kind {:#x} and has texture {}", weight.kind_and_flags, weight.texture));
            }
        }
        Ok(())
    }

    fn check_material(&self, material: &PackedMaterial) -> Check {
        let is_blend = material.kind() == material::BLEND;
        if material.kind() > material::LAYERED || material.kind_and_form >> material::FORM_SHIFT & !FORMS != 0 {
            return Err(format!("is of kind {:#x}", material.kind_and_form));
        }
        let own_flags =
            material::EMITS | material::EMITS_TWO_SIDED | material::LETS_THROUGH | material::FRONT_ONLY | material::OPEN_BOUNDARY;
        let known_flags = own_flags | if is_blend { material::PARTS_EMIT } else { 0 };
        if material.emission_flags & ((1 << material::MEDIUM_SHIFT) - 1) & !known_flags != 0 {
            return Err(format!("has the flags {:#x}", material.emission_flags));
        }
        if material.medium() as usize > self.materials.media.media.len() {
            return Err(format!("encloses medium {} of {}", material.medium(), self.materials.media.media.len()));
        }
        let lobe = LobeKind::ALL.get(material.kind() as usize);
        let [to_look_up, table] = lobe.map_or([0, 0], |lobe| lobe.further_counts(material.kind_and_form >> material::FORM_SHIFT));
        let [first, looked_up] = [material.further & ((1 << material::FURTHER_SHIFT) - 1), material.looked_up()];
        let has_all =
            looked_up as usize == to_look_up && is_within(first, (to_look_up + table) as u32, self.materials.further.len());
        let has_none = material.further == 0 && !lobe.is_some_and(|lobe| lobe.needs_further());
        if !has_none && !has_all {
            return Err(format!("has further parameters from {first} on, of which {looked_up} are looked up"));
        }
        if !self.materials.albedos.serve(material, self.materials.further.len()) {
            return Err("looks up a table of albedos that is not there".to_owned());
        }
        if material.kind() == material::LAYERED {
            let [first, count, _] = material.color1.map(f32::to_bits);
            let flags = layers::LAYERS_MIRRORED | layers::LAYERS_STRAIGHT | layers::LAYERS_SCATTER;
            let (count, unknown) = (count & layers::LAYER_COUNT, count & !(layers::LAYER_COUNT | flags));
            if count == 0 || unknown != 0 || !is_within(first, count, self.materials.layers.len()) {
                return Err(format!("has {count} layers from {first} on"));
            }
        }
        if is_blend {
            let parts = &self.materials.parts;
            let [first, count, emitting] = material.color1.map(f32::to_bits);
            // Behind the parts stand the inner blends that emit by themselves, and only they may be blends.
            let run = parts.get(first as usize..).filter(|_| is_within(first, count, parts.len()));
            let Some((run, behind)) = run.map(|run| run.split_at(count as usize)) else {
                return Err(format!("has {count} parts from {first} on"));
            };
            if emitting as usize > behind.len() {
                return Err(format!("has {emitting} blends that emit behind its {count} parts from {first} on"));
            }
            let is_blend = |id: u32| self.materials.materials[id as usize].kind() == material::BLEND;
            if let Some(part) = run.iter().find(|part| is_blend(part.material)) {
                return Err(format!("has material {}, a blend, for a part", part.material));
            }
        }
        Ok(())
    }

    pub(super) fn check_textures(&self) -> Check {
        for (index, texture) in self.textures.textures.iter().enumerate() {
            self.check_texture(texture).map_err(|message| format!("texture {index} {message}"))?;
        }
        Ok(())
    }

    fn check_texture(&self, texture: &PackedTexture) -> Check {
        let PackedTexture { kind_and_flags, first_texel_or_seed, width_or_octaves, height, .. } = *texture;
        let is = |kind: PackedTextureKind| texture.kind() == kind as u32;
        let flags = if is(PackedTextureKind::Image) { texture::IMAGE_FLAGS } else { 0 };
        let wraps = [texture::WRAP_SHIFT, texture::WRAP_V_SHIFT].map(|shift| kind_and_flags >> shift & 3);
        let is_product = |number: u32| self.textures.textures.get(number as usize - 1).is_none_or(|other| other.times != 0);
        if texture.times != 0 && is_product(texture.times) {
            return Err(format!("is multiplied by texture {}, which is none or a product", texture.times - 1));
        }
        let of_normals = texture::TEXTURE_HEIGHTS | texture::TEXTURE_SHADOWS | texture::TEXTURE_MIRRORS;
        let flags = flags | of_normals | texture::TEXTURE_BY_SECOND_UVS | texture::TEXTURE_BENDS_BY_FIRST_UVS;
        let is_known = texture.kind() <= PackedTextureKind::Worley as u32 && kind_and_flags & !(255 | flags) == 0;
        if !is_known || wraps.into_iter().any(|wrap| wrap > 2) || texture.channel() > 4 {
            return Err(format!("is of kind {kind_and_flags:#x}"));
        }
        if is(PackedTextureKind::Perlin) && width_or_octaves > MOST_OCTAVES {
            return Err(format!("has {width_or_octaves} octaves"));
        }
        if is(PackedTextureKind::Image) {
            let possible = 1..=LONGEST_SIDE;
            let words = u64::from(texture.words_of_texel());
            let end = u64::from(first_texel_or_seed) + words * u64::from(width_or_octaves) * u64::from(height).min(1 << 30);
            let length = self.textures.texel_words() as u64;
            if !possible.contains(&width_or_octaves) || !possible.contains(&height) || end > length {
                return Err(format!("has {width_or_octaves} × {height} texels from {first_texel_or_seed} on"));
            }
            let has_alpha = texture.format() != TexelFormat::Float as u32 || kind_and_flags & texture::FLOAT_ALPHA != 0;
            if texture.channel() == 4 && !has_alpha {
                return Err("has no alpha".to_owned());
            }
            if texture.values() > 0 && u64::from(texture.first_value) + u64::from(texture.values()) > length {
                return Err(format!("has {} values from {} on", texture.values(), texture.first_value));
            }
        }
        Ok(())
    }

    pub(super) fn check_lights(&self) -> Check {
        for (index, profile) in self.light_profiles.iter().enumerate() {
            let [rows, planes] = profile.sides();
            let words = rows + planes + rows * planes;
            if rows < 2 || planes < 1 || !is_within(profile.first_word, words, self.textures.texel_words()) {
                return Err(format!("profile {index} has {rows} × {planes} candela from {} on", profile.first_word));
            }
        }
        for (index, light) in self.lights.iter().enumerate() {
            self.check_light(light).map_err(|message| format!("light {index} {message}"))?;
        }
        // Kernels know environments and portals by the number of the first.
        let numbers_of = |kind: LightKind| (0..self.lights.len()).filter(move |&index| self.lights[index].is(kind));
        let portals: Vec<usize> = numbers_of(LightKind::Portal).collect();
        if portals.windows(2).any(|pair| pair[0] + 1 != pair[1]) {
            return Err("between portals there are other lights".to_owned());
        }
        if numbers_of(LightKind::Environment).count() > 1 {
            return Err("two lights are the environment".to_owned());
        }
        self.check_light_tree()?;
        self.check_light_cells()
    }

    /// Every box names a cell or none, and every slot of a cell a light.
    pub(in crate::packed) fn check_light_cells(&self) -> Check {
        let Some((header, rest)) = self.light_cells.split_at_checked(light_cells::HEADER) else {
            return if self.light_cells.is_empty() { Ok(()) } else { Err("the cells of lights have no header".to_owned()) };
        };
        let boxes = header[4..7].iter().try_fold(FACINGS, |product, &count| product.checked_mul(count as usize));
        let first_cell = header[7] as usize;
        let Some((index, slots)) =
            boxes.filter(|boxes| light_cells::HEADER + boxes == first_cell).and_then(|boxes| rest.split_at_checked(boxes))
        else {
            return Err(format!("the cells of lights begin at {first_cell}, behind {boxes:?} boxes"));
        };
        let cells = slots.len() / light_cells::SLOTS;
        if !slots.len().is_multiple_of(light_cells::SLOTS) || self.light_cells.len() >= NONE as usize {
            return Err(format!("the cells of lights have {} slots", slots.len()));
        }
        if let Some(number) = index.iter().find(|number| **number as usize > cells) {
            return Err(format!("a box names cell {number} of {cells}"));
        }
        match slots.iter().find(|slot| (**slot & light_cells::LIGHT_SLOT_MASK) as usize >= self.lights.len()) {
            Some(slot) => Err(format!("a cell names {slot:#x} of {} lights", self.lights.len())),
            None if self.lights.is_empty() => Err("there are cells and no lights".to_owned()),
            None => Ok(()),
        }
    }

    /// Below each node stand nodes behind it alone, so every way down ends; it ends at a light inside the scene.
    fn check_light_tree(&self) -> Check {
        let local = self.local_lights;
        let Some(at_infinity) = self.lights.get(local..) else {
            return Err(format!("{local} of {} lights stand inside the scene", self.lights.len()));
        };
        for (number, node) in self.light_nodes.iter().enumerate() {
            for cluster in &node.clusters {
                let (is_leaf, child) = (cluster.link & light_tree::LEAF != 0, (cluster.link & light_tree::NUMBER_MASK) as usize);
                let exists = if is_leaf { child < local } else { number < child && child < self.light_nodes.len() };
                if !exists {
                    return Err(format!("node {number} of the lights leads to {:#x}", cluster.link));
                }
            }
        }
        // The choice at infinity is made among those lights alone.
        let leads_back = |light: &PackedLight| (light.alias as usize) < local;
        if !self.light_nodes.is_empty() && at_infinity.iter().any(leads_back) {
            return Err("a light at infinity stands for one inside the scene".to_owned());
        }
        Ok(())
    }

    fn check_light(&self, light: &PackedLight) -> Check {
        let is_surface = light.is_surface();
        let has_area = |kind: u32| PrimitiveKind::of(kind).is_some_and(|kind| !kind.is_infinite());
        let (is_known, flags) = if is_surface {
            let unrolled = light.shape().and_then(PrimitiveKind::unrolled);
            let of_wholes = if unrolled.is_some() { LIGHT_WARPED | LIGHT_REVERSED } else { 0 };
            (has_area(light.kind()), LIGHT_TWO_SIDED | LIGHT_VARIES | LIGHT_MOVES | LIGHT_BY_SOLID_ANGLE | of_wholes)
        } else if light.is(LightKind::Portal) {
            (has_area(light.kind_and_flags >> PORTAL_SHIFT), u32::MAX << PORTAL_SHIFT)
        } else if light.is_delta() {
            (true, LIGHT_FORMS << LIGHT_FORM_SHIFT)
        } else {
            (LightKind::all().any(|kind| light.is(kind)), 0)
        };
        if !is_known || light.kind_and_flags & !(255 | flags) != 0 {
            return Err(format!("is of kind {:#x}", light.kind_and_flags));
        }
        let shines_from_outside = [LightKind::Portal, LightKind::Environment].into_iter().any(|kind| light.is(kind));
        if shines_from_outside && self.environment.is_black() {
            return Err("is the environment, and there is none".to_owned());
        }
        let named = if light.is_delta() { self.textures.textures.len() } else { self.attributes.len() };
        if light.attributes != NONE && light.attributes as usize >= named {
            return Err(format!("has attributes or a texture {} of {named}", light.attributes));
        }
        let named = if light.is_delta() { self.light_profiles.len() } else { self.materials.materials.len() };
        if light.material != NONE && light.material as usize >= named {
            return Err(format!("has a material or a profile {} of {named}", light.material));
        }
        if is_surface && light.material == NONE {
            return Err("is a surface without a material".to_owned());
        }
        if let Some(PackedWarp { first_node, first_density, width, height }) = light.warp() {
            let length = self.textures.texel_words();
            let nodes = first_density.saturating_sub(first_node);
            let is_whole = width > 0 && height > 0 && u64::from(nodes) == 3 * inner_nodes(width, height);
            if !is_whole || !light.varies() || !is_within(first_density, width * height, length) {
                return Err(format!("is drawn by {width} × {height} cells at {first_node} and {first_density}"));
            }
            if light.kind() == PrimitiveKind::Sphere as u32 && light.attributes == NONE {
                return Err("is a sphere that shows something, and nothing says how it is turned".to_owned());
            }
        }
        if light.moves() && self.motion_of(light.attributes).is_none() {
            return Err("moves, and nothing says how".to_owned());
        }
        Ok(())
    }
}
