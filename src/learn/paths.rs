//! Paths that stand for all of a picture: what is found out before the first sample is found out by them.

use crate::reference::integrator::Integrator;
use crate::reference::trace::PathVisitor;
use crate::sampling::{PathSampler, Sampling, SequencePoint};
use crate::spectrum::Spectrum;

/// Vertices after which a path is given up.
pub const MOST_VERTICES: u32 = 64;

/// A pixel for each path: spread evenly over the film, whatever their number (Roberts's R2 sequence, in
/// integers).
pub fn pixel_of(path: u32, [width, height]: [u32; 2]) -> [u32; 2] {
    let scaled = |number: u32, size: u32| ((u64::from(number) * u64::from(size)) >> 32) as u32;
    [scaled(path.wrapping_mul(3_242_174_889), width), scaled(path.wrapping_mul(2_447_445_414), height)]
}

/// Follows one path through a pixel.
pub fn follow<V: PathVisitor>(
    integrator: &Integrator,
    sampling: &Sampling,
    [x, y]: [u32; 2],
    sample: u32,
    visitor: &mut V,
) -> Spectrum {
    let pixel = y.wrapping_mul(integrator.scene().film.size[0]).wrapping_add(x);
    let point = SequencePoint::new(sampling, sample);
    integrator.radiance(x, y, &PathSampler::new(sampling, pixel, &point), visitor)
}
