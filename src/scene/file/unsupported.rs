//! What a scene file may ask for and the renderers do not do yet. This is the one place that knows: what comes to work is taken out
//! here.

use super::document::Step;
use super::document::Step::{Index, Key};
use crate::scene::{Material, Scene};

/// Something that is refused: where it is written and what it is called.
pub struct Refusal {
    pub path: Vec<Step>,
    pub feature: String,
}

/// The first thing in the scene that no renderer does.
pub fn find(scene: &Scene) -> Option<Refusal> {
    materials(scene)
}

fn refuse(path: impl Into<Vec<Step>>, feature: impl Into<String>) -> Option<Refusal> {
    Some(Refusal { path: path.into(), feature: feature.into() })
}

fn materials(scene: &Scene) -> Option<Refusal> {
    scene.materials.iter().enumerate().find_map(|(index, material)| self::material(index, material))
}

fn material(index: usize, material: &Material) -> Option<Refusal> {
    material.normal_map.and_then(|_| refuse([Key("material"), Index(index), Key("normal_map")], "a normal map"))
}
