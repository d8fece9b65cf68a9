//! The value that a picture of a medium has to show, and the judgement of the picture.

use std::path::Path;

use crate::closed_forms::devices;
use crate::common::effort::in_full;
use gpt::compare::{Moments, one_sample_t_test_beyond, sidak};
use gpt::load;
use gpt::scene::{DistanceSampling, Estimator, Scene};

/// Probability that a family fails a program that is right.
const ALPHA: f64 = 0.01;

/// A scene, what all of its pixels have as their mean, and what that would be of a mistake.
pub struct Truth {
    pub name: String,
    pub text: String,
    pub expected: [f64; 3],
    pub mistaken: [f64; 3],
    /// The estimators that see the light of the scene.
    pub estimators: &'static [Estimator],
}

/// Every estimator: the light can be met by chance.
pub const ALL: &[Estimator] = &[Estimator::Mis, Estimator::Nee, Estimator::Bsdf];
/// Point lights and distant ones are never met.
pub const WITH_LIGHT_SAMPLES: &[Estimator] = &[Estimator::Mis, Estimator::Nee];

fn load(text: &str) -> Scene {
    load::load_toml_str(text, "medium", Path::new("")).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Moments of each channel over all pixels.
fn observe(render: crate::closed_forms::Render, scene: &Scene) -> [Moments; 3] {
    let mut moments = [Moments::default(); 3];
    for pixel in render(scene) {
        moments.iter_mut().zip(pixel).for_each(|(channel, value)| channel.push(f64::from(value)));
    }
    moments
}

/// Ways to draw the place where a medium scatters.
const PLACES: [DistanceSampling; 3] = [DistanceSampling::Mis, DistanceSampling::Distance, DistanceSampling::Equiangular];

/// Renders every truth and says which do not hold, or would hold of the mistake as well. In the short form truths take turns with estimators and ways to
/// draw places, all are rendered on the CPU and some on the device; what the device makes of the others is held to the reference elsewhere.
pub fn assert_all_hold(truths: &[Truth]) {
    let everywhere = in_full("media by every estimator and way to draw places, and all of them on the device");
    let ways = |truth: &Truth| {
        truth.estimators.iter().flat_map(|&estimator| PLACES.map(|places| (estimator, places))).collect::<Vec<_>>()
    };
    let level = sidak(ALPHA, truths.iter().map(|truth| 3 * ways(truth).len() * devices().len()).sum());
    let mut failures = Vec::new();
    for (device_number, &(device, render, margin)) in devices().iter().enumerate() {
        for (number, truth) in truths.iter().enumerate() {
            let one_in = [1, 2, 6][device_number];
            let ways = ways(truth);
            let turn = (4 * number + number / 3 + device_number) % ways.len();
            for (index, &(estimator, places)) in ways.iter().enumerate() {
                let is_its_turn = number % one_in == device_number / 2 && index == turn;
                if !everywhere && !is_its_turn {
                    continue;
                }
                let mut scene = load(&truth.text);
                (scene.render.estimator, scene.render.distance_sampling) = (estimator, places);
                if estimator == Estimator::Nee {
                    // Light samples alone are the noisiest.
                    scene.render.spp *= 4;
                }
                scene.render.seed = (number * PLACES.len() * 3 + index) as u32;
                let moments = observe(render, &scene);
                let name = format!("{device}, {}, {estimator:?}, places by {places:?}", truth.name);
                println!("{name}: {}", in_words(&moments));
                failures.extend(judge(truth, &moments, margin, level).map(|fault| format!("{name}: {fault}")));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

fn in_words(moments: &[Moments; 3]) -> String {
    moments.each_ref().map(|observed| format!("{:.6} ± {:.6}", observed.mean(), observed.standard_error())).join(", ")
}

/// The fault, if there is one.
fn judge(truth: &Truth, moments: &[Moments; 3], margin: f64, level: f64) -> Option<String> {
    let is_rejected = |values: &[f64; 3]| {
        let p = |(observed, value): (&Moments, &f64)| one_sample_t_test_beyond(observed, *value, margin * value).p_value;
        moments.iter().zip(values).map(p).fold(1.0, f64::min) < level
    };
    let (expected, mistaken) = (is_rejected(&truth.expected), is_rejected(&truth.mistaken));
    let what = match (expected, mistaken) {
        (false, true) => return None,
        (true, _) => "expected",
        (false, false) => "would pass as",
    };
    let value = if expected { truth.expected } else { truth.mistaken };
    Some(format!("{}, {what} {value:.6?}", in_words(moments)))
}
