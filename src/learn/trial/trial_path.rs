//! Notes about a path that a trial run follows.

use glam::DVec3;

use super::super::paths::MOST_VERTICES;
use super::sum::{Rays, Sum};
use crate::reference::bsdf::BsdfSample;
use crate::reference::intersect::Surface;
use crate::reference::trace::{LightConnection, PathVisitor};
use crate::scene::RenderSettings;
use crate::spectrum::Spectrum;

/// A record of a path, with statistics of how other ways would trace it. Light in view is no part of that: no other
/// way changes it.
pub trait Record {
    type Statistics: Sum;
    /// The record wants [`PathVisitor::COMPARES`].
    const COMPARES: bool = false;

    fn new(settings: &RenderSettings) -> Self;
    /// The result at the path's end.
    fn statistics(&self) -> Self::Statistics;

    /// A ray of the path, or a shadow ray, was traced.
    fn traced(&mut self, _rays: Rays) {}
    /// The path met a surface.
    fn met(&mut self, _depth: u32, _throughput: Spectrum) {}
    /// The next direction is given as by [`PathVisitor::unguided`].
    fn unguided(&mut self, _times: f64) {}
    /// Light was sampled.
    fn light(&mut self, _connection: &LightConnection) {}
    /// The path found light by itself, with this weight by multiple importance sampling.
    fn found(&mut self, _weight: f64, _contribution: Spectrum) {}
    /// The path goes on, unless roulette ends it.
    fn scattered(&mut self, _sample: &BsdfSample) {}
    /// Roulette let the path go on with this chance.
    fn survived(&mut self, _survival: f64) {}
}

/// Nothing is asked.
impl Record for () {
    type Statistics = ();

    fn new(_: &RenderSettings) -> Self {}

    fn statistics(&self) {}
}

/// A path that is followed.
pub struct TrialPath<R> {
    pub rays: Rays,
    /// Light of its first edge, on which it may have gone through null surfaces.
    pub in_view: Spectrum,
    scatters: bool,
    pub record: R,
}

impl<R: Record> TrialPath<R> {
    pub fn new(settings: &RenderSettings) -> Self {
        Self { rays: Rays::default(), in_view: Spectrum::BLACK, scatters: false, record: R::new(settings) }
    }

    fn traced(&mut self, rays: Rays) {
        self.rays = self.rays.and(rays);
        self.record.traced(rays);
    }

    fn found(&mut self, weight: f64, contribution: Spectrum) {
        if self.scatters {
            self.record.found(weight, contribution);
        } else {
            self.in_view += contribution;
        }
    }
}

impl<R: Record> PathVisitor for TrialPath<R> {
    const COMPARES: bool = R::COMPARES;

    fn surface(&mut self, depth: u32, _: &Surface, _: DVec3, throughput: Spectrum) {
        self.traced(Rays::PATH);
        self.record.met(depth, throughput);
    }

    fn emission(&mut self, _: Spectrum, weight: f64, contribution: Spectrum) {
        self.found(weight, contribution);
    }

    fn unguided(&mut self, times: f64) {
        self.record.unguided(times);
    }

    fn light(&mut self, connection: &LightConnection) {
        self.traced(Rays::SHADOW);
        self.record.light(connection);
    }

    fn scattered(&mut self, sample: &BsdfSample) {
        self.scatters |= !sample.is_null;
        self.record.scattered(sample);
    }

    fn roulette(&mut self, survival: f64, survived: bool) {
        if survived {
            self.record.survived(survival);
        }
    }

    fn escaped(&mut self, _: Spectrum, weight: f64, contribution: Spectrum) {
        self.traced(Rays::PATH);
        self.found(weight, contribution);
    }

    fn gives_up(&mut self, vertices: u32) -> bool {
        vertices > MOST_VERTICES
    }
}
