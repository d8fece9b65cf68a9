//! `[film]` and `[render]`: how large the picture is and how it is estimated.

use std::fmt;

use clap::ValueEnum;
use schemars::JsonSchema;
use serde::Deserialize;

/// The picture's size and reconstruction filter.
#[derive(Debug, Clone, PartialEq)]
pub struct FilmSettings {
    /// Width and height in pixels, both at least 1.
    pub size: [u32; 2],
    pub filter: Filter,
}

impl Default for FilmSettings {
    fn default() -> Self {
        Self { size: [512, 512], filter: Filter::default() }
    }
}

/// Reconstruction filter; samples are drawn from it, so every sample has weight 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Filter {
    pub kind: FilterKind,
    /// Half the filter's width, in pixels.
    pub radius: f64,
}

impl Default for Filter {
    fn default() -> Self {
        Self { kind: FilterKind::Box, radius: 0.5 }
    }
}

/// As people read it: the scene file's name and the radius.
impl fmt::Display for Filter {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self.kind {
            FilterKind::Box => "box",
            FilterKind::Tent => "tent",
            FilterKind::Gaussian => "gaussian",
            FilterKind::BlackmanHarris => "blackman_harris",
        };
        write!(out, "{name}, radius {}", self.radius)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilterKind {
    Box,
    Tent,
    Gaussian,
    BlackmanHarris,
}

/// How radiance is estimated. The scene file sets the defaults, the command line overrides them.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderSettings {
    /// Samples per pixel, at least 1.
    pub spp: u32,
    /// Path edges: 1 = only light seen directly, 2 = plus direct lighting, 0 = unlimited (Russian roulette ends paths).
    pub max_depth: u32,
    pub sampler: SamplerKind,
    /// The sampler of the pixel's own two dimensions.
    pub pixel_sampler: PixelSampler,
    pub estimator: Estimator,
    pub heuristic: MisHeuristic,
    /// First depth at which Russian roulette may end a path; 0 = never.
    pub roulette_depth: u32,
    /// Key of every random number of the render.
    pub seed: u32,
    pub hemisphere: HemisphereSampling,
    pub light_sampling: LightSampling,
    /// Light samples at the first surfaces of a path, 1 to [`MOST_LIGHT_SAMPLES`]; every later surface takes one.
    pub light_samples: u32,
    /// Of which edges the surfaces at their ends take `light_samples`: of that many from the camera on, 1 to
    /// [`MOST_LIGHT_SAMPLES_DEPTH`].
    pub light_samples_depth: u32,
    pub blend: BlendMode,
}

/// Most light samples at a surface.
pub const MOST_LIGHT_SAMPLES: u32 = 16;
/// Most edges of a path whose surfaces take more than one: their points stand in a table that has to fit a uniform buffer.
pub const MOST_LIGHT_SAMPLES_DEPTH: u32 = 3;

impl RenderSettings {
    /// How many light samples the surface at the end of a path's edge number `edge` takes: 1 is the camera's ray.
    pub fn light_samples_at(&self, edge: u32) -> u32 {
        if (1..=self.light_samples_depth).contains(&edge) { self.light_samples } else { 1 }
    }
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            spp: 256,
            max_depth: 16,
            // Measured: docs/strategies.md.
            sampler: SamplerKind::Sobol,
            pixel_sampler: PixelSampler::SameAsPath,
            estimator: Estimator::Mis,
            heuristic: MisHeuristic::Power,
            roulette_depth: 5,
            seed: 0,
            hemisphere: HemisphereSampling::Cosine,
            light_sampling: LightSampling::Cone,
            light_samples: 1,
            light_samples_depth: 1,
            blend: BlendMode::Mixture,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SamplerKind {
    /// Every number on its own.
    Independent,
    /// As many strata as samples per pixel, one sample in each.
    Stratified,
    /// Recursive quadrants: strata that get finer as samples come.
    Quadrant,
    /// Scrambled Halton sequence.
    Halton,
    /// Owen-scrambled Sobol' sequence.
    Sobol,
}

impl SamplerKind {
    pub const ALL: [Self; 5] = [Self::Independent, Self::Stratified, Self::Quadrant, Self::Halton, Self::Sobol];
}

/// Which sampler draws the position inside the pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PixelSampler {
    /// The path's own sampler.
    SameAsPath,
    /// Another sampler than the path's.
    Other(SamplerKind),
    /// Always the pixel's centre: aliased, for comparison.
    Centre,
}

/// A pixel sampler as scene files and the command line name it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PixelSamplerName {
    Independent,
    Stratified,
    Quadrant,
    Halton,
    Sobol,
    /// Always the pixel's centre: aliased, for comparison.
    None,
}

impl From<PixelSamplerName> for PixelSampler {
    fn from(name: PixelSamplerName) -> Self {
        match name {
            PixelSamplerName::Independent => Self::Other(SamplerKind::Independent),
            PixelSamplerName::Stratified => Self::Other(SamplerKind::Stratified),
            PixelSamplerName::Quadrant => Self::Other(SamplerKind::Quadrant),
            PixelSamplerName::Halton => Self::Other(SamplerKind::Halton),
            PixelSamplerName::Sobol => Self::Other(SamplerKind::Sobol),
            PixelSamplerName::None => Self::Centre,
        }
    }
}

impl PixelSampler {
    /// The name of the sampler that draws the pixel's dimensions, with `path` the path's.
    pub fn name(self, path: SamplerKind) -> String {
        match self {
            Self::SameAsPath => setting_name(path),
            Self::Other(kind) => setting_name(kind),
            Self::Centre => setting_name(PixelSamplerName::None),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Estimator {
    /// Next event estimation and BSDF sampling combined by multiple importance sampling.
    Mis,
    /// Next event estimation alone; emitters met by a BSDF sample count only where light sampling cannot produce them.
    Nee,
    /// BSDF sampling alone.
    Bsdf,
}

/// How multiple importance sampling weighs the two strategies (Veach 1997, section 9.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MisHeuristic {
    /// Power heuristic with β = 2.
    Power,
    Balance,
}

/// How directions over a diffuse surface are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum HemisphereSampling {
    /// In proportion to the cosine with the normal.
    Cosine,
    Uniform,
}

/// How a point on a sphere light is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LightSampling {
    /// Uniform in the cone of directions that meet the sphere.
    Cone,
    /// Uniform over the half of the surface that faces the point.
    Visible,
    /// Uniform over the whole surface.
    Area,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum BlendMode {
    /// Every lobe of a blend is evaluated, one is sampled.
    Mixture,
    /// One material is chosen per hit, as in the thesis.
    Pick,
}

/// The name by which scene files, the command line and picture headers call a setting's value.
pub fn setting_name<T: ValueEnum>(value: T) -> String {
    value.to_possible_value().map(|possible| possible.get_name().to_owned()).unwrap_or_default()
}
