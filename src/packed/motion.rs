//! Motions as the device follows them, and what moving primitives sweep.

use glam::{DAffine3, DVec3, Vec3};

use super::primitive::WorldPrimitive;
use crate::math::outward;
use crate::scene::{Motion, MotionStep, Shape};
use crate::shader::shared::shared_constants;

shared_constants!(constants {
    /// Kinds of steps.
    const STEP_TRANSLATE: u32 = 0;
    const STEP_SCALE: u32 = 1;
    const STEP_ROTATE: u32 = 2;
    pub(super) const KINDS_OF_STEPS: u32 = 3;
});

/// How finely what a shape sweeps is sampled: deviations from straight lines stay below this share of its radius, if few enough times do.
const DEVIATION: f64 = 0.01;
/// Most times at which a sweep is sampled, beside the first.
const MOST_TIMES: f64 = 64.0;
/// Share of the largest coordinate by which boxes grow for the rounding of moved points in single precision.
const ROUNDING: f64 = 4e-6;

/// One shape's motion, and what its primitives need for their bounds.
#[derive(Debug, Clone)]
pub struct PackedMotion {
    origin: DVec3,
    steps: Vec<PackedStep>,
    /// The maps at evenly spaced times from the shutter's opening to its closing.
    maps: Vec<DAffine3>,
}

/// A step over the time for which the shutter is open: 0 as it opens, 1 as it closes.
#[derive(Debug, Clone, Copy)]
enum PackedStep {
    Translate {
        start: DVec3,
        change: DVec3,
    },
    Scale {
        start: DVec3,
        change: DVec3,
    },
    /// In turns.
    Rotate {
        axis: DVec3,
        start: f64,
        change: f64,
    },
}

impl PackedMotion {
    /// None: the shape rests.
    pub fn new(shape: &Shape, shutter: [f64; 2]) -> Option<Self> {
        shape.motion.as_ref().map(|motion| Self::about(motion, shape.origin(), shutter))
    }

    /// The motion of geometry given about `origin`.
    pub fn about(motion: &Motion, origin: DVec3, shutter: [f64; 2]) -> Self {
        let shares = shutter.map(|time| motion.share(time));
        let steps = motion.steps.iter().map(|&step| PackedStep::new(step, shares)).collect();
        Self::sampled(steps, origin, shutter, &|time| motion.at(time, origin))
    }

    /// With the maps at so many times as it bends.
    fn sampled(steps: Vec<PackedStep>, origin: DVec3, [open, close]: [f64; 2], at: &dyn Fn(f64) -> DAffine3) -> Self {
        let (relative, _) = bend(&steps, 1.0);
        let times = (relative / (8.0 * DEVIATION)).sqrt().ceil().clamp(1.0, MOST_TIMES) as u32;
        let time = |index: u32| open + (close - open) * f64::from(index) / f64::from(times);
        let maps = (0..=times).map(|index| at(time(index))).collect();
        Self { origin, steps, maps }
    }

    /// The motion of an instance relative to its transform at rest, about `pivot`.
    pub fn of_instance(motion: &Motion, pivot: DVec3, shutter: [f64; 2]) -> Self {
        let about_place = Self::about(motion, DVec3::ZERO, shutter);
        if pivot == DVec3::ZERO {
            return about_place;
        }
        let shift = |start: DVec3| PackedStep::Translate { start, change: DVec3::ZERO };
        let mut steps = vec![shift(-pivot)];
        steps.extend(about_place.steps);
        steps.push(shift(pivot));
        Self::sampled(steps, DVec3::ZERO, shutter, &|time| motion.at(time, pivot))
    }

    /// The rows of `motion` in `shaders/geometry/motion.wgsl`: origin and number of steps; then, of each step, its start and kind, and
    /// its change until the shutter closes.
    pub fn words(&self) -> Vec<[f32; 4]> {
        let row = |v: DVec3, w: u32| v.as_vec3().extend(f32::from_bits(w)).to_array();
        let mut words = vec![row(self.origin, self.steps.len() as u32)];
        for step in &self.steps {
            words.extend(match *step {
                PackedStep::Translate { start, change } => [row(start, STEP_TRANSLATE), row(change, 0)],
                PackedStep::Scale { start, change } => [row(start, STEP_SCALE), row(change, 0)],
                PackedStep::Rotate { axis, start, change } => [row(axis, STEP_ROTATE), row(DVec3::new(start, change, 0.0), 0)],
            });
        }
        words
    }

