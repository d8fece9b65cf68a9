//! Light that goes straight down to one layer, is reflected there, and comes straight up again; or straight through.
//!
//! Weidlich and Wilkie (2007) approximate stacks so: f = Σ f_k(o_k, i_k)·T(o_k)·T(i_k)·a, where o_k and i_k are wo and wi as smooth interfaces above layer
//! k bend them, T what Fresnel's equations let through there, and a what slabs absorb on both ways; their masking of the way out is taken to be 1. The density with which
//! directions are drawn that way is also about that of random walks, by which these are weighed against light samples.

use std::f64::consts::PI;

use glam::DVec3;

use super::stack::{SMALLEST_COSINE, Stack};
use crate::math::dielectric_reflectance;
use crate::reference::bsdf::refract;
use crate::reference::bsdf::{BsdfSample, Density, Evaluation};
use crate::reference::medium::left;
use crate::spectrum::Spectrum;

/// The part of walks that is taken to leave the stack evenly, where slabs scatter and where they do not.
const EVEN_SHARE: [f64; 2] = [0.5, 0.1];

/// The number by which a part of an interface is picked where blends pick one.
const MIDDLE: f64 = 0.5;

/// A direction that points away from the surface, on its way down.
#[derive(Debug, Clone, Copy)]
struct Beam {
    direction: DVec3,
    /// The part that interfaces and slabs so far let through.
    left: Spectrum,
    /// That of interfaces alone.
    passed: f64,
    /// Solid angle here over that outside.
    solid_angle: f64,
}

impl Beam {
    fn new(direction: DVec3) -> Self {
        Self { direction, left: Spectrum::WHITE, passed: 1.0, solid_angle: 1.0 }
    }

    /// Behind an interface and the slab beyond it; None where it is reflected totally.
    fn through(self, stack: &Stack, interface: usize) -> Option<Self> {
        let is_above = self.direction.dot(stack.up) > 0.0;
        let normal = if is_above { stack.up } else { -stack.up };
        let ior = stack.layers.layers[interface].flat.ior;
        let eta = if is_above { ior } else { 1.0 / ior };
        let cosine = self.direction.dot(normal).max(SMALLEST_COSINE);
        let (direction, reflected) = if ior == 1.0 {
            (self.direction, 0.0)
        } else {
            (-refract(self.direction, normal, eta)?, dielectric_reflectance(cosine, eta))
        };
        let cosine_behind = direction.dot(normal).max(SMALLEST_COSINE);
        let slab = stack.slab(if is_above { interface + 1 } else { interface });
        let absorbed = slab.map_or(Spectrum::WHITE, |slab| left(slab.filling.extinction, slab.thickness / cosine_behind));
        Some(Self {
            direction,
            left: self.left * absorbed * (1.0 - reflected),
            passed: self.passed * (1.0 - reflected),
            solid_angle: self.solid_angle * cosine / (eta * eta * cosine_behind),
        })
    }
}

