//! A stack at one hit: where its interfaces and slabs are, and how each interface scatters light.

use glam::DVec3;

use super::layers::LayersOfMaterial;
use crate::reference::bsdf::{Bsdf, View};
use crate::reference::intersect::{Surface, UvSet};
use crate::scene::{Filling, Relief, Scene};
use crate::spectrum::Spectrum;
use crate::texture;

/// The smallest cosine with the normal by which a way through a slab is measured.
pub const SMALLEST_COSINE: f64 = 1e-6;

/// The layers at a hit. Gaps are counted from the outside above, 0: gap i lies above interface i, and the one below the last interface is the outside
/// again.
#[derive(Debug, Clone, Copy)]
pub struct Stack<'a> {
    pub scene: &'a Scene,
    pub surface: &'a Surface,
    pub layers: &'a LayersOfMaterial,
    /// The normal on the side of the first interface.
    pub up: DVec3,
}

/// A slab at a hit.
#[derive(Debug, Clone, Copy)]
pub struct SlabAtHit<'a> {
    pub filling: &'a Filling,
    pub thickness: f64,
    pub breadth: f64,
}

impl<'a> Stack<'a> {
    pub fn new(scene: &'a Scene, surface: &'a Surface, layers: &'a LayersOfMaterial, view: &View) -> Self {
        let up = if view.front || layers.mirrored { view.normal() } else { -view.normal() };
        Self { scene, surface, layers, up }
    }

    pub fn count(&self) -> usize {
        self.layers.layers.len()
    }

    /// The gap from which a direction that points away from the surface comes.
    pub fn outside(&self, direction: DVec3) -> usize {
        if direction.dot(self.up) > 0.0 { 0 } else { self.count() }
    }

    /// The slab in a gap, where it takes or scatters light.
    pub fn slab(&self, gap: usize) -> Option<SlabAtHit<'a>> {
        let layer = &self.layers.layers[gap.checked_sub(1)?];
        let thickness = &layer.flat.slab.thickness;
        let filling = layer.filling.as_ref()?;
        let thickness = texture::evaluate(self.scene, thickness, self.surface.coordinates()).r();
        Some(SlabAtHit { filling, thickness, breadth: if thickness > 0.0 { layer.flat.slab_breadth } else { 0.0 } })
    }

    /// The interface that light meets which goes through a gap in a direction; None where it goes to the outside.
    pub fn ahead(&self, gap: usize, direction: DVec3) -> Option<usize> {
        if direction.dot(self.up) < 0.0 { (gap < self.count()).then_some(gap) } else { gap.checked_sub(1) }
    }

    /// The gap into which an interface sends light in a direction.
    pub fn behind(&self, interface: usize, direction: DVec3) -> usize {
        if direction.dot(self.up) > 0.0 { interface } else { interface + 1 }
    }

    /// An interface as a way through the stack sees it that carries this much, from wo.
    pub fn interface(&self, number: usize, wo: DVec3, carried: Spectrum, u_blend: f64) -> Bsdf {
        let material = self.layers.layers[number].flat.interface;
        let mut surface = *self.surface;
        surface.owner.material = material;
        surface.point.normal = self.up;
        surface.shading_normal = self.normal_of(number);
        surface.coat_normal = self.layers.layers[number].coat_differs.then_some(self.up);
        surface.unperturbed_normal = None;
        surface.is_mirrored = false;
        surface.by_camera = false;
        surface.carried = carried;
        Bsdf::new(self.scene, &surface, wo, u_blend)
    }

    /// The normal of an interface on its upper side, as its own map bends it.
    fn normal_of(&self, number: usize) -> DVec3 {
        let material = &self.scene.materials[self.layers.layers[number].flat.interface];
        let Some(id) = material.normal_map else { return self.up };
        let map = &self.scene.textures[id];
        let (Relief::Normals(scale), Some(tangents)) = (map.relief, self.surface.tangents_of(UvSet::of_directions(map))) else {
            return self.up;
        };
        let texel = texture::look_up(&self.scene.textures, id, self.surface.coordinates()).to_vector();
        tangents.direction(self.up, texel, scale).unwrap_or(self.up)
    }
}
