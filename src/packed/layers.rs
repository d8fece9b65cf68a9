//! Stacks of layers as the device reads them: a run of layers, from the front to the back.

use std::collections::{BTreeSet, HashSet};

use super::error::PackError;
use super::medium::PackedMedia;
use super::texture::color_and_texture;
use crate::scene::{Filling, FlatLayer, LayerModel, LayerStack, MaterialId, MaterialKind, Scene};
use crate::shader::shared::shared_constants;

shared_constants!(constants {
    /// Words of a layer in the tables.
    const LAYER_WORDS: u32 = (size_of::<PackedLayer>() / 16) as u32;
    /// Flags of a stack, above its number of layers: the first lies on the side from which it is seen; light goes straight down and up.
    pub const LAYERS_MIRRORED: u32 = 1 << 16;
    pub const LAYERS_STRAIGHT: u32 = 1 << 17;
    /// Some slab scatters.
    pub const LAYERS_SCATTER: u32 = 1 << 18;
    /// Flags of a slab: it takes or scatters light; it scatters.
    const SLAB_FILLED: u32 = 1;
    const SLAB_SCATTERS: u32 = 2;
});

/// Bits of the number of a stack's layers.
pub const LAYER_COUNT: u32 = 0xffff;

/// One interface and the slab below it: 64 bytes, four vec4 of the tables.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PackedLayer {
    pub interface: u32,
    /// [`FlatLayer::breadth`](crate::scene::FlatLayer), and the index of refraction by which a smooth one would bend light.
    pub breadth: f32,
    pub ior: f32,
    pub slab_flags: u32,
    /// Per unit length.
    pub extinction: [f32; 3],
    pub thickness: f32,
    /// Per unit length.
    pub scattering: [f32; 3],
    pub slab_breadth: f32,
    /// Index of the texture that the thickness is multiplied by, or NONE.
    pub thickness_texture: u32,
    /// The first of its phase lobes, and above `PHASE_COUNT_SHIFT` their number.
    pub phase: u32,
    pub unused: [u32; 2],
}

/// The run of a stack's layers, as its material names it.
#[derive(Debug, Clone, Copy)]
pub struct LayerRun {
    pub first: u32,
    pub count_and_flags: u32,
    pub most_breadth: f32,
}

impl LayerRun {
    /// Packs the layers of a stack; interfaces keep the scene's numbers until their places are known.
    pub fn new(
        scene: &Scene,
        (id, kind): (MaterialId, &LayerStack),
        layers: &mut Vec<PackedLayer>,
        media: &mut PackedMedia,
    ) -> Result<Self, PackError> {
        let first = layers.len() as u32;
        let error = |message: String| PackError::Inconsistent(message);
        let flat = scene.flat_layers(id).map_err(error)?.unwrap_or_default();
        let most_breadth = flat.iter().flat_map(|layer| [layer.breadth, layer.slab_breadth]).fold(0.0, f64::max);
        for layer in &flat {
            layers.push(packed_layer(scene, layer, media)?);
        }
        let scatters = layers[first as usize..].iter().any(|layer| layer.slab_flags & SLAB_SCATTERS != 0);
        let flag = |is_set: bool, flag: u32| if is_set { flag } else { 0 };
        let count_and_flags = flat.len() as u32
            | flag(kind.mirrored, LAYERS_MIRRORED)
            | flag(kind.model == LayerModel::Straight, LAYERS_STRAIGHT)
            | flag(scatters, LAYERS_SCATTER);
        Ok(Self { first, count_and_flags, most_breadth: most_breadth as f32 })
    }
}

fn packed_layer(scene: &Scene, layer: &FlatLayer, media: &mut PackedMedia) -> Result<PackedLayer, PackError> {
    let filling = layer.slab.medium.map(|id| Filling::of(&scene.media[id])).filter(|filling| !filling.is_clear());
    let ([thickness, ..], thickness_texture) = color_and_texture(&layer.slab.thickness);
    let mut packed = PackedLayer {
        interface: layer.interface as u32,
        breadth: layer.breadth as f32,
        ior: layer.ior as f32,
        slab_flags: 0,
        extinction: [0.0; 3],
        thickness,
        scattering: [0.0; 3],
        slab_breadth: layer.slab_breadth as f32,
        thickness_texture,
        phase: 0,
        unused: [0; 2],
    };
    if let Some(filling) = filling {
        packed.slab_flags = SLAB_FILLED | if filling.scatters() { SLAB_SCATTERS } else { 0 };
        packed.extinction = filling.extinction.to_f32();
        packed.scattering = filling.scattering.to_f32();
        packed.phase = media.phase(&filling.phase)?;
    }
    Ok(packed)
}

/// The materials of surfaces, with those that their stacks are made of, at any depth.
pub fn with_interfaces(scene: &Scene, of_surfaces: impl Iterator<Item = MaterialId>) -> BTreeSet<MaterialId> {
    let mut found: BTreeSet<MaterialId> = of_surfaces.collect();
    let mut visited = HashSet::new();
    let mut to_visit: Vec<MaterialId> = found.iter().copied().collect();
    while let Some(id) = to_visit.pop() {
        if !visited.insert(id) {
            continue;
        }
        let material = &scene.materials[id];
        if let MaterialKind::Layered(layers) = &material.kind {
            found.insert(id);
            found.extend(&layers.interfaces);
        }
        to_visit.extend_from_slice(material.components());
    }
    found
}

impl PackedLayer {
    /// The mention of a texture.
    pub fn texture_mut(&mut self) -> &mut u32 {
        &mut self.thickness_texture
    }

    /// The slab takes or scatters light.
    pub fn is_filled(&self) -> bool {
        self.slab_flags != 0
    }

    /// The slab scatters light.
    pub fn scatters(&self) -> bool {
        self.slab_flags & SLAB_SCATTERS != 0
    }

    /// A sentence about flags that are not there, or a run of phase lobes outside of the table.
    pub(super) fn check(&self, phases: usize) -> Result<(), String> {
        if self.slab_flags & !(SLAB_FILLED | SLAB_SCATTERS) != 0 {
            return Err(format!("has a slab with the flags {:#x}", self.slab_flags));
        }
        if !PackedMedia::has_phase(self.phase, phases) && self.slab_flags != 0 {
            return Err(format!("has a slab with the phase lobes {:#x}", self.phase));
        }
        Ok(())
    }
}
