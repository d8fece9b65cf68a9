//! Estimates of paths without a guide, made from guided ones.
//!
//! A trial run without a guide misjudges it, because it seldom sees the rare bright paths that a guide is
//! for. Guided paths see them, and estimate the variance of both ways: a path that has the density p_g with the
//! guide and p_u without it finds, without it, other contributions c₁, c₂, …, since throughput goes with one
//! over the density and multiple importance sampling weighs by other densities. With rₖ = p_u / p_g up to
//! where the k-th is found, roulette's chances included, the mean of Σₖ rₖ cₖ (cₖ + 2 Σ_{j<k} cⱼ) over guided
//! paths is the second moment of a sample without a guide, and the mean of rₖ over all rays is the number of
//! its rays.

use super::sum::{Rays, Sum};
use super::trial_path::Record;
use crate::reference::bsdf::{BsdfSample, Density};
use crate::reference::roulette;
use crate::reference::trace::LightConnection;
use crate::sampling::mis::Heuristic;
use crate::scene::{Estimator, RenderSettings};
use crate::spectrum::Spectrum;

/// Moments and rays of a sample, as guided paths estimate them.
#[derive(Debug, Clone, Copy, Default)]
pub struct UnguidedEstimate {
    /// Second moment of what guided ones find.
    pub guided: Spectrum,
    /// Second moment of what unguided ones would find, and their rays.
    pub unguided: Spectrum,
    pub rays: Rays,
}

impl Sum for UnguidedEstimate {
    fn and(self, other: Self) -> Self {
        Self { guided: self.guided + other.guided, unguided: self.unguided + other.unguided, rays: self.rays.and(other.rays) }
    }

    fn times(self, factor: f64) -> Self {
        Self { guided: self.guided * factor, unguided: self.unguided * factor, rays: self.rays.times(factor) }
    }
}

/// A guided path, and what it would be without the guide.
pub struct UnguidedRecord {
    estimator: Estimator,
    heuristic: Heuristic,
    /// First depth at which roulette may end an unguided path.
    first_roulette: Option<u32>,
    /// How many times as likely the path is without the guide, up to where it stands.
    density: f64,
    /// The factor of the direction that the visitor was given last.
    times: f64,
    /// Density with the guide of the direction from the surface before, and how many times that it is without
    /// the guide.
    previous: (Density, f64),
    throughput: Spectrum,
    eta_scale: f64,
    depth: u32,
    /// The light that the path finds, with the guide and without it, and the second moment of the latter.
    found: Spectrum,
    unguided: Spectrum,
    moment: Spectrum,
    rays: Rays,
}

impl UnguidedRecord {
    /// Light that the path finds is shared with light samples.
    fn shares(&self) -> bool {
        matches!(self.estimator, Estimator::Mis | Estimator::Choose)
    }

    /// Adds light that the path found; without the guide it has another weight.
    fn add(&mut self, contribution: Spectrum, [weight, unguided]: [f64; 2]) {
        if contribution.is_black() {
            return;
        }
        self.found += contribution;
        if self.density > 0.0 && unguided > 0.0 {
            // Throughput goes with one over the density.
            let own = contribution * (unguided / weight);
            self.moment += own * (own / self.density + 2.0 * self.unguided);
            self.unguided += own / self.density;
        }
    }
}

impl Record for UnguidedRecord {
    type Statistics = UnguidedEstimate;
    const COMPARES: bool = true;

    fn new(settings: &RenderSettings) -> Self {
        Self {
            estimator: settings.estimator,
            heuristic: settings.into(),
            first_roulette: settings.first_roulette(false),
            density: 1.0,
            times: 1.0,
            previous: (Density::Delta, 1.0),
            throughput: Spectrum::WHITE,
            eta_scale: 1.0,
            depth: 1,
            found: Spectrum::BLACK,
            unguided: Spectrum::BLACK,
            moment: Spectrum::BLACK,
            rays: Rays::default(),
        }
    }

    fn statistics(&self) -> UnguidedEstimate {
        UnguidedEstimate { guided: self.found * self.found, unguided: self.moment, rays: self.rays }
    }

    fn traced(&mut self, rays: Rays) {
        self.rays = self.rays.and(rays.times(self.density));
    }

    fn met(&mut self, depth: u32, throughput: Spectrum) {
        self.depth = depth;
        self.throughput = throughput;
    }

    fn unguided(&mut self, times: f64) {
        self.times = times;
    }

    fn light(&mut self, connection: &LightConnection) {
        let LightConnection { light, bsdf_pdf, weight, contribution, .. } = connection;
        let is_shared = !light.delta && self.shares();
        let unguided = if is_shared { self.heuristic.weight(light.pdf, bsdf_pdf * self.times) } else { *weight };
        self.add(*contribution, [*weight, unguided]);
    }

    fn found(&mut self, weight: f64, contribution: Spectrum) {
        let unguided = match self.previous {
            (Density::SolidAngle(pdf), times) if self.shares() && weight > 0.0 => {
                self.heuristic.weight(pdf * times, self.heuristic.least_other_pdf(pdf, weight))
            }
            _ => weight,
        };
        self.add(contribution, [weight, unguided]);
    }

    fn scattered(&mut self, sample: &BsdfSample) {
        self.density *= self.times;
        if sample.is_null {
            return;
        }
        self.previous = (sample.density, self.times);
        self.eta_scale *= sample.eta * sample.eta;
        if self.density > 0.0 && self.first_roulette.is_some_and(|first| self.depth >= first) {
            let throughput = self.throughput * sample.weight * (self.eta_scale / self.density);
            self.density *= roulette::survival(throughput, self.depth);
        }
    }

    fn survived(&mut self, survival: f64) {
        self.density /= survival;
    }
}
