//! `--target-error` keeps its promise.

use gpt::compare::RELATIVE_EPSILON;
use statrs::distribution::{Binomial, DiscreteCDF};

use super::*;

/// A hundred, or thirty in the short form.
fn runs() -> u32 {
    if in_full("a hundred renders to a target instead of 30") { 100 } else { 30 }
}

/// The probability with which a promise that is kept in 95 of 100 cases is called broken.
const LEVEL: f64 = 1e-3;

/// Relative mean squared error as `gpt compare` has it.
fn relative_error(picture: &[[f32; 3]], truth: &[[f32; 3]]) -> f64 {
    let pairs = || picture.iter().flatten().zip(truth.iter().flatten()).map(|(a, b)| (f64::from(*a), f64::from(*b)));
    pairs().map(|(a, b)| (a - b).powi(2) / (b * b + RELATIVE_EPSILON)).sum::<f64>() / pairs().count() as f64
}

/// Failures that more than one in a thousand honest series of so many would not exceed.
fn most_failures(runs: usize) -> u64 {
    Binomial::new(0.05, runs as u64).expect("a probability").inverse_cdf(1.0 - LEVEL)
}

/// Errors of pictures relative to the target, ascending, and how many are larger than was expected.
struct Series {
    errors: Vec<f64>,
    above_expectation: u64,
}

/// The truth is the mean of many samples of `sampled`, which shows what `scene` shows.
fn series(scene: &Scene, sampled: &Scene, wanted: &Goal) -> Series {
    let target = wanted.target_error.expect("a promise");
    let options = PlanOptions { pixel_list: wanted.adaptive, ..PlanOptions::default() };
    let make = |scene: &Scene| gpu(DEVICE.as_ref(), scene, &options).unwrap_or_else(|| cpu(scene));
    let truth = pixels(&render_batch(make(sampled).as_mut(), sampled, 0..16_384, 987_654, None));
    let mut renderer = make(scene);
    let mut series = Series { errors: Vec::new(), above_expectation: 0 };
    for seed in 0..runs() {
        let (outcome, bands) = render_goal(renderer.as_mut(), scene, seed, wanted);
        assert_eq!(outcome.stop, Stop::TargetError);
        let error = relative_error(&pixels(&bands), &truth);
        series.above_expectation += u64::from(outcome.error.is_some_and(|estimate| error > estimate.mean));
        series.errors.push(error / target);
    }
    series.errors.sort_by(f64::total_cmp);
    series
}

fn promise(target: f64) -> Goal {
    Goal { target_error: Some(target), ..goal(1 << 20) }
}

fn keeps_its_promise(scene: &Scene, sampled: &Scene, wanted: &Goal) {
    let Series { errors, above_expectation } = series(scene, sampled, wanted);
    let [median, five_of_hundred, largest] = [0.5, 0.95, 0.99].map(|share| errors[(share * errors.len() as f64) as usize]);
    let most_failures = most_failures(errors.len());
    println!(
        "{}: {median:.3} {five_of_hundred:.3} {largest:.3} of the target, {above_expectation} above expectation",
        scene.name
    );
    let failures = errors.iter().filter(|error| **error > 1.0).count() as u64;
    assert!(failures <= most_failures, "{failures} of {}", errors.len());
    // Not more careful than chance asks for: an error of 20 × 20 pixels is that of the few at the edges of a light.
    assert!(five_of_hundred > 0.5, "95 of 100 pictures have less than {five_of_hundred} of the error");
    // The control: the expected error, taken for a bound, is none.
    assert!(above_expectation > most_failures, "{above_expectation}");
}

#[test]
#[ignore = "long: the promise of an error where samples do not follow the noise"]
fn long_the_error_is_below_the_target_in_95_of_100_renders() {
    // The promise is the same, and harder to keep, for samples that follow the noise.
    let mut scene = cornell([20, 20]);
    scene.render.max_depth = 4;
    keeps_its_promise(&scene, &scene, &promise(0.01));
}

/// Points of a sequence are not independent of each other, streams of them are.
#[test]
#[ignore = "long: the promise of an error with points of a sequence"]
fn long_so_it_is_with_points_of_a_sequence() {
    let mut scene = cornell([20, 20]);
    scene.render.max_depth = 4;
    scene.render.sampler = SamplerKind::Sobol;
    keeps_its_promise(&scene, &scene, &promise(0.01));
}

#[test]
#[ignore = "slow"]
fn so_it_is_where_light_is_rare() {
    let scene = rare_light();
    keeps_its_promise(&scene, &sampling_light(&scene), &promise(0.03));
}

/// Streams are independent of each other where they share what decides their pixels' numbers of samples, because that is nothing of their own.
#[test]
#[ignore = "slow"]
fn so_it_is_where_samples_follow_the_noise() {
    let mut scene = cornell([20, 20]);
    scene.render.max_depth = 4;
    // Small enough for several stages.
    keeps_its_promise(&scene, &scene, &Goal { adaptive: true, ..promise(0.003) });
}
