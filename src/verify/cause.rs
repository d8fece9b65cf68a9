//! Why the radiance of a path differs between two devices: by rounding, or by a mistake.
//!
//! A mistake changes the value of a path wherever it acts. Rounding changes it only where the path magnifies errors of a few units in the last place,
//! or where such an error turns a decision over. So the reference follows the path again with [errors of that size](Rounding), and
//! asks how far its own value moves. A difference that is not much larger than that is explained; any other is not.

use rayon::prelude::*;
use serde::Serialize;

use crate::cpu::ReferenceRenderer;
use crate::reference::rounding::Rounding;
use crate::sampling::hash::mix;
use crate::spectrum::Spectrum;

/// How often a path is followed before its difference counts as unexplained.
const TRIES: u32 = 512;
/// Paths are followed so often at a time, side by side.
const TRIES_AT_ONCE: u32 = 32;
/// Rounding errors that are drawn, in units of the last place: from the first to the second, evenly by their logarithm. Kernels bound
/// the error of a surface point by some sixteen of them.
const UNITS: [f64; 2] = [2.0, 32.0];
/// A difference may be so many times as large as the largest that was seen among the tries.
const SAFETY: f64 = 2.0;

/// The largest difference that rounding explains on any path of a picture with this mean radiance. What is left where numbers of order one
/// cancel, such as one minus a Fresnel term next to 1, is off by an error of rounding's size in them, however small it is itself.
pub fn of_cancellation(mean_radiance: f64) -> f64 {
    SAFETY * UNITS[1] * f64::from(f32::EPSILON) * 0.5 * mean_radiance
}

/// A path whose radiance differs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Differing {
    /// Column, row, sample.
    pub path: [u32; 3],
    pub first: [f32; 3],
    pub second: [f32; 3],
}

impl Differing {
    /// In the channel where it is largest.
    pub fn difference(&self) -> f64 {
        distance(Spectrum::from_f32(self.first), Spectrum::from_f32(self.second))
    }

    /// True if all channels agree to this share of the largest, or differ by less than underflow explains.
    pub fn agrees_to(&self, tolerance: f64) -> bool {
        let largest = self.first.iter().chain(&self.second).fold(0.0_f32, |largest, x| largest.max(x.abs()));
        self.difference() <= (tolerance * f64::from(largest)).max(UNDERFLOW)
    }
}

/// See [`Differing::agrees_to`]. Devices may flush what is below the smallest normal number of f32, 1.2e-38, and a factor that was flushed may
/// have stood before large ones.
const UNDERFLOW: f64 = 1e-30;

fn distance(a: Spectrum, b: Spectrum) -> f64 {
    (a - b).map(f64::abs).max_component()
}

/// The explanation of a difference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// Rounding errors turn a decision over: which primitive is met, what is visible, which lobe is drawn, whether the path goes on.
    Decision,
    /// With the same decisions, the path magnifies rounding errors.
    Steepness,
    /// Nothing: rounding errors do not move the path's value as far.
    Unexplained,
}

/// The explanation of a differing path of the scene that `reference` was made from.
pub fn of(differing: &Differing, reference: &ReferenceRenderer) -> Cause {
    let [x, y, sample] = differing.path;
    let mut exact = Rounding::none();
    let value = reference.rounded_radiance(x, y, sample, &mut exact);
    let needed = differing.difference() / SAFETY;
    let follow = |attempt: u32| {
        let seed = mix(attempt ^ mix(x ^ mix(y ^ mix(sample))));
        let units = UNITS[0] * (UNITS[1] / UNITS[0]).powf(f64::from(attempt % TRIES_AT_ONCE) / f64::from(TRIES_AT_ONCE - 1));
        let mut rounding = Rounding::of_units(units, seed);
        let moved = distance(reference.rounded_radiance(x, y, sample, &mut rounding), value);
        // A value that is not a number has moved as far as can be.
        let far = moved.is_nan() || moved >= needed;
        far.then(|| if rounding.decisions() == exact.decisions() { Cause::Steepness } else { Cause::Decision })
    };
    for first in (0..TRIES).step_by(TRIES_AT_ONCE as usize) {
        let found: Vec<Cause> = (first..first + TRIES_AT_ONCE).into_par_iter().filter_map(follow).collect();
        // The milder explanation first.
        if let Some(&cause) = found.iter().find(|cause| **cause == Cause::Steepness).or(found.first()) {
            return cause;
        }
    }
    Cause::Unexplained
}

