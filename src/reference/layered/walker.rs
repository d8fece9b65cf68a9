//! A way of light through a stack, step by step.

use glam::DVec3;

use super::stack::{SMALLEST_COSINE, SlabAtHit, Stack};
use crate::reference::bsdf::{Bsdf, BsdfSample, Density};
use crate::reference::free_flight::fly;
use crate::reference::intersect::Ray;
use crate::reference::medium::left;
use crate::reference::phase::Scattering;
use crate::reference::tracking::Stream;
use crate::reference::work;
use crate::scene::DistanceSampling;
use crate::spectrum::Spectrum;

/// Events after which chance may end a way, and after which it does so at least now and then.
const FIRST_ROULETTE: u32 = 4;
const CERTAIN_ROULETTE: u32 = 1024;
const MOST_SURVIVAL: f64 = 0.99;

/// Light on its way through a stack.
#[derive(Debug, Clone, Copy)]
pub struct Walker {
    pub gap: usize,
    /// Depth within the gap's slab, along the normal.
    pub depth: f64,
    /// In which it goes.
    pub direction: DVec3,
    pub weight: Spectrum,
    /// The widest of its events so far; 0 where all had a single direction.
    pub breadth: f64,
    /// Product of the ratios of indices of refraction that it crossed.
    pub eta: f64,
    events: u32,
}

impl Walker {
    /// A way into the stack, against a direction that points away from the surface.
    pub fn into(stack: &Stack, direction: DVec3) -> Self {
        let gap = stack.outside(direction);
        Self { gap, depth: 0.0, direction: -direction, weight: Spectrum::WHITE, breadth: 0.0, eta: 1.0, events: 0 }
    }

    /// The way in the slab to the interface ahead, along the normal.
    pub fn height_ahead(&self, stack: &Stack, slab: &SlabAtHit) -> f64 {
        if self.direction.dot(stack.up) < 0.0 { slab.thickness - self.depth } else { self.depth }
    }

    /// Flies to the interface ahead; true where the slab scatters the light before.
    pub fn flies(&mut self, stack: &Stack, stream: &mut Stream) -> bool {
        let Some(slab) = stack.slab(self.gap) else { return false };
        let cosine = self.direction.dot(stack.up);
        let length = self.height_ahead(stack, &slab) / cosine.abs().max(SMALLEST_COSINE);
        if !slab.filling.scatters() {
            self.weight *= left(slab.filling.extinction, length);
            return false;
        }
        let ray = Ray { origin: DVec3::ZERO, direction: self.direction };
        let numbers = [stream.draw(), stream.draw()];
        let flight = fly(slab.filling, self.weight, (&ray, length), || None, DistanceSampling::Distance, numbers);
        self.weight *= flight.weight;
        let Some(distance) = flight.scattered_at else { return false };
        self.depth = (self.depth - distance * cosine).clamp(0.0, slab.thickness);
        true
    }

    /// Takes the direction that the slab scatters it into.
    pub fn scatter_in(&mut self, slab: &SlabAtHit, stream: &mut Stream) -> bool {
        let numbers = [stream.draw(), stream.draw(), stream.draw()];
        let scattering = Scattering { phase: &slab.filling.phase, wo: -self.direction, is_dark: false };
        let Some(sample) = scattering.sample(numbers[0], numbers[1], numbers[2]) else { return false };
        self.direction = sample.wi;
        self.breadth = self.breadth.max(slab.breadth);
        self.survives(stream)
    }

    /// Takes a direction that an interface sends it in.
    pub fn leave(&mut self, stack: &Stack, interface: usize, sample: &BsdfSample, stream: &mut Stream) -> bool {
        self.direction = sample.wi;
        self.gap = stack.behind(interface, sample.wi);
        let slab = stack.slab(self.gap);
        self.depth = if self.gap == interface { slab.map_or(0.0, |slab| slab.thickness) } else { 0.0 };
        if sample.density != Density::Delta {
            self.breadth = self.breadth.max(stack.layers.layers[interface].flat.breadth);
        }
        self.survives(stream)
    }

    /// Russian roulette by what the way still carries.
    fn survives(&mut self, stream: &mut Stream) -> bool {
        self.events += 1;
        work::add(work::LAYER_EVENT);
        let carried = self.weight.max_component() * self.eta * self.eta;
        if self.events < FIRST_ROULETTE || carried <= 0.0 {
            return carried > 0.0;
        }
        let most = if self.events < CERTAIN_ROULETTE { 1.0 } else { MOST_SURVIVAL };
        let survival = carried.min(most);
        self.weight /= survival;
        stream.draw() < survival
    }

    /// Draws the direction in which an interface sends light back along the way, from where light comes.
    pub fn draw(bsdf: &Bsdf, numbers: [f64; 3]) -> Option<BsdfSample> {
        bsdf.sample(numbers[0], numbers[1], numbers[2]).filter(|sample| sample.weight.max_component() > 0.0)
    }
}
