//! The scene itself.

use super::camera::Camera;
use super::light::Light;
use super::material::{Material, MaterialId, MaterialKind};
use super::settings::{FilmSettings, RenderSettings};
use super::shape::{Geometry, Shape};
use super::texture::Texture;

/// Everything a render needs: a camera, surfaces, materials, lights, and how light is estimated. It is read by [`Scene::load`] or
/// [`Scene::from_toml`].
#[derive(Debug, Clone, Default)]
pub struct Scene {
    /// File stem or built-in name; the default output is `name.exr`.
    pub name: String,
    /// The picture's size and reconstruction filter.
    pub film: FilmSettings,
    /// How light is estimated, and by how many samples.
    pub render: RenderSettings,
    #[doc(hidden)]
    pub camera: Camera,
    #[doc(hidden)]
    pub textures: Vec<Texture>,
    #[doc(hidden)]
    pub materials: Vec<Material>,
    #[doc(hidden)]
    pub shapes: Vec<Shape>,
    /// Lights that are not surfaces. Surfaces emit through their material.
    #[doc(hidden)]
    pub lights: Vec<Light>,
    /// What could not be taken as written and was replaced or left out, in sentences that name the file.
    pub warnings: Vec<String>,
}

impl Scene {
    /// Something gives light: a light, or a surface whose material emits.
    pub fn has_light(&self) -> bool {
        let emits = |shape: &Shape| match &shape.geometry {
            Geometry::Mesh(mesh) if !mesh.face_materials.is_empty() => mesh.face_materials.iter().any(|&id| self.emits(id)),
            _ => self.emits(shape.material),
        };
        !self.lights.is_empty() || self.shapes.iter().any(emits)
    }

    /// The material emits, by itself or through a part of it.
    pub fn emits(&self, material: MaterialId) -> bool {
        self.any_part(material, &|part| part.emission.is_some())
    }

    /// The material, or a part of it, emits from its back as well as from its front.
    pub fn emits_from_both_sides(&self, material: MaterialId) -> bool {
        self.any_part(material, &|part| part.emission.is_some_and(|emission| emission.two_sided))
    }

    /// The material or a part of it looks up a texture.
    pub fn uses_texture(&self, material: MaterialId) -> bool {
        self.any_part(material, &|part| part.uses_texture())
    }

    /// Whether the material or one of those it blends, at any depth, is as `wanted`.
    fn any_part(&self, material: MaterialId, wanted: &dyn Fn(&Material) -> bool) -> bool {
        let mut seen = vec![false; self.materials.len()];
        let mut to_visit = vec![material];
        while let Some(id) = to_visit.pop() {
            let part = &self.materials[id];
            if wanted(part) {
                return true;
            }
            if let MaterialKind::Blend { materials, .. } = &part.kind
                && !std::mem::replace(&mut seen[id], true)
            {
                to_visit.extend_from_slice(materials);
            }
        }
        false
    }
}