impl Stack<'_> {
    /// Interfaces in the order in which a direction that points away from the surface meets them.
    fn order(&self, direction: DVec3) -> impl DoubleEndedIterator<Item = usize> + ExactSizeIterator {
        let (count, from_above) = (self.count(), direction.dot(self.up) > 0.0);
        (0..count).map(move |place| if from_above { place } else { count - 1 - place })
    }

    /// About the density with which [walks](Stack::walk) draw wi, per steradian.
    pub fn about_pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        let same_side = wo.dot(self.up) * wi.dot(self.up) > 0.0;
        let mut sum = 0.0;
        let mut from = Some(Beam::new(wo));
        let mut to = Some(Beam::new(wi));
        for interface in self.order(wo) {
            let Some(beam) = from else { break };
            // Light that comes through meets the interfaces beyond this one first.
            let arriving = if same_side {
                to
            } else {
                self.order(wi)
                    .take_while(|&other| other != interface)
                    .try_fold(Beam::new(wi), |beam, other| beam.through(self, other))
            };
            if let Some(arriving) = arriving {
                let bsdf = self.interface(interface, beam.direction, Spectrum::WHITE, MIDDLE);
                sum += beam.passed * bsdf.evaluate(arriving.direction).pdf * arriving.solid_angle;
            }
            from = beam.through(self, interface);
            to = to.and_then(|beam| beam.through(self, interface));
        }
        let even = if self.layers.scatters { EVEN_SHARE[0] } else { EVEN_SHARE[1] };
        (1.0 - even) * sum + even * wi.dot(self.up).abs() / PI
    }

    /// Weidlich and Wilkie's approximation of f·|cosθi|, and the density with which [`Stack::draw_straight`] draws wi.
    pub fn evaluate_straight(&self, wo: DVec3, wi: DVec3) -> Evaluation {
        let mut sum = Evaluation::default();
        let (mut from, mut to) = (Some(Beam::new(wo)), Some(Beam::new(wi)));
        for interface in self.order(wo) {
            let (Some(beam), Some(arriving)) = (from, to) else { break };
            let bsdf = self.interface(interface, beam.direction, Spectrum::WHITE, MIDDLE);
            let Evaluation { value, pdf } = bsdf.evaluate(arriving.direction);
            let cosines = wi.dot(self.up).abs() / arriving.direction.dot(self.up).abs().max(SMALLEST_COSINE);
            sum.value += value * beam.left * arriving.left * cosines;
            sum.pdf += pdf * arriving.solid_angle / self.count() as f64;
            from = beam.through(self, interface);
            to = arriving.through(self, interface);
        }
        if wo.dot(self.up) * wi.dot(self.up) > 0.0 { sum } else { Evaluation::default() }
    }

    /// Draws wi for the approximation: by one of the interfaces, each as often. What goes on through it is lost.
    pub fn draw_straight(&self, wo: DVec3, [u_lobe, u1, u2]: [f64; 3]) -> Option<BsdfSample> {
        let count = self.count();
        let scaled = u_lobe * count as f64;
        let place = (scaled as usize).min(count - 1);
        let ordered = || self.order(wo).take(place);
        let beam = ordered().try_fold(Beam::new(wo), |beam, interface| beam.through(self, interface))?;
        let interface = self.order(wo).nth(place)?;
        let bsdf = self.interface(interface, beam.direction, Spectrum::WHITE, MIDDLE);
        let sample = bsdf.sample(scaled - place as f64, u1, u2)?;
        if sample.wi.dot(self.up) * beam.direction.dot(self.up) <= 0.0 {
            return None;
        }
        // Ways are the same in both directions, so the way out is that of a beam which comes in along wi.
        let wi = ordered().rev().try_fold(sample.wi, |direction, other| self.out_through(other, direction))?;
        match sample.density {
            Density::Delta => {
                let arriving = ordered().try_fold(Beam::new(wi), |beam, interface| beam.through(self, interface))?;
                let cosines = wi.dot(self.up).abs() / arriving.direction.dot(self.up).abs().max(SMALLEST_COSINE);
                let weight = sample.weight * beam.left * arriving.left * (count as f64 * cosines / arriving.solid_angle);
                Some(BsdfSample { wi, weight, density: Density::Delta, eta: 1.0, is_null: false })
            }
            Density::SolidAngle(_) => {
                let Evaluation { value, pdf } = self.evaluate_straight(wo, wi);
                let weight = value / pdf;
                (pdf > 0.0).then_some(BsdfSample { wi, weight, density: Density::SolidAngle(pdf), eta: 1.0, is_null: false })
            }
        }
    }

    /// The direction that light had before an interface bent it into this one, by which it comes from layers below.
    fn out_through(&self, interface: usize, direction: DVec3) -> Option<DVec3> {
        let ior = self.layers.layers[interface].flat.ior;
        if ior == 1.0 {
            return Some(direction);
        }
        let is_above = direction.dot(self.up) > 0.0;
        let (normal, eta) = if is_above { (self.up, 1.0 / ior) } else { (-self.up, ior) };
        refract(direction, normal, eta).map(|bent| -bent)
    }
}
