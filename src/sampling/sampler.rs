//! The random numbers of one path.

use super::dimension::Dimension;
use super::halton::{BASES, HALTON_DIMENSIONS, radical_inverse_bits};
use super::hash::{dimension_bits, path_key, pixel_key};
use crate::scene::SamplerKind;

/// Draws the coordinates of one path's point in primary sample space, in any order.
#[derive(Debug, Clone, Copy)]
pub struct PathSampler {
    kind: SamplerKind,
    seed: u32,
    sample: u32,
    pixel_key: u32,
    path_key: u32,
}

impl PathSampler {
    /// `pixel` is y·width + x over the whole film, `sample` the absolute sample index.
    pub fn new(kind: SamplerKind, seed: u32, pixel: u32, sample: u32) -> Self {
        let pixel_key = pixel_key(seed, pixel);
        Self { kind, seed, sample, pixel_key, path_key: path_key(pixel_key, sample) }
    }

    /// 32 uniform bits.
    pub fn bits(&self, dimension: Dimension) -> u32 {
        let Dimension(d) = dimension;
        let in_sequence = self.kind == SamplerKind::Halton && d < HALTON_DIMENSIONS && BASES[d as usize] != 0;
        if in_sequence {
            radical_inverse_bits(self.seed, d, self.sample).wrapping_add(dimension_bits(self.pixel_key, d))
        } else {
            dimension_bits(self.path_key, d)
        }
    }

    /// Uniform in [0, 1): a multiple of 2⁻²⁴, exact in f32 as well.
    pub fn uniform(&self, dimension: Dimension) -> f64 {
        f64::from(self.bits(dimension) >> 8) / 16_777_216.0
    }
}
