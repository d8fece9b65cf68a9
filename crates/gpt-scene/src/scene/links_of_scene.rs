//! A scene's light links: the receivers of its objects, and what must hold of masks.

use super::light::Light;
use super::light_links::{LinkMask, ReceiverId};
use super::material::{MaterialId, MaterialKind};
use super::model::Scene;

impl Scene {
    /// The mask of the light from outside the scene.
    pub fn link_of_outside(&self) -> LinkMask {
        let outside = self.lights.iter().position(Light::is_environment);
        outside.map_or(LinkMask::ALL, |index| self.light_links.of_light(index))
    }

    /// The receivers of all shapes, and behind them of all instances, one for each place; empty where no lamp asks.
    pub fn receivers(&self) -> Vec<ReceiverId> {
        if self.light_links.is_empty() {
            return Vec::new();
        }
        let of_shapes = self.shapes.iter().map(|shape| shape.receiver);
        of_shapes.chain(self.receivers_of_instances()).collect()
    }

    /// The receivers of all instances, one for each place.
    pub fn receivers_of_instances(&self) -> impl Iterator<Item = ReceiverId> + '_ {
        self.instances.iter().flat_map(|entry| std::iter::repeat_n(entry.receiver, entry.places.len()))
    }

    /// The light from outside has one mask, and a blend says what its parts light.
    pub(super) fn check_light_links(&self) -> Result<(), String> {
        let mut outside = self.lights.iter().enumerate().filter(|(_, light)| light.is_environment());
        let all = self.link_of_outside();
        if outside.any(|(index, _)| self.light_links.of_light(index) != all) {
            return Err("all light from outside the scene lights the same receivers".to_owned());
        }
        self.check_links_of_blends().map_err(|(_, message)| message)
    }

    /// A blend says what its parts light; the error is the blend and the mistake in words.
    pub(crate) fn check_links_of_blends(&self) -> Result<(), (MaterialId, String)> {
        for (id, material) in self.materials.iter().enumerate() {
            let MaterialKind::Blend { materials, .. } = &material.kind else { continue };
            let own = self.light_links.of_material(id);
            let other = materials.iter().find(|part| ![LinkMask::ALL, own].contains(&self.light_links.of_material(**part)));
            if let Some(&part) = other {
                let message = format!(
                    "the material `{}` is a part of the blend `{}` and says by itself what it lights: surfaces of the blend light as the blend says, so say it there",
                    self.materials[part].name, material.name
                );
                return Err((id, message));
            }
        }
        Ok(())
    }
}
