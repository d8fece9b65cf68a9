//! Rays through media that differ from place to place.
//!
//! Coarse cells of a medium's grid bound its density, and a ray takes the parts of its way within them one after the other. A scattered path is
//! tracked by null collisions (Woodcock and others 1965; Miller, Georgiev and Jarosz 2019): collisions are drawn as if the density were the bound,
//! and one is real with the probability density / bound. The channel by which they are drawn is chosen by what the path carries. The density of the
//! whole flight under channel c is, up to a factor that all share, f = extinction_c^k · exp(−extinction_c · D) · p, where k collisions were drawn, D is
//! the integral of the bounds along the way, and p the probability that each collision was what it was, real or null. What the channel carries on is
//! as much, so the channels share the flight by multiple importance sampling: each weighs f over the mean of all f.
//!
//! The light that passes unscattered is estimated by residual ratio tracking (Novák, Selle and Jarosz 2014): the smallest density of a cell is taken away
//! exactly, the rest at collisions. `shaders/shading/medium/tracking.wgsl` is the same in f32.

use super::free_flight::Flight;
use super::intersect::Ray;
use crate::sampling::hash::dimension_bits;
use crate::sampling::sampler::open;
use crate::scene::media::{FAINT, FARTHEST, MOST_LOOKUPS};
use crate::scene::{Filling, MediumGrids};
use crate::spectrum::Spectrum;

/// Random numbers in (0, 1), as many as are asked for, hashed from a key.
#[derive(Debug, Clone)]
pub struct Stream {
    key: u32,
    count: u32,
}

impl Stream {
    pub fn new(key: u32) -> Self {
        Self { key, count: 0 }
    }

    pub fn draw(&mut self) -> f64 {
        self.count += 1;
        open(dimension_bits(self.key, self.count - 1))
    }
}

/// A ray's way through a medium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// An estimate of the share of light that is left.
    pub left: Spectrum,
    /// An estimate of the light that the medium gives off, as it arrives at the ray's origin.
    pub given_off: Spectrum,
}

/// Flies along the first `length` of a ray through a medium with grids that scatters, with a path of this throughput. The weight of a flight that is
/// scattered holds the albedo there.
pub fn track(
    (filling, grids): (&Filling, &MediumGrids),
    throughput: Spectrum,
    (ray, length): (&Ray, f64),
    mut draw: impl FnMut() -> f64,
) -> Flight {
    if throughput.is_black() {
        return Flight { scattered_at: None, weight: Spectrum::WHITE };
    }
    let chances = throughput / throughput.sum();
    let channel = match draw() {
        choice if choice < chances.r() => 0,
        choice if choice < chances.r() + chances.g() => 1,
        _ => 2,
    };
    let rate = filling.extinction.to_rgb()[channel];
    let mut depth_left = -draw().ln();
    let (mut bounds, mut collisions, mut odds) = (0.0, 0, Spectrum::WHITE);
    for segment in grids.density().crossing(grids.majorants(), [ray.origin, ray.direction], [0.0, length.min(FARTHEST)]) {
        let mut at = segment.entry;
        loop {
            let room = segment.maximum * (segment.exit - at);
            if depth_left >= rate * room {
                depth_left -= rate * room;
                bounds += room;
                break;
            }
            bounds += depth_left / rate;
            at = (at + depth_left / (rate * segment.maximum)).min(segment.exit);
            collisions += 1;
            let real = grids.density_in(segment.cell, ray.at(at)) / segment.maximum;
            let of_chosen = real.to_rgb()[channel];
            if draw() < of_chosen {
                odds = limited(odds * (real / of_chosen));
                let scattered = filling.scattering / filling.extinction.max(Spectrum::grey(f64::MIN_POSITIVE));
                let albedo = grids.albedo().map_or(Spectrum::WHITE, |albedo| albedo.value_at(ray.at(at)));
                let weight =
                    channel_weights(filling.extinction, chances, channel, (collisions, bounds, odds)) * scattered * albedo;
                return Flight { scattered_at: Some(at), weight };
            }
            odds = limited(odds * ((Spectrum::WHITE - real) / (1.0 - of_chosen)));
            if collisions == MOST_LOOKUPS {
                return Flight { scattered_at: None, weight: Spectrum::BLACK };
            }
            depth_left = -draw().ln();
        }
    }
    Flight { scattered_at: None, weight: channel_weights(filling.extinction, chances, channel, (collisions, bounds, odds)) }
}

