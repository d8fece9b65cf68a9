//! The reads of kernels in a packed scene, written after the shaders and not after the checks: every index
//! that they compute from it, with their arithmetic of 32 bits, and every loop that they count by it.

use std::cell::{Cell, RefCell};
use std::collections::HashSet;

use crate::packed::environment::PackedMap;
use crate::packed::hierarchy::Traversal;
use crate::packed::light::LightKind;
use crate::packed::material::{BLEND, LAYERED};
use crate::packed::tables::Tables;
use crate::packed::{NONE, PackedScene};
use crate::scene::LobeKind;

/// A read, or the access that a kernel must not make.
type Read<T> = Result<T, String>;

/// Steps after which a kernel is taken to be in a loop without an end: far more than the scenes of these tests have use for.
const MOST_STEPS: u64 = 20_000;

pub struct Kernel<'a> {
    scene: &'a PackedScene,
    tables: Tables,
    steps: Cell<u64>,
    /// Records that were followed before: materials and textures by their number, which lead to the same
    /// words every time.
    known: RefCell<HashSet<(RecordKind, u32)>>,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum RecordKind {
    Material,
    Plain,
    Texture,
    Motion,
}

/// Follows everything that a ray may meet, whatever it samples.
///
/// # Errors
/// The first read out of bounds, or that a loop has no end.
pub fn follow(scene: &PackedScene) -> Read<()> {
    let kernel = Kernel { scene, tables: scene.tables(), steps: Cell::new(0), known: RefCell::default() };
    kernel.constants()?;
    match scene.hierarchy.traversal {
        Traversal::Bvh => kernel.traverse()?,
        Traversal::RayQuery => kernel.query()?,
    }
    kernel.lights()?;
    if !scene.light_nodes.is_empty() {
        kernel.light_tree()?;
    }
    if !scene.light_cells.is_empty() {
        kernel.light_cells()?;
    }
    scene.environment.map.map_or(Ok(()), |map| kernel.map(&map))
}

