//! The scene as a person wrote it, resolved: names looked up, files read, units known, nothing of the GPU.
//!
//! A [`Scene`] is plain data. The crate `gpt-pathtracer` packs it for the device, its reference renders it as it stands, so
//! that a mistake in packing shows as a difference between the two.
//!
//! Conventions: right-handed, +Y up by default, lengths in scene units, angles in degrees as written and in radians where a
//! name says so, colours linear Rec.709 RGB, radiance in W·sr⁻¹·m⁻².

pub mod animation;
mod blend_tree;
mod boundaries;
pub mod camera;
mod check;
mod digest;
mod flat_layers;
mod frame;
pub mod image;
mod import_report;
mod instance;
pub mod light;
mod light_at;
pub mod light_groups;
pub mod light_links;
mod light_of_groups;
mod links_of_scene;
pub mod material;
pub mod media;
pub mod medium;
pub mod medium_grids;
mod meter;
mod meter_view;
mod model;
pub mod motion;
mod placed_groups;
mod placement;
mod precision;
mod seen_by;
pub mod settings;
pub mod shape;
mod sources;
mod summary;
pub mod texture;
pub mod transform;
pub mod validate;
pub mod volume;

pub use animation::Animation;
pub use blend_tree::{MOST_LEAVES, check_blends};
pub use camera::{
    Aperture, ApertureShape, BrownConrady, Camera, CameraPreset, CubeLayout, CubeMap, Cylindrical, EXPOSURE_STRETCHES,
    Equirectangular, Eyes, Fisheye, FisheyeFit, FisheyeMapping, Intrinsics, KannalaBrandt, Projection, Stereo, StereoLayout,
    ViewPlace, Window,
};
pub use check::FARTHEST;
pub use digest::{BulkDigest, digest};
pub use flat_layers::FlatLayer;
pub use image::{Channel, ColorSpace, ImageData, Texels};
pub use import_report::{ImportReport, ReportItem};
pub use instance::{Group, Instances, is_singular};
pub use light::{
    AimedProfile, DirectionalLight, Environment, EnvironmentRadiance, FalloffCurve, Light, LightParameters, LightProfile,
    LightStrength, MapRows, OutsideParameters, PointLight, ProjectedTexture, Projector, Sky, SpotLight,
};
pub use light_groups::{LightGroupId, LightGroups};
pub use light_links::{LightLinks, LinkMask, ReceiverId, SEES_ALL};
pub use material::{
    Attenuation, BlendWeight, CoatNormalMap, ConductorFresnel, Dispersion, Emission, LayerModel, LayerStack, LobeKind,
    LobeParameters, LobeSupport, Masking, Material, MaterialId, MaterialKind, MicrofacetDistribution, Microfacets,
    PlasticInterface, Principled, RoughDiffuseModel, Slab, Subsurface, ThinFilm,
};
pub use media::{Filling, Media};
pub use medium::{Medium, MediumId, Phase, PhaseKind, PhaseLobe};
pub use medium_grids::{GridsOfMedium, MediumGrids};
pub use meter::{LUMEN_PER_WATT, Meter, MeterKind};
pub use model::Scene;
pub use motion::{Motion, MotionStep};
pub use settings::{
    BlendMode, DistanceSampling, Emitters, Estimator, FilmSettings, Filter, FilterKind, Guiding, HemisphereSampling, LightChoice,
    LightSampling, MisHeuristic, NumberOrAuto, PhongCosine, PhongHorizon, PhongSampling, PixelSampler, RenderSettings,
    SamplerKind,
};
pub use shape::*;
pub use sources::{GridSource, ImageSource, MeshSource, Sources};
pub use summary::{FEW_PRIMITIVES, SceneSummary};
pub use texture::{
    ChannelInput, ColorInput, ImageTexture, Relief, Texture, TextureFilter, TextureId, TextureKind, TextureWrap, UvTransform,
};
pub use transform::{Transform, TransformStep};
pub use validate::InvalidScene;
pub use volume::{Majorants, Outside, Volume, VolumeFilter, VoxelGrid};
