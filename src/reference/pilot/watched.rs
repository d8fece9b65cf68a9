//! What is noted of a path that a pilot follows.

use glam::DVec3;

use super::rays::Rays;
use super::roulette::{Effects, PathRecord};
use super::sum::Sum;
use super::unguided::{Tale, UnguidedRecord};
use crate::reference::bsdf::BsdfSample;
use crate::reference::intersect::Surface;
use crate::reference::trace::{LightConnection, PathVisitor};
use crate::scene::RenderSettings;

/// Vertices after which a path is given up.
const MOST_VERTICES: u32 = 64;

/// Follows a path.
pub trait Watcher: PathVisitor {
    /// What other ways would do to it.
    type Effects: Sum;

    fn new(settings: &RenderSettings) -> Self;

    fn watched(&self) -> &Watched;

    fn effects(&self) -> Self::Effects;
}

/// A path that is followed.
#[derive(Default)]
pub struct Watched {
    pub rays: Rays,
    /// Light of its first edge, on which it may have gone through null surfaces.
    pub in_view: DVec3,
    scatters: bool,
}

impl Watcher for Watched {
    type Effects = ();

    fn new(_: &RenderSettings) -> Self {
        Self::default()
    }

    fn watched(&self) -> &Watched {
        self
    }

    fn effects(&self) {}
}

impl PathVisitor for Watched {
    fn surface(&mut self, _: u32, _: &Surface, _: DVec3, _: DVec3) {
        self.rays.path += 1.0;
    }

    fn emission(&mut self, _: DVec3, _: f64, contribution: DVec3) {
        if !self.scatters {
            self.in_view += contribution;
        }
    }

    fn scattered(&mut self, sample: &BsdfSample) {
        self.scatters |= !sample.is_null;
    }

    fn escaped(&mut self, _: DVec3, _: f64, contribution: DVec3) {
        self.rays.path += 1.0;
        if !self.scatters {
            self.in_view += contribution;
        }
    }

    fn light(&mut self, _: &LightConnection) {
        self.rays.shadow += 1.0;
    }

    fn gives_up(&mut self, vertices: u32) -> bool {
        vertices > MOST_VERTICES
    }
}

/// A path that is followed, and what it tells of roulette. Light in view is no part of that: no roulette ends paths before it.
#[derive(Default)]
pub struct WatchedRoulette {
    watched: Watched,
    record: PathRecord,
}

impl Watcher for WatchedRoulette {
    type Effects = Effects;

    fn new(_: &RenderSettings) -> Self {
        Self::default()
    }

    fn watched(&self) -> &Watched {
        &self.watched
    }

    fn effects(&self) -> Effects {
        self.record.effects()
    }
}

impl WatchedRoulette {
    fn found(&mut self, contribution: DVec3) {
        if self.watched.scatters {
            self.record.found(contribution);
        }
    }
}

impl PathVisitor for WatchedRoulette {
    fn surface(&mut self, depth: u32, surface: &Surface, wo: DVec3, throughput: DVec3) {
        self.watched.surface(depth, surface, wo, throughput);
        self.record.traced(Rays::PATH);
        self.record.met(depth, throughput);
    }

    fn emission(&mut self, radiance: DVec3, weight: f64, contribution: DVec3) {
        self.watched.emission(radiance, weight, contribution);
        self.found(contribution);
    }

    fn scattered(&mut self, sample: &BsdfSample) {
        self.watched.scattered(sample);
        self.record.scattered(sample);
    }

    fn escaped(&mut self, radiance: DVec3, weight: f64, contribution: DVec3) {
        self.watched.escaped(radiance, weight, contribution);
        self.record.traced(Rays::PATH);
        self.found(contribution);
    }

    fn light(&mut self, connection: &LightConnection) {
        self.watched.light(connection);
        self.record.traced(Rays::SHADOW);
        self.record.found(connection.contribution);
    }

    fn gives_up(&mut self, vertices: u32) -> bool {
        self.watched.gives_up(vertices)
    }
}

/// A guided path that is followed, and what it tells of unguided ones. Light in view is no part of that: no guide leads to it.
pub struct WatchedGuide {
    watched: Watched,
    pub record: UnguidedRecord,
}

impl Watcher for WatchedGuide {
    type Effects = Tale;

    fn new(settings: &RenderSettings) -> Self {
        Self { watched: Watched::default(), record: UnguidedRecord::new(settings) }
    }

    fn watched(&self) -> &Watched {
        &self.watched
    }

    fn effects(&self) -> Tale {
        self.record.tale()
    }
}

impl PathVisitor for WatchedGuide {
    const COMPARES: bool = true;

    fn surface(&mut self, depth: u32, surface: &Surface, wo: DVec3, throughput: DVec3) {
        self.watched.surface(depth, surface, wo, throughput);
        self.record.traced(Rays::PATH);
        self.record.met(depth, throughput);
    }

    fn emission(&mut self, radiance: DVec3, weight: f64, contribution: DVec3) {
        self.watched.emission(radiance, weight, contribution);
        if self.watched.scatters {
            self.record.emission(weight, contribution);
        }
    }

    fn unguided(&mut self, times: f64) {
        self.record.unguided(times);
    }

    fn light(&mut self, connection: &LightConnection) {
        self.watched.light(connection);
        self.record.traced(Rays::SHADOW);
        self.record.light(connection);
    }

    fn scattered(&mut self, sample: &BsdfSample) {
        self.watched.scattered(sample);
        self.record.scattered(sample);
    }

    fn roulette(&mut self, survival: f64, survived: bool) {
        if survived {
            self.record.survived(survival);
        }
    }

    fn escaped(&mut self, radiance: DVec3, weight: f64, contribution: DVec3) {
        self.watched.escaped(radiance, weight, contribution);
        self.record.traced(Rays::PATH);
        if self.watched.scatters {
            self.record.emission(weight, contribution);
        }
    }

    fn gives_up(&mut self, vertices: u32) -> bool {
        self.watched.gives_up(vertices)
    }
}
