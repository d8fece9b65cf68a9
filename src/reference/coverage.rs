//! What rays of the camera meet first, beyond surfaces that let them through.

use glam::DVec3;

use super::bsdf::BsdfSample;
use super::intersect::{Owner, Surface};
use super::trace::PathVisitor;

/// Watches a path up to the surface that scatters it.
#[derive(Default)]
pub struct FirstOwner {
    /// Of the surface that was met last.
    pub owner: Option<Owner>,
    reached: bool,
}

impl PathVisitor for FirstOwner {
    fn surface(&mut self, _depth: u32, surface: &Surface, _wo: DVec3, _throughput: DVec3) {
        self.owner = Some(surface.owner);
    }

    fn scattered(&mut self, sample: &BsdfSample) {
        self.reached = !sample.is_null;
    }

    fn gives_up(&mut self, _vertices: u32) -> bool {
        self.reached
    }

    fn escaped(&mut self, _radiance: DVec3, _weight: f64, _contribution: DVec3) {
        self.owner = None;
    }
}
