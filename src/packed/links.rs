//! Light links in the device's tables: which receivers each lamp lights, and which receiver each surface is.
//!
//! A surface has its receiver with its material: a material of several receivers is packed once for each of them.

use std::collections::HashMap;

use super::instance::WorldInstance;
use super::material::PackedMaterials;
use super::primitive::WorldPrimitive;
use crate::scene::{LinkMask, ReceiverId, SEES_ALL, Scene};
use crate::shader::shared::shared_constants;

shared_constants!(constants {
    /// The receiver of paths that nothing has scattered yet.
    const SEES_ALL_LAMPS: u32 = SEES_ALL;
});

/// The links of a scene; nothing where every lamp lights everything.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PackedLinks {
    /// By packed material: the mask of what surfaces of it light, and the receiver that they are.
    pub materials: Vec<(LinkMask, ReceiverId)>,
    /// By light, its mask.
    pub lights: Vec<LinkMask>,
    /// By instance, the receiver that it is.
    pub instances: Vec<ReceiverId>,
    /// By medium, 0 for none, the receiver of places within.
    pub media: Vec<ReceiverId>,
    /// The mask of light from outside the scene.
    pub outside: Option<LinkMask>,
}

/// Places of the parts among the words of the links.
#[derive(Debug, Clone, Copy, Default)]
pub struct LinkPlaces {
    pub receivers: u32,
    pub lights: u32,
    pub instances: u32,
    pub media: u32,
}

/// Gives each surface that is a receiver of its own a material of its own, `materials` with the receivers of the scene's shapes.
pub fn split_materials(scene: &Scene, primitives: &mut [WorldPrimitive], materials: &mut PackedMaterials) -> Vec<ReceiverId> {
    let mut receivers: Vec<ReceiverId> = vec![0; materials.materials.len()];
    let mut known: HashMap<(usize, ReceiverId), usize> = HashMap::new();
    for primitive in primitives {
        let receiver = scene.shapes[primitive.shape].receiver;
        if receiver == 0 {
            continue;
        }
        primitive.material = *known.entry((primitive.material, receiver)).or_insert_with_key(|&(material, receiver)| {
            materials.materials.push(materials.materials[material]);
            materials.scene_ids.push(materials.scene_ids[material]);
            receivers.push(receiver);
            receivers.len() - 1
        });
    }
    receivers
}

impl PackedLinks {
    /// The links of surfaces with these packed materials and their receivers, of these lights, and of these instances.
    pub fn new(
        scene: &Scene,
        (materials, receivers): (&PackedMaterials, &[ReceiverId]),
        lights: Vec<LinkMask>,
        instances: &[WorldInstance],
    ) -> Self {
        let masks = materials.scene_ids.iter().map(|&id| scene.light_links.of_material(id));
        Self {
            materials: masks.zip(receivers.iter().copied()).collect(),
            lights,
            instances: instances.iter().map(|instance| instance.receiver).collect(),
            media: materials.media.receivers.clone(),
            outside: Some(scene.link_of_outside()),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.materials.is_empty()
    }

    /// The places of its parts.
    pub fn places(&self) -> LinkPlaces {
        let receivers = self.materials.len() as u32;
        let lights = 2 * receivers;
        let instances = lights + self.lights.len() as u32;
        LinkPlaces { receivers, lights, instances, media: instances + self.instances.len() as u32 }
    }

    /// All of them as vec4s, four numbers each: masks of materials, their receivers, masks of lights, receivers of instances and of media.
    pub fn words(&self) -> Vec<[f32; 4]> {
        let masks = self.materials.iter().map(|(mask, _)| mask.0);
        let receivers = self.materials.iter().map(|(_, receiver)| *receiver);
        let lights = self.lights.iter().map(|mask| mask.0);
        let all: Vec<u32> = masks
            .chain(receivers)
            .chain(lights)
            .chain(self.instances.iter().copied())
            .chain(self.media.iter().copied())
            .collect();
        let word = |numbers: &[u32]| std::array::from_fn(|place| f32::from_bits(numbers.get(place).copied().unwrap_or(0)));
        all.chunks(4).map(word).collect()
    }

    /// Checks that there is an entry for everything that kernels look up.
    pub(super) fn check(&self, [materials, lights, instances, media]: [usize; 4]) -> Result<(), String> {
        let found = [self.materials.len(), self.lights.len(), self.instances.len(), self.media.len()];
        if self.is_empty() || found == [materials, lights, instances, media] {
            return Ok(());
        }
        Err(format!(
            "links are of {found:?} materials, lights, instances and media, not {:?}",
            [materials, lights, instances, media]
        ))
    }
}
