//! The random numbers of one path.

use super::dimension::Dimension;
use super::hash::{dimension_bits, path_key, pixel_key};
use super::lcg::lcg_bits;
use super::sequence::{Decorrelation, Sampling, SequencePoint};

/// The middle of [0, 1), where a position inside the pixel is its centre.
const CENTRE_BITS: u32 = 1 << 31;

/// Dimensions of hashed light samples after the first of a surface start here, past all vertices that a path can have numbers for.
const HASHED_LIGHTS: u32 = 1 << 30;

/// Draws the coordinates of one path's point in primary sample space, in any order.
#[derive(Debug, Clone, Copy)]
pub struct PathSampler<'a> {
    sampling: Sampling,
    pixel_key: u32,
    path_key: u32,
    point: &'a SequencePoint,
}

impl<'a> PathSampler<'a> {
    /// `pixel` is y·width + x over the whole film, `point` the sequence of the same `sampling` at the path's sample.
    pub fn new(sampling: &Sampling, pixel: u32, point: &'a SequencePoint) -> Self {
        let pixel_key = pixel_key(sampling.seed, pixel);
        Self { sampling: *sampling, pixel_key, path_key: path_key(pixel_key, point.sample), point }
    }

    /// 32 uniform bits.
    #[inline]
    pub fn bits(&self, dimension: Dimension) -> u32 {
        let Dimension(d) = dimension;
        let Some(kind) = self.sampling.sampler_of(dimension) else { return CENTRE_BITS };
        match (Decorrelation::of(kind), self.point.bits.get(d as usize)) {
            (Decorrelation::Rotation, Some(shared)) => shared.wrapping_add(dimension_bits(self.pixel_key, d)),
            (Decorrelation::DigitalShift, Some(shared)) => shared ^ dimension_bits(self.pixel_key, d),
            (own, _) => self.own_bits(own, d),
        }
    }

    /// Bits that the path shares with no other.
    fn own_bits(&self, decorrelation: Decorrelation, dimension: u32) -> u32 {
        match decorrelation {
            Decorrelation::Stream => lcg_bits(self.path_key, dimension),
            _ => dimension_bits(self.path_key, dimension),
        }
    }

    /// The bits of light sample `number` at vertex `vertex`, which a ray of this depth met: those of the light's choice, then of the point
    /// on it.
    #[inline]
    pub fn light_bits(&self, vertex: u32, depth: u32, number: u32) -> [u32; 3] {
        use super::dimension::VertexDimension::{LightChoice, LightU, LightV};
        let dimensions =
            [Dimension::vertex(vertex, LightChoice), Dimension::vertex(vertex, LightU), Dimension::vertex(vertex, LightV)];
        if number == 0 {
            return [self.bits(dimensions[0]), self.bits(dimensions[1]), self.bits(dimensions[2])];
        }
        let shared = self.point.more_lights.get(((depth - 1) * (self.sampling.light_samples - 1) + number - 1) as usize);
        let bits = |axis: usize| {
            let Dimension(d) = dimensions[axis];
            match (Decorrelation::of(self.sampling.path), shared) {
                (Decorrelation::Rotation, Some(shared)) => shared[axis].wrapping_add(dimension_bits(self.pixel_key, d)),
                (Decorrelation::DigitalShift, Some(shared)) => shared[axis] ^ dimension_bits(self.pixel_key, d),
                (own, _) => self.own_bits(own, HASHED_LIGHTS.wrapping_add(64 * (vertex + 1) + 4 * number + axis as u32)),
            }
        };
        [bits(0), bits(1), bits(2)]
    }

    /// Uniform in (0, 1): all 32 bits, rounded to f32. It is fine near 0, where rare events are.
    #[inline]
    pub fn open(&self, dimension: Dimension) -> f64 {
        open(self.bits(dimension))
    }

    /// Uniform in [0, 1): a multiple of 2⁻²⁴, exact in f32 as well.
    #[inline]
    pub fn uniform(&self, dimension: Dimension) -> f64 {
        uniform(self.bits(dimension))
    }
}

/// The largest number that samplers give: all are multiples of 2⁻²⁴ below 1.
pub const LARGEST_NUMBER: f64 = 1.0 - 1.0 / 16_777_216.0;

/// All 32 bits as a number of (0, 1), rounded to f32.
#[inline]
pub fn open(bits: u32) -> f64 {
    f64::from((bits as f32 + 0.5) * (1.0 / 4_294_967_296.0)).min(LARGEST_NUMBER)
}

/// The upper 24 of 32 bits as a number of [0, 1).
#[inline]
pub fn uniform(bits: u32) -> f64 {
    f64::from(bits >> 8) / 16_777_216.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{PixelSampler, SamplerKind};

    /// The first two dimensions follow the pixel's sampler, all others the path's.
    #[test]
    fn the_pixel_has_its_own_sampler() {
        let of = |path, pixel| Sampling { path, pixel, seed: 3, samples: 16, light_samples: 1, light_samples_depth: 1 };
        let bits =
            |sampling: Sampling, d| PathSampler::new(&sampling, 1234, &SequencePoint::new(&sampling, 7)).bits(Dimension(d));
        for path in SamplerKind::ALL {
            for pixel in SamplerKind::ALL {
                let mixed = of(path, PixelSampler::Other(pixel));
                for d in 0..60 {
                    let pure = of(if d < 2 { pixel } else { path }, PixelSampler::SameAsPath);
                    assert_eq!(bits(mixed, d), bits(pure, d), "{path:?} {pixel:?} {d}");
                }
            }
            let centre = of(path, PixelSampler::Centre);
            assert_eq!([bits(centre, 0), bits(centre, 1)].map(uniform), [0.5; 2]);
            assert_eq!(bits(centre, 2), bits(of(path, PixelSampler::SameAsPath), 2));
        }
    }
}
