//! The scene itself.

use std::sync::Arc;

use glam::DMat3;

use super::animation::Animation;
use super::camera::Camera;
use super::import_report::ImportReport;
use super::instance::{Group, Instances};
use super::light::{Environment, EnvironmentRadiance, Light};
use super::light_groups::LightGroups;
use super::light_links::LightLinks;
use super::material::{Material, MaterialId, MaterialKind};
use super::medium::{Medium, MediumId};
use super::meter::Meter;
use super::settings::{FilmSettings, RenderSettings};
use super::shape::Shape;
use super::sources::Sources;
use super::texture::Texture;
use crate::layer::{KernelLayer, Layer};

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
    /// Layers that are written beside the picture.
    #[doc(hidden)]
    pub layers: Vec<Layer>,
    /// The layer that this scene was made ready for, whose kernels need more of it than those of the picture. Scene files have no key for it.
    #[doc(hidden)]
    pub ready_for: Option<KernelLayer>,
    #[doc(hidden)]
    pub camera: Camera,
    /// The camera at [`EXPOSURE_STRETCHES`](crate::scene::EXPOSURE_STRETCHES) + 1 times, evenly from the shutter's opening to its closing, between
    /// which it moves evenly; empty where it rests meanwhile.
    #[doc(hidden)]
    pub exposure: Vec<Camera>,
    #[doc(hidden)]
    pub textures: Vec<Texture>,
    #[doc(hidden)]
    pub materials: Vec<Material>,
    /// The media that materials enclose and that the camera may be within.
    #[doc(hidden)]
    pub media: Vec<Medium>,
    /// The medium that the camera is within.
    #[doc(hidden)]
    pub camera_medium: Option<MediumId>,
    #[doc(hidden)]
    pub shapes: Vec<Shape>,
    /// Meshes that are stored once, and where they stand.
    #[doc(hidden)]
    pub groups: Vec<Group>,
    #[doc(hidden)]
    pub instances: Vec<Instances>,
    /// Lights that are not surfaces. Surfaces emit through their material.
    #[doc(hidden)]
    pub lights: Vec<Light>,
    /// The names under which light of some emitters is kept apart.
    #[doc(hidden)]
    pub light_groups: LightGroups,
    /// Which lamps light which objects.
    #[doc(hidden)]
    pub light_links: LightLinks,
    /// Places where light is measured.
    #[doc(hidden)]
    pub meters: Vec<Meter>,
    /// Parts that could not be taken as written and were replaced or left out, in sentences that name the
    /// file.
    pub warnings: Vec<String>,
    /// Parts of an imported file that are not rendered exactly.
    #[doc(hidden)]
    pub import_report: ImportReport,
    /// The keyframes, by which parts of the scene are elsewhere at another frame; see [`Scene::at_frame`].
    #[doc(hidden)]
    pub animation: Arc<Animation>,
    /// The first poses, in a frame in which shapes or lights may be elsewhere than in others: the shapes with keyframes, each as it is turned and scaled at the first frame of all keys. Trees are built in these poses and then follow. None for the scene at rest.
    #[doc(hidden)]
    pub first_poses: Option<Arc<[(usize, DMat3)]>>,
    /// The files that meshes and pictures came from.
    #[doc(hidden)]
    pub sources: Sources,
}

impl Scene {
    /// Something gives light: a light, a surface whose material emits, or a medium that does.
    #[doc(hidden)]
    pub fn has_light(&self) -> bool {
        let glows = |medium: Option<MediumId>| medium.is_some_and(|id| !self.media[id].emission.is_black());
        if !self.lights.is_empty() || glows(self.camera_medium) {
            return true;
        }
        let emitting = self.materials_that(|part| part.emission.is_some() || glows(part.interior));
        self.shapes.iter().any(|shape| shape.materials().any(|id| emitting[id]))
    }

    /// Emitters or pictures around the scene shine through glass or by mirrors onto what else there is: paths meet such light by chance, and where few do,
    /// what they have seen says little of what there is.
    #[doc(hidden)]
    pub fn has_light_by_chance(&self) -> bool {
        let [gathering, emitting] = [Material::gathers_light as fn(&Material) -> bool, |material| material.emission.is_some()]
            .map(|wanted| self.materials_that(wanted));
        let shapes = || self.shapes.iter().chain(self.groups.iter().flat_map(|group| &group.shapes));
        let is_shown = |which: &[bool]| shapes().any(|shape| shape.materials().any(|id| which[id]));
        is_shown(&gathering) && (is_shown(&emitting) || self.has_environment_map())
    }

