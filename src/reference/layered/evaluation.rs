//! Estimates of what a stack scatters from one direction into another.
//!
//! Light goes by any number of events: an interface reflects it or lets it through, a slab scatters it. The BSDF is the sum over all sequences of
//! events. One walk follows the way from wo, another the way from wi, against the light; an event of the first at which it is evaluated, and not drawn,
//! joins both. So that each sequence is counted by one of its events alone, it is joined at the widest, the last of several: all events of the second
//! walk are narrower than the one at which both are joined, and none of the first is wider. Sharp coats are then drawn from both sides, and what lies below them is evaluated;
//! events that have a single direction are never evaluated. The estimate is unbiased whatever widths interfaces state.

use glam::DVec3;

use super::stack::{SMALLEST_COSINE, SlabAtHit, Stack};
use super::walker::Walker;
use crate::reference::bsdf::{BsdfSample, Density};
use crate::reference::medium::left;
use crate::reference::phase::Scattering;
use crate::reference::tracking::Stream;
use crate::spectrum::Spectrum;

/// A straight piece of the way from wi, at which the way from wo may be joined.
#[derive(Debug, Clone, Copy)]
struct Segment {
    walker: Walker,
    /// The interface that it leads to; None to the outside.
    ahead: Option<usize>,
}

impl Segment {
    fn of(stack: &Stack, walker: &Walker) -> Self {
        Self { walker: *walker, ahead: stack.ahead(walker.gap, walker.direction) }
    }

    /// Some event on it may be wider than all events before it.
    fn can_be_joined(&self, stack: &Stack) -> bool {
        let breadth = |number: usize| stack.layers.layers[number].flat.breadth;
        let at_interface = self.ahead.is_some_and(|number| breadth(number) > self.walker.breadth);
        at_interface || stack.slab(self.walker.gap).is_some_and(|slab| slab.breadth > self.walker.breadth)
    }

    /// About how much it brings where it is joined.
    fn carried(&self, stack: &Stack) -> f64 {
        self.walker.weight.max_component() * self.walker.direction.dot(stack.up).abs().max(SMALLEST_COSINE)
    }

    /// The share of light that is left after it, or after the part of it down to a depth; None where it does not come by there.
    fn left_at(&self, stack: &Stack, depth: Option<f64>) -> Option<Spectrum> {
        let Some(slab) = stack.slab(self.walker.gap) else { return Some(Spectrum::WHITE) };
        let cosine = self.walker.direction.dot(stack.up);
        let height = match depth {
            None => self.walker.height_ahead(stack, &slab),
            Some(depth) => (depth - self.walker.depth) * -cosine.signum(),
        };
        (height >= 0.0).then(|| left(slab.filling.extinction, height / cosine.abs().max(SMALLEST_COSINE)))
    }
}