/// Which of many paths to look into: all of them, or as many as `most` drawn at random, each as likely as the others.
#[derive(Debug)]
pub struct Selection {
    most: usize,
    seen: u64,
    chosen: Vec<Differing>,
}

impl Selection {
    pub fn of_at_most(most: usize) -> Self {
        Self { most, seen: 0, chosen: Vec::new() }
    }

    /// Reservoir sampling (Vitter 1985, algorithm R); the hash makes the same choice every time.
    pub fn add(&mut self, differing: Differing) {
        let number = self.seen;
        self.seen += 1;
        if self.chosen.len() < self.most {
            self.chosen.push(differing);
            return;
        }
        let bits = u64::from(mix(number as u32)) << 32 | u64::from(mix(number as u32 ^ 0x5bd1_e995));
        let place = ((u128::from(bits) * u128::from(self.seen)) >> 64) as usize;
        if let Some(slot) = self.chosen.get_mut(place) {
            *slot = differing;
        }
    }

    pub fn into_chosen(self) -> Vec<Differing> {
        self.chosen
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effort::in_full;
    use crate::load;
    use crate::scene::Scene;

    fn small(name: &str) -> Scene {
        let mut scene = load::load(Some(name)).expect("it is built in");
        scene.film.size = [24, 16];
        scene
    }

    /// All pixels' samples number 0, as `change` leaves them, beside what they are.
    fn pairs(reference: &ReferenceRenderer, change: impl Fn([u32; 3], Spectrum) -> Spectrum) -> Vec<Differing> {
        let pixels = (0..16).flat_map(|y| (0..24).map(move |x| [x, y, 0]));
        let pair = |path: [u32; 3]| {
            let [x, y, sample] = path;
            let value = reference.rounded_radiance(x, y, sample, &mut Rounding::none());
            let [first, second] = [change(path, value), value].map(|value| value.to_f32());
            Differing { path, first, second }
        };
        pixels.map(pair).collect()
    }

    fn differs(pair: &Differing) -> bool {
        let size = pair.second.iter().fold(0.0_f64, |size, x| size.max(f64::from(*x)));
        pair.difference() > 1e-4 * size
    }

    /// Without errors the path is the path.
    #[test]
    fn no_rounding_changes_nothing() {
        for name in ["cornell", "crystal", "terrace"] {
            let reference = ReferenceRenderer::new(&small(name)).expect("it is supported");
            for pair in pairs(&reference, |_, value| value) {
                let [x, y, sample] = pair.path;
                let exact = Spectrum::from_rgb(reference.radiance_of_sample(x, y, sample)).to_f32();
                assert_eq!(pair.first, exact, "{name}, {:?}", pair.path);
            }
        }
    }

    /// Values that errors of a middling size make, by other random numbers than those of the tries.
    #[test]
    fn what_rounding_makes_is_explained() {
        let mut differing = 0;
        for name in ["cornell", "crystal", "terrace", "gallery"] {
            let reference = ReferenceRenderer::new(&small(name)).expect("it is supported");
            let rounded = |[x, y, sample]: [u32; 3], _| {
                reference.rounded_radiance(x, y, sample, &mut Rounding::of_units(8.0, 77 + 1000 * x + y))
            };
            for pair in pairs(&reference, rounded).into_iter().filter(differs) {
                differing += 1;
                assert_ne!(of(&pair, &reference), Cause::Unexplained, "{name}, {pair:?}");
            }
        }
        assert!(differing > 5, "{differing} paths show rounding");
    }

    /// A thousandth too much is explained on steep paths alone, and those are few.
    #[test]
    fn a_mistake_of_a_thousandth_is_not_explained() {
        let everything = in_full("following all paths that are a thousandth off instead of 150 of a scene");
        for (name, least) in [("cornell", 0.95), ("gallery", 0.9), ("terrace", 0.7)] {
            let reference = ReferenceRenderer::new(&small(name)).expect("it is supported");
            let mut wrong: Vec<Differing> = pairs(&reference, |_, value| 1.001 * value).into_iter().filter(differs).collect();
            let step = if everything { 1 } else { wrong.len().div_ceil(150).max(1) };
            wrong = wrong.into_iter().step_by(step).collect();
            let unexplained = wrong.iter().filter(|pair| of(pair, &reference) == Cause::Unexplained).count();
            let share = unexplained as f64 / wrong.len() as f64;
            assert!(wrong.len() > 75 && share > least, "{name}: {share} of {} paths", wrong.len());
        }
    }

    /// A device may meet any of the surfaces in one plane, but nothing else.
    #[test]
    fn which_of_two_surfaces_in_one_plane_is_met_is_a_decision() {
        let text = r#"
            film = { size = [24, 16] }
            camera = { position = [0.3, 0.4, 5.0], look_at = [0.1, 0.0, 0.0], vfov = 40 }
            render = { spp = 1 }
            material = [{ name = "red", type = "emissive", radiance = [2.0, 0.1, 0.1] }, { name = "blue", type = "emissive", radiance = [0.1, 0.1, 3.0] }]
            shape = [
                { type = "rectangle", corner = [-9.0, -9.0, 0.2], edge_u = [18.0, 0.0, 0.0], edge_v = [0.0, 18.0, 0.0], material = "red" },
                { type = "rectangle", corner = [-7.7, -8.1, 0.2], edge_u = [15.3, 0.0, 0.0], edge_v = [0.0, 16.9, 0.0], material = "blue" },
            ]
        "#;
        let scene = load::load_toml_str(text, "planes", std::path::Path::new(".")).expect("it is sound");
        let reference = ReferenceRenderer::new(&scene).expect("it is supported");
        let [red, blue, neither] = [Spectrum::new(2.0, 0.1, 0.1), Spectrum::new(0.1, 0.1, 3.0), Spectrum::new(1.0, 0.1, 1.5)];
        let causes = |other: fn([Spectrum; 3], Spectrum) -> Spectrum| -> Vec<Cause> {
            let pairs = pairs(&reference, |_, value| other([red, blue, neither], value));
            pairs.iter().map(|pair| of(pair, &reference)).collect()
        };
        let of_the_other = causes(|[red, blue, _], value| if value.distance(red) < 1e-6 { blue } else { red });
        assert!(of_the_other.iter().all(|cause| *cause == Cause::Decision), "{of_the_other:?}");
        let of_neither = causes(|[.., neither], _| 4.0 * neither);
        assert!(of_neither.iter().all(|cause| *cause == Cause::Unexplained), "{of_neither:?}");
    }

    /// Each of many is as likely to be chosen as any other: of 4000 paths, 100 from every thousand within four standard deviations.
    #[test]
    fn the_selection_is_even() {
        let mut selection = Selection::of_at_most(400);
        (0..4000).for_each(|x| selection.add(Differing { path: [x, 0, 0], first: [0.0; 3], second: [1.0; 3] }));
        let mut counts = [0_i32; 4];
        selection.into_chosen().iter().for_each(|chosen| counts[chosen.path[0] as usize / 1000] += 1);
        assert_eq!(counts.iter().sum::<i32>(), 400);
        assert!(counts.iter().all(|count| (count - 100).abs() < 35), "{counts:?}");
    }
}