impl Kernel<'_> {
    fn step(&self) -> Read<()> {
        self.steps.set(self.steps.get() + 1);
        if self.steps.get() > MOST_STEPS { Err("a loop without an end".to_owned()) } else { Ok(()) }
    }

    /// True where a part is met for the first time.
    fn is_new(&self, part: RecordKind, number: u32) -> bool {
        self.known.borrow_mut().insert((part, number))
    }

    fn table(&self, index: u32) -> Read<[u32; 4]> {
        self.step()?;
        let word = self.tables.words.get(index as usize).ok_or_else(|| format!("word {index} of the tables"))?;
        Ok(word.map(f32::to_bits))
    }

    fn texel(&self, index: u32) -> Read<u32> {
        self.step()?;
        let textures = &self.scene.textures;
        if index as usize >= textures.texel_words() {
            return Err(format!("texel word {index}"));
        }
        // Colours are not followed as indices.
        Ok((index as usize).checked_sub(textures.first_word()).map_or(0, |word| textures.words[word]))
    }

    /// geometry/unrolled.wgsl: primitives that stand outside of the hierarchy, or all of them.
    fn constants(&self) -> Read<()> {
        (0..self.scene.primitives.len() as u32).try_for_each(|index| self.primitive(index).map(drop))
    }

    /// geometry/traversal.wgsl and bvh4.wgsl, with every child met, so that as many wait as can.
    fn traverse(&self) -> Read<()> {
        const LEAF: u32 = 1 << 31;
        let nodes: &[[u32; 12]] = bytemuck::cast_slice(&self.scene.hierarchy.nodes);
        let mut to_visit = vec![(0_u32, 0_u32, false)];
        while let Some((entry, depth, in_group)) = to_visit.pop() {
            self.step()?;
            if entry & LEAF != 0 {
                let first = entry & 0x00ff_ffff;
                for primitive in first..=first + (entry >> 24 & 3) {
                    if let Some(root) = self.primitive(primitive)? {
                        // Entries that wait beside it: the rest of the leaf, and the mark of the way back.
                        to_visit.push((root, depth + 3, true));
                        if in_group {
                            return Err("an instance within an instance".to_owned());
                        }
                    }
                }
                continue;
            }
            let node = nodes.get(entry as usize).ok_or_else(|| format!("node {entry}"))?;
            let flags = node[3] >> 24;
            let (exists, sizes) = (node[3] >> 28, node[5] >> 24);
            let count = exists.count_ones();
            if depth + count.saturating_sub(2) >= self.scene.hierarchy.stack_size {
                return Err(format!("entry {} of the stack", depth + count.saturating_sub(2)));
            }
            let mut start = node[5] & 0x00ff_ffff;
            for child in 0..4 {
                let inner = flags >> child & 1 == 1;
                let size = sizes >> (2 * child) & 3;
                let entry = if inner {
                    node[4].wrapping_add((flags & ((1 << child) - 1)).count_ones())
                } else {
                    start | size << 24 | LEAF
                };
                start += if inner { 0 } else { size + 1 };
                if exists >> child & 1 == 1 {
                    to_visit.push((entry, depth + count - 1, in_group));
                }
            }
        }
        Ok(())
    }

    /// geometry/ray_query.wgsl: a device names triangles and boxes by their number.
    fn query(&self) -> Read<()> {
        (0..self.scene.hierarchy.primitive_count).try_for_each(|index| self.primitive(index).map(drop))
    }

    /// shading/surface.wgsl. The root of the group where it is an instance.
    fn primitive(&self, index: u32) -> Read<Option<u32>> {
        self.step()?;
        let words: &[[u32; 12]] = bytemuck::cast_slice(&self.scene.primitives);
        let words = words.get(index as usize).ok_or_else(|| format!("primitive {index}"))?;
        let [kind_and_material, light, attributes] = [words[3], words[7], words[11]];
        if kind_and_material >> 28 & 7 == 7 && !self.scene.instances.is_empty() {
            return self.instance(kind_and_material & 0x0fff_ffff).map(Some);
        }
        if kind_and_material >> 31 == 1 {
            let motion = self.attribute(attributes)?;
            self.motion(motion)?;
        }
        if attributes != NONE {
            self.interpolate(attributes)?;
        }
        if light != NONE && !self.scene.lights.is_empty() {
            self.light_word(light, 0)?;
        }
        self.material(kind_and_material & 0x0fff_ffff).map(|()| None)
    }

    /// geometry/instance.wgsl
    fn instance(&self, index: u32) -> Read<u32> {
        let words: &[[u32; 24]] = bytemuck::cast_slice(&self.scene.instances);
        let words = words.get(index as usize).ok_or_else(|| format!("instance {index}"))?;
        let [root, material, motion] = [words[3] & 0x7fff_ffff, words[7], words[11]];
        if material != NONE {
            self.material(material)?;
        }
        if motion != NONE && self.scene.moves() {
            self.motion(motion)?;
        }
        Ok(root)
    }

    /// The first word of a motion.
    fn attribute(&self, index: u32) -> Read<u32> {
        self.step()?;
        let attributes = self.scene.attributes.get(index as usize).ok_or_else(|| format!("attributes {index}"))?;
        Ok(attributes.motion)
    }

    fn interpolate(&self, attributes: u32) -> Read<()> {
        match self.attribute(attributes)? {
            motion if motion != NONE && self.scene.moves() => self.motion(motion),
            _ => Ok(()),
        }
    }

    /// geometry/motion.wgsl
    fn motion(&self, first: u32) -> Read<()> {
        if !self.is_new(RecordKind::Motion, first) {
            return Ok(());
        }
        let word = |index: u32| self.table(self.tables.first_motion.wrapping_add(index));
        let steps = word(first)?[3];
        let end = first.wrapping_add(1).wrapping_add(steps.wrapping_mul(2));
        let mut index = first.wrapping_add(1);
        while index < end {
            word(index)?;
            word(index.wrapping_add(1))?;
            index = index.wrapping_add(2);
        }
        Ok(())
    }

    /// shading/material/bsdf.wgsl, blend.wgsl: what a surface emits and how it scatters.
    fn material(&self, material: u32) -> Read<()> {
        if !self.is_new(RecordKind::Material, material) {
            return Ok(());
        }
        let first = material.wrapping_mul(5);
        let words = (0..5).map(|word| self.table(first.wrapping_add(word))).collect::<Read<Vec<_>>>()?;
        let is_blend = words[0][3] & 255 == BLEND;
        if words[4][1] != NONE {
            self.texture(words[4][1])?;
        }
        self.emission(material)?;
        if words[0][3] & 255 == LAYERED {
            self.layers(words[1][0], words[1][1] & 0xffff)?;
        }
        let parts_emit = words[2][3] & 4 != 0;
        let (run, count) = if is_blend { (words[1][0], words[1][1]) } else { (NONE, 1) };
        let behind = if parts_emit { words[1][2] } else { 0 };
        if run == NONE {
            // All emitting parts are the material itself, as often as the loop counts.
            (0..behind).try_for_each(|_| self.step())?;
            return self.load(material);
        }
        let mut index = 0;
        while index < count.wrapping_add(behind) {
            let part = self.table(self.tables.first_part.wrapping_add(run).wrapping_add(index))?;
            let mut factor = part[1];
            while factor < part[1].wrapping_add(part[2] & 0x7fff_ffff) {
                self.weight(factor)?;
                factor += 1;
            }
            self.emission(part[0])?;
            if index < count {
                self.load(part[0])?;
            }
            index += 1;
        }
        Ok(())
    }

    /// shading/layered/stack.wgsl
    fn layers(&self, first: u32, count: u32) -> Read<()> {
        for layer in 0..count {
            let start = self.tables.first_layer.wrapping_add(first.wrapping_add(layer).wrapping_mul(4));
            let words = (0..4).map(|word| self.table(start.wrapping_add(word))).collect::<Read<Vec<_>>>()?;
            self.material(words[0][0])?;
            let [flags, texture, phase] = [words[0][3], words[3][0], words[3][1]];
            if flags != 0 {
                if texture != NONE {
                    self.texture(texture)?;
                }
                let lobes = (phase & 0x7fff_ffff) >> 20;
                for lobe in 0..lobes {
                    self.table(self.tables.first_phase.wrapping_add(phase & 0x000f_ffff).wrapping_add(lobe))?;
                }
            }
        }
        Ok(())
    }

    fn load(&self, material: u32) -> Read<()> {
        if !self.is_new(RecordKind::Plain, material) {
            return Ok(());
        }
        let words = (0..5).map(|word| self.table(material.wrapping_mul(5).wrapping_add(word))).collect::<Read<Vec<_>>>()?;
        let textures = words[3];
        [0, 2, 3].into_iter().filter(|&slot| textures[slot] != NONE).try_for_each(|slot| self.texture(textures[slot]))?;
        // Further parameters; behind those that are looked up stands what the surface of rough plastic lets through.
        let first = self.tables.first_further.wrapping_add(words[4][3] & 0x00ff_ffff);
        let count = words[4][3] >> 24;
        // Kernels have room for as many as the material that has most.
        for index in 0..count {
            let word = self.table(first.wrapping_add(index))?;
            if word[3] != NONE {
                self.texture(word[3])?;
            }
        }
        if words[0][3] & 255 == LobeKind::RoughPlastic as u32 {
            (0..22).try_for_each(|index| self.table(first.wrapping_add(count + index)).map(drop))?;
        }
        Ok(())
    }

    fn emission(&self, material: u32) -> Read<()> {
        let texture = self.table(material.wrapping_mul(5).wrapping_add(3))?[1];
        if texture == NONE { Ok(()) } else { self.texture(texture) }
    }

    /// shading/material/blend_weight.wgsl
    fn weight(&self, weight: u32) -> Read<()> {
        let words = self.table(self.tables.first_blend_weight.wrapping_add(weight))?;
        if words[0] & 255 == 4 { self.texture(words[3]) } else { Ok(()) }
    }

    /// shading/texture/texture.wgsl; kernels without textures have no code for them.
    fn texture(&self, texture: u32) -> Read<()> {
        if self.scene.textures.textures.is_empty() || !self.is_new(RecordKind::Texture, texture) {
            return Ok(());
        }
        let first = self.tables.first_texture.wrapping_add(texture.wrapping_mul(5));
        let words = (0..5).map(|word| self.table(first.wrapping_add(word))).collect::<Read<Vec<_>>>()?;
        if words[4][3] != 0 {
            self.texture(words[4][3] - 1)?;
        }
        let [flags, first, width, height] = words[0];
        match flags & 255 {
            0 => self.image(first, [width, height].map(|side| side as i32), flags, words[4][2]),
            2 => (0..width).try_for_each(|_| self.step()),
            _ => Ok(()),
        }
    }

    fn image(&self, first: u32, [width, height]: [i32; 2], flags: u32, first_value: u32) -> Read<()> {
        let [wrap_u, wrap_v] = [8, 22].map(|shift| flags >> shift & 3);
        let channel = flags >> 14 & 7;
        let (words, values) = match flags >> 11 & 3 {
            0 => (1, 256),
            1 => (2, 65_536),
            2 => (2, 0),
            _ => (3 + (flags >> 13 & 1), 0),
        };
        // The first and the last value that a texel may have.
        if values > 0 {
            self.texel(first_value)?;
            self.texel(first_value.wrapping_add(values - 1))?;
        }
        let ends = |size: i32| [i32::MIN, -1, 0, size.wrapping_sub(1), size, i32::MAX];
        for x in ends(width) {
            for y in ends(height) {
                let (column, row) = (wrapped(x, width, wrap_u)?, wrapped(y, height, wrap_v)?);
                let place = row.wrapping_mul(width).wrapping_add(column) as u32;
                let last = if words >= 3 && channel > 0 { channel } else { words.min(3) };
                (0..last).try_for_each(|word| {
                    self.texel(first.wrapping_add(place.wrapping_mul(words)).wrapping_add(word)).map(drop)
                })?;
            }
        }
        Ok(())
    }

    fn light_word(&self, light: u32, word: u32) -> Read<[u32; 4]> {
        self.table(self.tables.first_light.wrapping_add(light.wrapping_mul(5)).wrapping_add(word))
    }

    /// shading/light/sampling.wgsl: every entry of the alias table, and the light that it leads to.
    fn lights(&self) -> Read<()> {
        for entry in 0..self.scene.lights.len() as u32 {
            let alias = self.light_word(entry, 0)?[2];
            for light in [entry, alias] {
                let flags = self.light_word(light, 0)?[0];
                let [attributes, material] = [self.light_word(light, 3)?[3], self.light_word(light, 4)?[3]];
                // The picture of a projection light.
                if LightKind::DELTA.iter().any(|&kind| kind as u32 == flags & 255) {
                    if material != NONE {
                        self.light_profile(material)?;
                    }
                    let texture = self.light_word(light, 3)?[3];
                    if texture != NONE {
                        self.texture(texture)?;
                    }
                }
                if flags & 1024 != 0 {
                    let motion = self.attribute(attributes)?;
                    self.motion(motion)?;
                }
                if flags & 512 != 0 && flags & 255 < 8 {
                    if attributes != NONE {
                        self.interpolate(attributes)?;
                    }
                    self.material(material)?;
                }
            }
        }
        Ok(())
    }

    /// shading/light/profile.wgsl: every angle, and all candela between any of them.
    fn light_profile(&self, profile: u32) -> Read<()> {
        let at = self.tables.first_light_profile.wrapping_add(profile.wrapping_mul(2));
        let [first, counts] = [self.table(at)?[3], self.table(at.wrapping_add(1))?[3]];
        let [rows, planes] = [counts & 0xffff, counts >> 16];
        if rows < 2 {
            return Err(format!("a profile of {rows} vertical angles"));
        }
        let candela = rows.wrapping_add(planes);
        (0..candela.wrapping_add(rows.wrapping_mul(planes)))
            .try_for_each(|word| self.texel(first.wrapping_add(word)).map(drop))?;
        // Kernels read the first plane even of none.
        (0..rows).try_for_each(|row| self.texel(first.wrapping_add(candela).wrapping_add(row)).map(drop))
    }

    /// shading/light/choice/tree.wgsl: every way down, and the choice among lights at infinity.
    fn light_tree(&self) -> Read<()> {
        let mut to_visit = vec![0_u32];
        while let Some(node) = to_visit.pop() {
            for word in [1, 3] {
                let at = self.tables.first_light_node.wrapping_add(node.wrapping_mul(4)).wrapping_add(word);
                let link = self.table(at)?[3];
                if link >> 31 == 0 {
                    to_visit.push(link & 0x3fff_ffff);
                } else if self.scene.lights.get((link & 0x3fff_ffff) as usize).is_none() {
                    return Err(format!("light {}", link & 0x3fff_ffff));
                }
            }
        }
        let mut at_infinity = self.scene.local_lights as u32..self.scene.lights.len() as u32;
        at_infinity.try_for_each(|entry| {
            let alias = self.light_word(entry, 0)?[2];
            // One inside the scene would be chosen with another probability than it is weighed by.
            if (alias as usize) < self.scene.local_lights { Err(format!("light {alias} at infinity")) } else { Ok(()) }
        })
    }

    /// shading/light/choice/cells.wgsl: every box, every slot of its cell, and the choice by power.
    fn light_cells(&self) -> Read<()> {
        let word = |index: u32| {
            self.step()?;
            self.scene.light_cells.get(index as usize).copied().ok_or_else(|| format!("word {index} of the cells of lights"))
        };
        let mut boxes = 6_u32;
        for axis in 4..7 {
            boxes = boxes.wrapping_mul(word(axis)?);
        }
        let count = self.scene.lights.len() as u32;
        for index in 0..boxes {
            let number = word(8_u32.wrapping_add(index))?;
            for slot in (0..112).filter(|_| number > 0) {
                let first = word(7)?.wrapping_add(number.wrapping_sub(1).wrapping_mul(112));
                let light = word(first.wrapping_add(slot))? & 0xf_ffff;
                if light >= count {
                    return Err(format!("light {light} in a cell"));
                }
            }
        }
        (0..count).try_for_each(|entry| {
            let alias = self.light_word(entry, 0)?[2];
            if alias < count { Ok(()) } else { Err(format!("light {alias} in place of {entry}")) }
        })
    }

    /// shading/light/kind/environment.wgsl: every node that some point of the square leads to, and every cell and texel.
    fn map(&self, map: &PackedMap) -> Read<()> {
        for y in [0, map.height.wrapping_sub(1)] {
            for x in [0, map.width.wrapping_sub(1)] {
                let place = y.wrapping_mul(map.width).wrapping_add(x).wrapping_mul(3);
                (0..3).try_for_each(|channel| self.texel(map.first_texel.wrapping_add(place).wrapping_add(channel)).map(drop))?;
            }
        }
        // The cell to which the look-up clamps.
        let [last_row, last_column] = [map.grid_height, map.grid_width].map(|side| side.wrapping_sub(1));
        self.cell(map, last_column, last_row)?;
        const SIDE: u64 = 1 << 31;
        let mut to_visit = vec![(map.levels, [0, 0], map.first_node, [[0, SIDE]; 2])];
        while let Some((level, [column, row], first, [u, v])) = to_visit.pop() {
            self.step()?;
            if level == 0 {
                self.cell(map, column, row)?;
                continue;
            }
            let round_up = 1_u32.wrapping_shl(level).wrapping_sub(1);
            let size = [map.grid_width, map.grid_height].map(|cells| cells.wrapping_add(round_up).wrapping_shr(level));
            let node = first.wrapping_add(row.wrapping_mul(size[0]).wrapping_add(column).wrapping_mul(3));
            let below = first.wrapping_add(size[0].wrapping_mul(size[1]).wrapping_mul(3));
            let split = u64::from(self.texel(node)?);
            for (right, u) in [(0, [u[0], u[1].min(split)]), (1, [u[0].max(split), u[1]])] {
                if u[0] >= u[1] {
                    continue;
                }
                let middle = u64::from(self.texel(node.wrapping_add(1 + right))?);
                for (lower, v) in [(0, [v[0], v[1].min(middle)]), (1, [v[0].max(middle), v[1]])] {
                    if v[0] < v[1] {
                        let place = [column.wrapping_mul(2) + right, row.wrapping_mul(2) + lower];
                        to_visit.push((level - 1, place, below, [u, v]));
                    }
                }
            }
        }
        Ok(())
    }

    fn cell(&self, map: &PackedMap, column: u32, row: u32) -> Read<()> {
        // A cell beyond the row's end is the next row's first: no other memory, and yet wrong.
        if column >= map.grid_width || row >= map.grid_height {
            return Err(format!("cell ({column}, {row})"));
        }
        self.texel(map.first_density.wrapping_add(row.wrapping_mul(map.grid_width)).wrapping_add(column)).map(drop)
    }
}

fn wrapped(index: i32, size: i32, wrap: u32) -> Read<i32> {
    let by_zero = || "a remainder by zero".to_owned();
    match wrap {
        1 => Ok(index.min(size.wrapping_sub(1)).max(0)),
        2 => {
            let period = size.wrapping_mul(2);
            let folded = index.checked_rem(period).ok_or_else(by_zero)?.wrapping_add(period) % period;
            Ok(if folded >= size { period.wrapping_sub(1).wrapping_sub(folded) } else { folded })
        }
        _ => Ok(index.checked_rem(size).ok_or_else(by_zero)?.wrapping_add(size) % size),
    }
}