    /// Says that a picture around the scene gives light.
    #[doc(hidden)]
    pub fn has_environment_map(&self) -> bool {
        let is_map =
            |light: &Light| matches!(light, Light::Environment(Environment { radiance: EnvironmentRadiance::Map(_), .. }));
        self.lights.iter().any(is_map)
    }

    /// Takes out what fills the space: only surfaces are left.
    #[doc(hidden)]
    pub fn clear_media(&mut self) {
        self.camera_medium = None;
        self.materials.iter_mut().for_each(|material| material.interior = None);
    }

    /// For each material, true if it, or one of those that it is made of at any depth, is as `wanted`. The search goes from those that are up to all that are made of them, so the time does not depend on how deep blends are nested.
    #[doc(hidden)]
    pub fn materials_that(&self, wanted: impl Fn(&Material) -> bool) -> Vec<bool> {
        let mut wholes: Vec<Vec<MaterialId>> = vec![Vec::new(); self.materials.len()];
        for (id, material) in self.materials.iter().enumerate() {
            // Parts that do not exist are for the check of the scene to refuse.
            material.components().iter().for_each(|&part| wholes.get_mut(part).into_iter().for_each(|wholes| wholes.push(id)));
        }
        let mut found: Vec<bool> = self.materials.iter().map(wanted).collect();
        let mut to_visit: Vec<MaterialId> = (0..found.len()).filter(|&id| found[id]).collect();
        while let Some(id) = to_visit.pop() {
            for &whole in &wholes[id] {
                if !std::mem::replace(&mut found[whole], true) {
                    to_visit.push(whole);
                }
            }
        }
        found
    }

    /// For each material, what it has of its own, as listed; for a blend that has nothing, what the first part has, at any depth, one that is `preferred`
    /// before others. Each material is visited once.
    #[doc(hidden)]
    pub fn with_that_of_parts<T: Clone>(&self, mut own: Vec<Option<T>>, preferred: impl Fn(&T) -> bool) -> Vec<Option<T>> {
        // Parts before wholes. A blend that is a part of itself is for the check of the scene to refuse.
        let mut is_entered = vec![false; own.len()];
        let mut to_visit = Vec::new();
        for root in 0..own.len() {
            to_visit.push((root, false));
            while let Some((id, parts_are_known)) = to_visit.pop() {
                let parts = self.materials[id].parts();
                if parts_are_known {
                    if own[id].is_none() {
                        let of_parts = || parts.iter().filter_map(|&part| own[part].as_ref());
                        own[id] = of_parts().find(|of| preferred(of)).or_else(|| of_parts().next()).cloned();
                    }
                } else if !parts.is_empty() && !std::mem::replace(&mut is_entered[id], true) {
                    to_visit.push((id, true));
                    to_visit.extend(parts.iter().map(|&part| (part, false)));
                }
            }
        }
        own
    }

    /// For each material, true if its coat, or that of one that it blends at any depth, lies about another normal than the base below it.
    #[doc(hidden)]
    pub fn coat_normals_differ(&self) -> Vec<bool> {
        let is_coated =
            |material: &Material| matches!(&material.kind, MaterialKind::Principled(principled) if principled.is_coated());
        let coated = self.materials_that(is_coated);
        let mapped = self.materials_that(Material::has_coat_normal_map);
        let differs = |id: MaterialId| mapped[id] || (coated[id] && self.materials[id].normal_map.is_some());
        (0..self.materials.len()).map(differs).collect()
    }

    /// For each material, true of a stack in which an interface has a normal map of its own.
    #[doc(hidden)]
    pub fn layers_are_bent(&self) -> Vec<bool> {
        let bent = |&id: &MaterialId| self.materials[id].normal_map.is_some();
        let own = |material: &Material| !material.is_blend() && material.components().iter().any(bent);
        self.materials_that(own)
    }

    /// The material emits, by itself or through a part of it.
    #[doc(hidden)]
    pub fn emits(&self, material: MaterialId) -> bool {
        self.any_part(material, &|part| part.emission.is_some())
    }

    /// True if the material or one of those it blends, at any depth, is as `wanted`.
    pub(super) fn any_part(&self, material: MaterialId, wanted: &dyn Fn(&Material) -> bool) -> bool {
        let mut seen = vec![false; self.materials.len()];
        let mut to_visit = vec![material];
        while let Some(id) = to_visit.pop() {
            let part = &self.materials[id];
            if wanted(part) {
                return true;
            }
            if !std::mem::replace(&mut seen[id], true) {
                to_visit.extend_from_slice(part.components());
            }
        }
        false
    }
}