    /// A box around all that the primitive sweeps while the shutter is open: the boxes at the sampled times, grown by how far a point
    /// can leave the straight line between two of them, h²/8 times the largest second derivative.
    pub fn swept(&self, primitive: &WorldPrimitive) -> Option<(Vec3, Vec3)> {
        let double = |(low, high): (Vec3, Vec3)| [low.as_dvec3(), high.as_dvec3()];
        // A primitive that is bounded at rest is bounded in motion.
        let moved =
            |map: &DAffine3| primitive.geometry.moved(map).bounds().map_or([DVec3::INFINITY, DVec3::NEG_INFINITY], double);
        let (low, high) = self.swept_by(double(primitive.bounds()?), &moved);
        Some(outward(low, high))
    }

    /// Bounds of moving geometry, from its bounds at rest and the bounds of its image under a map.
    pub fn swept_by(&self, [low, high]: [DVec3; 2], moved: &dyn Fn(&DAffine3) -> [DVec3; 2]) -> (DVec3, DVec3) {
        let radius = (low - self.origin).abs().max((high - self.origin).abs()).length();
        let (second, farthest) = bend(&self.steps, radius);
        let intervals = (self.maps.len() - 1) as f64;
        let mut swept = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        for map in &self.maps {
            let [low, high] = moved(map);
            swept = [swept[0].min(low), swept[1].max(high)];
        }
        let deviation = second / (8.0 * intervals * intervals);
        let largest = swept[0].abs().max(swept[1].abs()).max_element() + self.origin.abs().max_element() + farthest;
        let margin = deviation + ROUNDING * largest;
        // Nothing leaves the sphere around the origin that the farthest point can reach.
        let reach = farthest + ROUNDING * largest;
        ((swept[0] - margin).max(self.origin - reach), (swept[1] + margin).min(self.origin + reach))
    }
}

impl PackedStep {
    fn new(step: MotionStep, [open, close]: [f64; 2]) -> Self {
        match step {
            MotionStep::Translate(offset) => Self::Translate { start: offset * open, change: offset * (close - open) },
            MotionStep::Scale(scale) => {
                Self::Scale { start: MotionStep::factors(scale, open), change: (scale - DVec3::ONE) * (close - open) }
            }
            MotionStep::Rotate { axis, degrees } => {
                let turns = degrees / 360.0;
                Self::Rotate { axis: axis.normalize(), start: (turns * open).rem_euclid(1.0), change: turns * (close - open) }
            }
            MotionStep::Turned { axis, degrees } => {
                Self::Rotate { axis: axis.normalize(), start: (degrees / 360.0).rem_euclid(1.0), change: 0.0 }
            }
        }
    }
}

/// Bounds on the second derivative by shutter time of a point that at rest is within `radius` of the origin, and on its distance from
/// there. Each step is a product or a sum of functions of time, whose derivatives follow by Leibniz's rule.
fn bend(steps: &[PackedStep], radius: f64) -> (f64, f64) {
    let (mut value, mut first, mut second) = (radius, 0.0, 0.0);
    for step in steps {
        match *step {
            PackedStep::Translate { start, change } => {
                value += start.length().max((start + change).length());
                first += change.length();
            }
            PackedStep::Scale { start, change } => {
                let (factor, rate) = (start.abs().max((start + change).abs()).max_element(), change.abs().max_element());
                second = factor * second + 2.0 * rate * first;
                first = factor * first + rate * value;
                value *= factor;
            }
            PackedStep::Rotate { change, .. } => {
                let rate = std::f64::consts::TAU * change.abs();
                second += 2.0 * rate * first + rate * rate * value;
                first += rate * value;
            }
        }
    }
    (second, value)
}
