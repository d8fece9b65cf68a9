//! The part of a sampler's numbers that all pixels share: worked out once per sample on the host.

use super::dimension::{Dimension, SEQUENCE_DIMENSIONS, VertexDimension};
use super::halton::radical_inverse_bits;
use super::hammersley::hammersley_bits;
use super::sobol::sobol_bits;
use super::strata::{quadrant_bits, shared_strata_bits, stratified_bits};
use crate::scene::{PixelSampler, RenderSettings, SamplerKind};

/// Everything a render's random numbers depend on beside pixel and sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sampling {
    pub path: SamplerKind,
    pub pixel: PixelSampler,
    pub seed: u32,
    /// Samples per pixel for which `stratified` lays out its strata and `hammersley` its points, at least 1.
    pub samples: u32,
    /// Light samples at the first surfaces of a path, at least 1, and at how many of them.
    pub light_samples: u32,
    pub light_samples_depth: u32,
}

impl From<&RenderSettings> for Sampling {
    fn from(settings: &RenderSettings) -> Self {
        let [light_samples, light_samples_depth] = settings.several_light_samples();
        Self {
            path: settings.sampler,
            pixel: settings.pixel_sampler,
            seed: settings.seed,
            samples: settings.spp.clamp(1, 1 << 31),
            light_samples,
            light_samples_depth,
        }
    }
}

/// The dimensions of a light sample.
const LIGHT: [VertexDimension; 3] = [VertexDimension::LightChoice, VertexDimension::LightU, VertexDimension::LightV];

/// How pixels are made independent of each other where they share a sequence: each moves it by a hash of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decorrelation {
    /// Addition modulo 1 (Cranley and Patterson 1976).
    Rotation,
    /// Exclusive or with the binary digits: keeps elementary intervals in base 2 (Matoušek 1998).
    DigitalShift,
    /// There is no sequence: every number is hashed.
    Hashed,
    /// There is no sequence: every path has a stream of numbers of its own.
    Stream,
}

impl Decorrelation {
    /// How a sampler's pixels are made independent.
    pub fn of(sampler: SamplerKind) -> Self {
        match sampler {
            SamplerKind::Independent => Self::Hashed,
            SamplerKind::Congruential => Self::Stream,
            SamplerKind::Stratified | SamplerKind::Halton | SamplerKind::Hammersley | SamplerKind::SharedStrata => Self::Rotation,
            SamplerKind::Quadrant | SamplerKind::Sobol => Self::DigitalShift,
        }
    }

    /// There is a sequence that pixels share.
    pub fn has_sequence(self) -> bool {
        matches!(self, Self::Rotation | Self::DigitalShift)
    }
}

impl Sampling {
    /// The sampler of a dimension; None for a coordinate that is always the pixel's centre.
    pub fn sampler_of(&self, dimension: Dimension) -> Option<SamplerKind> {
        match self.pixel {
            PixelSampler::Other(kind) if dimension.is_pixel() => Some(kind),
            PixelSampler::Centre if dimension.is_pixel() => None,
            _ => Some(self.path),
        }
    }

    /// Says that some number comes from a sequence.
    pub fn uses_sequence(&self) -> bool {
        let pixel = matches!(self.pixel, PixelSampler::Other(kind) if Decorrelation::of(kind).has_sequence());
        pixel || Decorrelation::of(self.path).has_sequence()
    }

    /// Bits that all pixels share; 0 where there are none.
    fn shared_bits(&self, dimension: Dimension, sample: u32) -> u32 {
        if dimension.light_vertex().is_some_and(|vertex| vertex < self.light_samples_depth) {
            return self.light_bits(dimension, sample, 0);
        }
        self.bits_at(dimension, sample, self.samples)
    }

    /// The bits of light sample `number` at a surface that takes several. All light samples of a pixel at
    /// that vertex are points of one sequence.
    fn light_bits(&self, dimension: Dimension, sample: u32, number: u32) -> u32 {
        let count = self.light_samples;
        let index = sample.wrapping_mul(count).wrapping_add(number);
        self.bits_at(dimension, index, self.samples.saturating_mul(count).min(1 << 31))
    }

    /// Point number `sample` of a sequence that lays out strata for `samples`.
    fn bits_at(&self, dimension: Dimension, sample: u32, samples: u32) -> u32 {
        let Dimension(d) = dimension;
        match self.sampler_of(dimension) {
            None | Some(SamplerKind::Independent | SamplerKind::Congruential) => 0,
            Some(SamplerKind::Stratified) => stratified_bits(self.seed, samples, dimension, sample),
            Some(SamplerKind::SharedStrata) => shared_strata_bits(self.seed, samples, dimension, sample),
            Some(SamplerKind::Quadrant) => quadrant_bits(self.seed, dimension, sample),
            Some(SamplerKind::Halton) => radical_inverse_bits(self.seed, d, sample),
            Some(SamplerKind::Sobol) => sobol_bits(self.seed, d, sample),
            Some(SamplerKind::Hammersley) => hammersley_bits(self.seed, samples, d, sample),
        }
    }
}

/// The sampler's sequence at one sample index.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SequencePoint {
    /// Absolute sample index.
    pub sample: u32,
    /// 32-bit fractions, one for each dimension that sequences cover.
    pub bits: [u32; SEQUENCE_DIMENSIONS as usize],
    /// The choice of the light and the point on it of each light sample but the first, at each surface that takes several, surface after
    /// surface; the fourth is not used.
    pub more_lights: Vec<[u32; 4]>,
}

impl SequencePoint {
    pub fn new(sampling: &Sampling, sample: u32) -> Self {
        let light = |vertex, number| {
            let [choice, u, v] = LIGHT.map(|name| sampling.light_bits(Dimension::vertex(vertex, name), sample, number));
            [choice, u, v, 0]
        };
        let lights = |vertex| (1..sampling.light_samples).map(move |number| light(vertex, number));
        Self {
            sample,
            bits: std::array::from_fn(|d| sampling.shared_bits(Dimension(d as u32), sample)),
            more_lights: (0..sampling.light_samples_depth).flat_map(lights).collect(),
        }
    }
}
