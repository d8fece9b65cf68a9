//! Layers with and without boundaries of a dielectric, against adding and doubling.

use super::text::{self, Medium};
use super::truth::{ALL, Truth, WITH_LIGHT_SAMPLES, assert_all_hold};
use crate::common::media::phase::Phase;
use crate::common::media::slab::{Layer, Parts, Solution};

/// The cosine of the direction in which light leaves towards the camera.
const EYE: f64 = 0.7;
/// How thick layers are, in units of length.
const THICKNESS: f64 = 0.5;

/// A layer whose upper side goes through the origin, over a black floor, and a camera above or below.
fn scene(medium: &Medium, index: f64, below: bool, light: String) -> String {
    let sine = (1.0 - EYE * EYE).sqrt();
    let (away, side) = ([0.6 * sine, EYE, 0.8 * sine], if below { -1.0 } else { 1.0 });
    let to = [0.0, if below { -THICKNESS } else { 0.0 }, 0.0];
    let from = std::array::from_fn(|axis| to[axis] + away[axis] * if axis == 1 { side } else { 1.0 });
    let boundary = if index == 1.0 { text::null_boundary("layer") } else { text::glass_boundary("layer", index) };
    let layer = text::block("layer", [-20.0, -THICKNESS, -20.0], [20.0, 0.0, 20.0]);
    text::scene(64, 0, from, to, &[medium.entry("layer"), boundary, layer, text::black_floor(-3.0), light])
}

fn solve(
    medium: &Medium,
    index: f64,
    modes: usize,
    looked_at: &[f64],
    what: &dyn Fn(&Solution) -> Parts,
    below: bool,
) -> [f64; 3] {
    std::array::from_fn(|channel| {
        let (albedo, thickness) = (medium.albedo(channel), medium.extinction(channel) * THICKNESS);
        let layer = Layer { albedo, thickness, phase: medium.phase.clone(), index };
        let parts = what(&Solution::new(&layer, if modes > 1 { 24 } else { 36 }, modes, looked_at));
        if below { parts.transmitted } else { parts.reflected }
    })
}

#[test]
#[ignore = "slow"]
fn layers_under_the_sky_reflect_and_transmit_by_adding_and_doubling() {
    let hg = Phase::HenyeyGreenstein;
    let cases = [
        (Phase::Isotropic, 1.0, false),
        (hg(0.75), 1.0, true),
        (Phase::Rayleigh, 1.5, false),
        (hg(0.6), 1.33, true),
        (Phase::blend(hg(0.8), hg(-0.3), 0.4), 1.4, false),
        (Phase::Isotropic, 1.5, true),
    ];
    let truths = cases.into_iter().map(|(phase, index, below)| {
        let medium = Medium::new([1.0, 4.0, 12.0], [0.6, 0.9, 0.98], phase);
        let solved = |medium: &Medium| solve(medium, index, 1, &[EYE], &|solution| solution.parts(EYE), below);
        Truth {
            name: format!("{:?}, index {index}, {}", medium.phase, if below { "from below" } else { "from above" }),
            text: scene(&medium, index, below, text::SKY.into()),
            expected: solved(&medium),
            mistaken: solved(&medium.scattering_less(0.98)),
            estimators: ALL,
        }
    });
    assert_all_hold(&truths.collect::<Vec<_>>());
}

/// Light from one direction is seen in others, at an azimuth that matters.
#[test]
#[ignore = "slow"]
fn layers_in_the_sun_shine_by_adding_and_doubling() {
    let cosine = 0.5;
    let sine = (1.0f64 - cosine * cosine).sqrt();
    // The light travels along x, and to the camera along (0.6, 0.8).
    let azimuth = f64::atan2(0.8, 0.6);
    let cases =
        [(Phase::Rayleigh, 3, false), (Phase::HenyeyGreenstein(0.5), 14, true), (Phase::HenyeyGreenstein(-0.4), 12, false)];
    let truths = cases.into_iter().map(|(phase, modes, below)| {
        let medium = Medium::new([1.0, 3.0, 8.0], [0.6, 0.9, 0.98], phase);
        let what = |solution: &Solution| solution.radiance([cosine, EYE], azimuth);
        let solved = |medium: &Medium| solve(medium, 1.0, modes, &[cosine, EYE], &what, below).map(|value| 3.0 * value);
        let light = format!("[[light]]\ntype = \"directional\"\ndirection = [{sine:?}, {:?}, 0]\nirradiance = 3\n", -cosine);
        Truth {
            name: format!("{:?} in the sun, {}", medium.phase, if below { "from below" } else { "from above" }),
            text: scene(&medium, 1.0, below, light),
            expected: solved(&medium),
            mistaken: solved(&medium.scattering_less(0.98)),
            estimators: WITH_LIGHT_SAMPLES,
        }
    });
    assert_all_hold(&truths.collect::<Vec<_>>());
}
