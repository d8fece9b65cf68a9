//! Samples that follow the noise leave the mean where it is.

use gpt::compare::{Moments, TestResult, one_sample_t_test};

use super::*;

const SPP: u32 = 64;

fn mean_radiance(picture: &[[f32; 3]]) -> f64 {
    picture.iter().flatten().map(|value| f64::from(*value)).sum::<f64>() / (3 * picture.len()) as f64
}

/// The mean of all pixels of many pictures against the truth.
fn judge(truth: f64, mut picture: impl FnMut(u32) -> Vec<[f32; 3]>) -> TestResult {
    let mut means = Moments::default();
    // Pictures that are averaged.
    let runs = if in_full("the mean of 300 adaptive renders instead of 150") { 300 } else { 150 };
    (0..runs).for_each(|seed| means.push(mean_radiance(&picture(seed))));
    one_sample_t_test(&means, truth)
}

/// The mistake that `adaptive` must not make: more samples where the first ones met light, and then the plain
/// mean of all. Pixels that were dark by chance stay so.
fn naive(renderer: &mut dyn Renderer, scene: &Scene, seed: u32) -> Vec<[f32; 3]> {
    let (first, all) = (8, 120);
    let pilot = pixels(&render_batch(renderer, scene, 0..first, seed, None));
    let lit: Vec<bool> = pilot.iter().map(|pixel| pixel[0] > 0.0).collect();
    let rest = pixels(&render_batch(renderer, scene, first..all, seed, Some(&lit)));
    let share = first as f32 / all as f32;
    let weighed = |((a, b), lit): (([f32; 3], [f32; 3]), &bool)| {
        if *lit { std::array::from_fn(|channel| share * a[channel] + (1.0 - share) * b[channel]) } else { a }
    };
    pilot.into_iter().zip(rest).zip(&lit).map(weighed).collect()
}

#[test]
#[ignore = "slow"]
fn samples_that_follow_the_noise_leave_the_mean_where_it_is() {
    let scene = rare_light();
    let sampled = sampling_light(&scene);
    let truth = mean_radiance(&pixels(&render_batch(cpu(&sampled).as_mut(), &sampled, 0..4096, 77, None)));
    let options = PlanOptions { pixel_list: true, ..PlanOptions::default() };
    let mut renderer = gpu(DEVICE.as_ref(), &scene, &options).unwrap_or_else(|| cpu(&scene));
    let adaptive = Goal { adaptive: true, ..goal(SPP) };
    let fair = judge(truth, |seed| pixels(&render_goal(renderer.as_mut(), &scene, 7 * seed, &adaptive).1));
    let control = judge(truth, |seed| naive(renderer.as_mut(), &scene, 7 * seed));
    println!("adaptive {:.2}, naive {:.2} standard errors from the truth {truth}", fair.statistic, control.statistic);
    assert!(fair.p_value > 1e-3, "{fair:?}");
    assert!(control.p_value < 1e-6 && control.statistic < 0.0, "the naive estimator passes: {control:?}");
}

/// The reference is tested with fewer pictures, and with the streams of a target that is never reached.
#[test]
#[ignore = "slow"]
fn the_reference_and_streams_are_unbiased_too() {
    let scene = rare_light();
    let sampled = sampling_light(&scene);
    let mut renderer = cpu(&scene);
    let truth = mean_radiance(&pixels(&render_batch(cpu(&sampled).as_mut(), &sampled, 0..4096, 78, None)));
    let wanted = Goal { adaptive: true, target_error: Some(1e-9), ..goal(8 * SPP) };
    let mut means = Moments::default();
    for seed in 0..40 {
        let (outcome, bands) = render_goal(renderer.as_mut(), &scene, 11 * seed, &wanted);
        assert_eq!(outcome.stop, Stop::Samples);
        means.push(mean_radiance(&pixels(&bands)));
    }
    let result = one_sample_t_test(&means, truth);
    assert!(result.p_value > 1e-3, "{result:?}");
}
