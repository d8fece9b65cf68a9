//! What a person wrote, resolved: names looked up, files read, units known, nothing of the GPU.
//!
//! A [`Scene`] is plain data. [`crate::packed`] packs it for the device, [`crate::reference`] renders it as it stands, so
//! that a mistake in packing shows as a difference between the two.
//!
//! Conventions: right-handed, +Y up by default, lengths in scene units, angles in degrees as written and in radians where a
//! name says so, colours linear Rec.709 RGB, radiance in W·sr⁻¹·m⁻².

mod blend_tree;
pub mod camera;
mod digest;
pub mod light;
pub mod material;
mod mesh;
pub mod motion;
mod placement;
pub mod settings;
pub mod shape;
mod summary;
pub mod texture;
pub mod transform;
pub mod validate;

pub use blend_tree::{MOST_LEAVES, check_blends};
pub use camera::{Aperture, ApertureShape, Camera, Projection};
pub use digest::digest;
pub use light::{Environment, EnvironmentRadiance, Light};
pub use material::{BlendWeight, ConductorFresnel, Emission, Material, MaterialKind, MicrofacetDistribution};
pub use motion::{Motion, MotionStep};
pub use settings::{
    BlendMode, Estimator, FilmSettings, Filter, FilterKind, HemisphereSampling, LightSampling, MisHeuristic, PixelSampler,
    PixelSamplerName, RenderSettings, SamplerKind, setting_name,
};
pub use shape::{Geometry, Mesh, Shape};
pub use summary::SceneSummary;
pub use texture::{ColorInput, ColorSpace, ImageData, ImageTexture, Texture, TextureFilter, TextureKind, TextureWrap};
pub use transform::{Transform, TransformStep};
pub use validate::InvalidScene;

/// Index into [`Scene::materials`].
pub type MaterialId = usize;
/// Index into [`Scene::textures`].
pub type TextureId = usize;

/// Everything a render needs, resolved and checked.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    /// File stem or built-in name; the default output is `name.exr`.
    pub name: String,
    pub film: FilmSettings,
    pub render: RenderSettings,
    pub camera: Camera,
    pub textures: Vec<Texture>,
    pub materials: Vec<Material>,
    pub shapes: Vec<Shape>,
    /// Lights that are not surfaces. Surfaces emit through their material.
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