/// Odds that stay finite in single precision.
fn limited(odds: Spectrum) -> Spectrum {
    odds.clamp(Spectrum::BLACK, Spectrum::grey(1e30))
}

/// The density of a flight under each channel over the mean by the chances with which channels are chosen; 0 of channels that the path does not carry.
/// `odds` are the probabilities of what collisions were, beside those by the chosen channel.
fn channel_weights(
    extinction: Spectrum,
    chances: Spectrum,
    chosen: usize,
    (collisions, bounds, odds): (u32, f64, Spectrum),
) -> Spectrum {
    let [extinction, chances, odds] = [extinction, chances, odds].map(Spectrum::to_rgb);
    // Logarithms beside that of the chosen channel, so that equal channels weigh 1 to the last bit.
    let beside = |channel: usize| {
        if channel == chosen || extinction[channel] == extinction[chosen] {
            return 0.0;
        }
        let of_collisions =
            if collisions == 0 { 0.0 } else { f64::from(collisions) * (extinction[channel] / extinction[chosen]).ln() };
        of_collisions - (extinction[channel] - extinction[chosen]) * bounds
    };
    let logarithms: [f64; 3] = std::array::from_fn(beside);
    let carried = |channel: &usize| chances[*channel] > 0.0;
    let largest = (0..3).filter(carried).map(|channel| logarithms[channel]).fold(f64::NEG_INFINITY, f64::max);
    let of_channels: [f64; 3] =
        std::array::from_fn(
            |channel| if carried(&channel) { (logarithms[channel] - largest).exp() * odds[channel] } else { 0.0 },
        );
    let mean: f64 = (0..3).map(|channel| chances[channel] * of_channels[channel]).sum();
    Spectrum::from_rgb(of_channels) / mean
}

/// Estimates what a ray's first `length` through a medium with grids leaves of light, and, where it is asked for, what the medium gives off along it.
pub fn pass_through(
    (filling, grids): (&Filling, &MediumGrids),
    (ray, length): (&Ray, f64),
    emits: bool,
    mut draw: impl FnMut() -> f64,
) -> Passage {
    let rate = filling.tracking_rate();
    let mut passage = Passage { left: Spectrum::WHITE, given_off: Spectrum::BLACK };
    if rate == 0.0 {
        return passage;
    }
    let mut depth_left = -draw().ln();
    let mut lookups = 0;
    for segment in grids.density().crossing(grids.majorants(), [ray.origin, ray.direction], [0.0, length.min(FARTHEST)]) {
        // Light that is given off is looked up where collisions are
        let control = if emits { 0.0 } else { segment.minimum };
        let residual = segment.maximum - control;
        passage.left *= (filling.extinction * -(control * (segment.exit - segment.entry))).exp();
        let mut at = segment.entry;
        loop {
            let room = rate * residual * (segment.exit - at);
            if depth_left >= room {
                depth_left -= room;
                break;
            }
            at = (at + depth_left / (rate * residual)).min(segment.exit);
            let place = ray.at(at);
            let density = grids.density_in(segment.cell, place);
            let share = ((density - Spectrum::grey(control)) / residual).clamp(Spectrum::BLACK, Spectrum::WHITE);
            if emits {
                let factor = grids.emission().map_or(Spectrum::WHITE, |emission| emission.value_at(place));
                passage.given_off += passage.left * filling.emission * factor * share / rate;
            }
            passage.left *= Spectrum::WHITE - filling.extinction * share / rate;
            lookups += 1;
            if passage.left.max_component() < FAINT && !survives(&mut passage.left, draw()) || lookups == MOST_LOOKUPS {
                passage.left = Spectrum::BLACK;
                return passage;
            }
            depth_left = -draw().ln();
        }
    }
    passage
}

/// Faint light goes on by one half, and then counts twice as much.
fn survives(left: &mut Spectrum, u: f64) -> bool {
    *left *= 2.0;
    u < 0.5 && !left.is_black()
}
