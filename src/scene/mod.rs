//! What a person wrote, resolved: names looked up, files read, units known, nothing of the GPU.
//!
//! A [`Scene`] is plain data. [`crate::flat`] packs it for the device, [`crate::reference`] renders it as it stands, so
//! that a mistake in packing shows as a difference between the two.
//!
//! Conventions: right-handed, +Y up by default, lengths in scene units, angles in degrees as written and in radians where a
//! name says so, colours linear Rec.709 RGB, radiance in W·sr⁻¹·m⁻².

pub mod camera;
mod digest;
pub mod light;
pub mod material;
pub mod settings;
pub mod shape;
mod summary;
pub mod texture;
pub mod transform;

pub use camera::{Aperture, ApertureShape, Camera, Projection};
pub use digest::digest;
pub use light::{Environment, EnvironmentRadiance, Light};
pub use material::{ConductorFresnel, Emission, Heuristic, Material, MaterialKind, MicrofacetDistribution};
pub use settings::{
    BlendMode, Estimator, FilmSettings, Filter, FilterKind, HemisphereSampling, LightSampling, MisHeuristic, PixelSampler,
    RenderSettings, SamplerKind, setting_name,
};
pub use shape::{Geometry, Mesh, Shape};
pub use summary::SceneSummary;
pub use texture::{ColorInput, ColorSpace, ImageData, ImageTexture, Texture, TextureFilter, TextureKind, TextureWrap};
pub use transform::{Transform, TransformStep};

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
}
