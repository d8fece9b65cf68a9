//! Surfaces that rays of the camera meet first, and beyond surfaces that let them through, each with the
//! share of the ray that it stops.

use glam::DVec3;

use super::bsdf::BsdfSample;
use super::intersect::{Owner, Surface};
use super::trace::PathVisitor;
use crate::spectrum::Spectrum;

/// Watches a path up to the surface that scatters it.
#[derive(Default)]
pub struct FirstOwners {
    /// Owner of each surface that was met, and the share of the ray that ends there, on average over the choices that the path made.
    pub shares: Vec<(Owner, f64)>,
    reached: bool,
}

/// Throughput of null surfaces is grey but for coloured ones, whose channels count alike.
fn mean(throughput: Spectrum) -> f64 {
    throughput.mean()
}

impl PathVisitor for FirstOwners {
    fn surface(&mut self, _depth: u32, surface: &Surface, _wo: DVec3, throughput: Spectrum) {
        self.shares.push((surface.owner, mean(throughput)));
    }

    fn scattered(&mut self, sample: &BsdfSample) {
        self.reached = !sample.is_null;
        // The part of a ray that goes on does not end here. A ray goes on more or less often than it is let through, and its weight makes up for that, so the
        // share is right on average: it is not the number of rays that end.
        if let (true, Some((_, share))) = (sample.is_null, self.shares.last_mut()) {
            *share -= *share * mean(sample.weight);
        }
    }

    fn gives_up(&mut self, _vertices: u32) -> bool {
        self.reached
    }
}
