//! The stacks of a scene, made ready.

use crate::scene::{Filling, FlatLayer, LayerModel, MaterialId, MaterialKind, Scene};

/// An interface and the slab below it.
#[derive(Debug, Clone)]
pub struct Layer {
    pub flat: FlatLayer,
    /// None where the slab takes and scatters nothing.
    pub filling: Option<Filling>,
    /// A coat of the interface lies about another normal than the base below it.
    pub coat_differs: bool,
}

/// The layers of a material from the front to the back, and how they are seen.
#[derive(Debug, Clone)]
pub struct LayersOfMaterial {
    pub layers: Vec<Layer>,
    pub model: LayerModel,
    pub mirrored: bool,
    /// The largest breadth of all interfaces and slabs.
    pub most_breadth: f64,
    /// Some slab scatters.
    pub scatters: bool,
}

/// The stacks of a scene by material.
#[derive(Debug, Clone)]
pub struct LayersOfMaterials(Vec<Option<LayersOfMaterial>>);

impl LayersOfMaterials {
    pub fn new(scene: &Scene) -> Self {
        Self((0..scene.materials.len()).map(|material| LayersOfMaterial::new(scene, material)).collect())
    }

    /// None of a material that is no stack.
    pub fn of(&self, material: MaterialId) -> Option<&LayersOfMaterial> {
        self.0[material].as_ref()
    }

    pub fn is_empty(&self) -> bool {
        self.0.iter().all(Option::is_none)
    }
}

impl LayersOfMaterial {
    fn new(scene: &Scene, material: MaterialId) -> Option<Self> {
        let MaterialKind::Layered(kind) = &scene.materials[material].kind else { return None };
        // A checked scene has no stack that is too high.
        let flat = scene.flat_layers(material).ok()??;
        let most_breadth = flat.iter().flat_map(|layer| [layer.breadth, layer.slab_breadth]).fold(0.0, f64::max);
        let filling =
            |layer: &FlatLayer| layer.slab.medium.map(|id| Filling::of(&scene.media[id])).filter(|filling| !filling.is_clear());
        let coats_differ = scene.coat_normals_differ();
        let layers: Vec<Layer> = flat
            .iter()
            .map(|&flat| Layer { flat, filling: filling(&flat), coat_differs: coats_differ[flat.interface] })
            .collect();
        let scatters = layers.iter().filter_map(|layer| layer.filling.as_ref()).any(Filling::scatters);
        Some(Self { layers, model: kind.model, mirrored: kind.mirrored, most_breadth, scatters })
    }
}