impl Stack<'_> {
    /// An estimate of f(wo, wi)·|cosθi|, ways by single directions alone left out.
    pub fn estimate(&self, wo: DVec3, wi: DVec3, stream: &mut Stream) -> Spectrum {
        let segments = self.segments(wi, stream);
        let mut sum = Spectrum::BLACK;
        let mut walker = Walker::into(self, wo);
        loop {
            if walker.flies(self, stream) {
                let Some(slab) = self.slab(walker.gap) else { return sum };
                for segment in segments.iter().flatten() {
                    sum += self.joined_in(&slab, &walker, segment);
                }
                if !walker.scatter_in(&slab, stream) {
                    return sum;
                }
                continue;
            }
            let Some(interface) = self.ahead(walker.gap, walker.direction) else { return sum };
            let numbers = [stream.draw(), stream.draw(), stream.draw(), stream.draw()];
            let bsdf = self.interface(interface, -walker.direction, walker.weight, numbers[0]);
            let breadth = self.layers.layers[interface].flat.breadth;
            for segment in segments.iter().flatten() {
                if segment.ahead == Some(interface)
                    && segment.walker.breadth < breadth
                    && walker.breadth <= breadth
                    && let Some(left) = segment.left_at(self, None)
                {
                    let value = bsdf.evaluate(-segment.walker.direction).value;
                    sum += walker.weight * value * segment.walker.weight * left;
                }
            }
            let Some(sample) = Walker::draw(&bsdf, [numbers[1], numbers[2], numbers[3]]) else { return sum };
            walker.weight *= sample.weight;
            walker.eta *= sample.eta;
            if !walker.leave(self, interface, &sample, stream) {
                return sum;
            }
        }
    }

    /// The part of the sum by a scattering of the slab that joins both ways.
    fn joined_in(&self, slab: &SlabAtHit, walker: &Walker, segment: &Segment) -> Spectrum {
        let other = &segment.walker;
        if other.gap != walker.gap || other.breadth >= slab.breadth || walker.breadth > slab.breadth {
            return Spectrum::BLACK;
        }
        let Some(left) = segment.left_at(self, Some(walker.depth)) else { return Spectrum::BLACK };
        let scattering = Scattering { phase: &slab.filling.phase, wo: -walker.direction, is_dark: false };
        walker.weight * scattering.evaluate(-other.direction).value * other.weight * left
    }

    /// The pieces of the way from wi that may be joined: the one outside, and one of all others, chosen by what they carry.
    fn segments(&self, wi: DVec3, stream: &mut Stream) -> [Option<Segment>; 2] {
        let mut walker = Walker::into(self, wi);
        let first = Segment::of(self, &walker);
        let (mut chosen, mut total) = (None, 0.0);
        let mut is_first = true;
        while walker.breadth < self.layers.most_breadth {
            if !is_first {
                let segment = Segment::of(self, &walker);
                if segment.can_be_joined(self) {
                    let carried = segment.carried(self);
                    total += carried;
                    if stream.draw() * total < carried {
                        chosen = Some(segment);
                    }
                }
                if walker.flies(self, stream) {
                    let Some(slab) = self.slab(walker.gap) else { break };
                    let cosine = walker.direction.dot(self.up).abs();
                    let goes_on = walker.scatter_in(&slab, stream);
                    // Depths were drawn along the way before; the sum over ways has them along the way from wo.
                    walker.weight *= cosine / walker.direction.dot(self.up).abs().max(SMALLEST_COSINE);
                    if !goes_on {
                        break;
                    }
                    continue;
                }
            }
            is_first = false;
            let Some(interface) = self.ahead(walker.gap, walker.direction) else { break };
            let numbers = [stream.draw(), stream.draw(), stream.draw(), stream.draw()];
            let from = -walker.direction;
            let bsdf = self.interface(interface, from, walker.weight, numbers[0]);
            let Some(sample) = Walker::draw(&bsdf, [numbers[1], numbers[2], numbers[3]]) else { break };
            walker.weight *= self.turned_around(interface, from, &sample, (bsdf.view.normal(), walker.weight, numbers[0]));
            if !walker.leave(self, interface, &sample, stream) {
                break;
            }
        }
        if let Some(segment) = &mut chosen {
            segment.walker.weight *= total / segment.carried(self);
        }
        [Some(first), chosen]
    }

    /// f(d, from)·|cos of from| over the density of d, which was drawn as seen from `from`: what light carries on that comes from there and leaves
    /// along d. Where d is the only direction, smooth surfaces are reciprocal but for the squared ratio of indices of refraction by which radiance scales.
    fn turned_around(
        &self,
        interface: usize,
        from: DVec3,
        sample: &BsdfSample,
        (normal, carried, u_blend): (DVec3, Spectrum, f64),
    ) -> Spectrum {
        match sample.density {
            _ if sample.is_null => sample.weight,
            Density::Delta => {
                let cosines = from.dot(normal).abs() / sample.wi.dot(normal).abs().max(SMALLEST_COSINE);
                sample.weight * (cosines * sample.eta * sample.eta)
            }
            Density::SolidAngle(pdf) => self.interface(interface, sample.wi, carried, u_blend).evaluate(from).value / pdf,
        }
    }

    /// Draws wi by a walk: the direction in which it leaves the stack, as a sample whose weight is an estimate of f·|cosθi| over its density. The
    /// density that the sample states says only whether all events had a single direction.
    pub fn walk(&self, wo: DVec3, first: [f64; 3], stream: &mut Stream) -> Option<BsdfSample> {
        let mut walker = Walker::into(self, wo);
        let mut first = Some(first);
        loop {
            if walker.flies(self, stream) {
                let slab = self.slab(walker.gap)?;
                if !walker.scatter_in(&slab, stream) {
                    return None;
                }
                continue;
            }
            let Some(interface) = self.ahead(walker.gap, walker.direction) else {
                let density = if walker.breadth == 0.0 { Density::Delta } else { Density::SolidAngle(0.0) };
                return Some(BsdfSample {
                    wi: walker.direction,
                    weight: walker.weight,
                    density,
                    eta: walker.eta,
                    is_null: false,
                });
            };
            let numbers = [stream.draw(), stream.draw(), stream.draw(), stream.draw()];
            let bsdf = self.interface(interface, -walker.direction, walker.weight, numbers[0]);
            let sample = Walker::draw(&bsdf, first.take().unwrap_or([numbers[1], numbers[2], numbers[3]]))?;
            walker.weight *= sample.weight;
            walker.eta *= sample.eta;
            if !walker.leave(self, interface, &sample, stream) {
                return None;
            }
        }
    }
}
