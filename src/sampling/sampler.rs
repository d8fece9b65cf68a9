//! The random numbers of one path.

use super::dimension::Dimension;
use super::halton::{BASES, HALTON_DIMENSIONS, radical_inverse_bits};
use super::hash::{dimension_bits, path_key, pixel_key};
use crate::scene::SamplerKind;

/// The Halton sequence at one sample index: what all pixels share, so that it is worked out once and not once per pixel.
#[derive(Debug, Clone)]
pub struct SequencePoint {
    sample: u32,
    bits: [u32; HALTON_DIMENSIONS as usize],
}

impl SequencePoint {
    pub fn new(seed: u32, sample: u32) -> Self {
        Self { sample, bits: std::array::from_fn(|dimension| radical_inverse_bits(seed, dimension as u32, sample)) }
    }
}

/// Draws the coordinates of one path's point in primary sample space, in any order.
#[derive(Debug, Clone, Copy)]
pub struct PathSampler<'a> {
    kind: SamplerKind,
    seed: u32,
    sample: u32,
    pixel_key: u32,
    path_key: u32,
    point: Option<&'a SequencePoint>,
}

impl<'a> PathSampler<'a> {
    /// `pixel` is y·width + x over the whole film, `sample` the absolute sample index.
    pub fn new(kind: SamplerKind, seed: u32, pixel: u32, sample: u32) -> Self {
        let pixel_key = pixel_key(seed, pixel);
        Self { kind, seed, sample, pixel_key, path_key: path_key(pixel_key, sample), point: None }
    }

    /// The same numbers as [`PathSampler::new`] with the point's sample, sooner. The point has the same seed.
    pub fn at_point(kind: SamplerKind, seed: u32, pixel: u32, point: &'a SequencePoint) -> Self {
        Self { point: Some(point), ..Self::new(kind, seed, pixel, point.sample) }
    }

    /// 32 uniform bits.
    pub fn bits(&self, dimension: Dimension) -> u32 {
        let Dimension(d) = dimension;
        let in_sequence = self.kind == SamplerKind::Halton && d < HALTON_DIMENSIONS && BASES[d as usize] != 0;
        if in_sequence {
            let shared = match self.point {
                Some(point) => point.bits[d as usize],
                None => radical_inverse_bits(self.seed, d, self.sample),
            };
            shared.wrapping_add(dimension_bits(self.pixel_key, d))
        } else {
            dimension_bits(self.path_key, d)
        }
    }

    /// Uniform in [0, 1): a multiple of 2⁻²⁴, exact in f32 as well.
    pub fn uniform(&self, dimension: Dimension) -> f64 {
        f64::from(self.bits(dimension) >> 8) / 16_777_216.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shared_point_changes_nothing() {
        let point = SequencePoint::new(3, 77);
        for kind in [SamplerKind::Halton, SamplerKind::Independent] {
            let (alone, shared) = (PathSampler::new(kind, 3, 1234, 77), PathSampler::at_point(kind, 3, 1234, &point));
            for dimension in (0..100).map(Dimension) {
                assert_eq!(alone.bits(dimension), shared.bits(dimension));
            }
        }
    }
}
