//! One array for all that shading looks up: materials and their further parameters, media, the parts and weights of blends, lights, the tree
//! of them, their profiles and their links, textures, motions, the spaces of objects.

use super::scene::PackedScene;

/// The tables as vec4s, and where each begins.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tables {
    pub words: Vec<[f32; 4]>,
    pub first_part: u32,
    pub first_layer: u32,
    pub first_blend_weight: u32,
    pub first_light: u32,
    pub first_texture: u32,
    pub first_motion: u32,
    pub first_further: u32,
    pub first_medium: u32,
    pub first_phase: u32,
    pub first_volume: u32,
    pub first_light_node: u32,
    pub first_light_profile: u32,
    pub first_object: u32,
    pub first_link: u32,
}

impl Tables {
    pub fn new(packed: &PackedScene) -> Self {
        let mut tables = Self::default();
        tables.append(&packed.materials.materials);
        tables.first_part = tables.append(&packed.materials.parts);
        tables.first_layer = tables.append(&packed.materials.layers);
        tables.first_blend_weight = tables.append(&packed.materials.weights);
        tables.first_light = tables.append(&packed.lights);
        tables.first_texture = tables.append(&packed.textures.textures);
        tables.first_motion = tables.append(&packed.motions);
        tables.first_further = tables.append(&packed.materials.further);
        tables.first_medium = tables.append(&packed.materials.media.media);
        tables.first_phase = tables.append(&packed.materials.media.phases);
        tables.first_volume = tables.append(&packed.materials.media.volumes.volumes);
        tables.first_light_node = tables.append(&packed.light_nodes);
        tables.first_light_profile = tables.append(&packed.light_profiles);
        tables.first_object = tables.append(&packed.objects);
        tables.first_link = tables.append(&packed.links.words());
        tables
    }

    /// Index of the first of the words added.
    fn append<T: bytemuck::Pod>(&mut self, rows: &[T]) -> u32 {
        let first = self.words.len() as u32;
        self.words.extend_from_slice(bytemuck::cast_slice(rows));
        first
    }
}

impl PackedScene {
    /// All that shading looks up, as one array of vec4.
    pub fn tables(&self) -> Tables {
        Tables::new(self)
    }
}
