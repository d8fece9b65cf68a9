use approx::assert_relative_eq;

use super::*;
use crate::bench::interval::IntervalVerdict;
use crate::bench::schedule::observe_schedule;
use crate::bench::subject::Subject;
use crate::bench::synthetic::Synthetic;
use crate::statistics::random::SplitMix64;

/// A measurement of synthetic settings; the reference has the own error of so many samples, or none.
fn measure(settings: Vec<Synthetic>, reference_spp: Option<u32>, schedule: &SampleSchedule) -> (Vec<Observations>, Reference) {
    let sigma = settings[0].sigma;
    let mut truth = Synthetic { sigma, ..Synthetic::default() };
    let reference = match reference_spp {
        Some(spp) => Reference::render(&mut truth, spp).unwrap(),
        None => Reference {
            image: truth.converged(),
            own_error: Some(Default::default()),
            spp: None,
            origin: String::new(),
            warnings: Vec::new(),
        },
    };
    let mut subjects: Vec<Box<dyn Subject>> = settings.into_iter().map(|one| Box::new(one) as Box<dyn Subject>).collect();
    let (observations, interrupted) = observe_schedule(&mut subjects, &reference, schedule, &mut |_| {}).unwrap();
    assert!(!interrupted);
    (observations, reference)
}

fn schedule(seed: u32) -> SampleSchedule {
    SampleSchedule::doubling(64, 5, 7, seed)
}

/// σ²/n comes out with the stated confidence, though the reference is noisy itself; 1.1 σ²/n, the control, does not.
#[test]
fn a_known_variance_is_reported() {
    let (measurements, levels) = (40, 5);
    let mut covered = [0.0, 0.0];
    for seed in 0..measurements {
        let setting = Synthetic { sigma: 0.2, ..Synthetic::default() };
        let (observations, reference) = measure(vec![setting], Some(256), &schedule(seed));
        for level in curve(&observations[0], &reference, &schedule(seed)).levels {
            let truth = 0.04 / f64::from(level.spp);
            covered[0] += f64::from(u8::from(level.mse.contains(truth)));
            covered[1] += f64::from(u8::from(level.mse.contains(1.1 * truth)));
        }
    }
    // The reference's parts have the same seeds each time, so its small error is shared: a loose binomial bound, 4.5 deviations.
    let share = covered[0] / f64::from(measurements * levels);
    assert!((share - 0.95).abs() < 4.5 * (0.95 * 0.05 / 200.0_f64).sqrt(), "{share} of the intervals hold the truth");
    assert!(covered[1] / 200.0 < 0.2, "{} of the intervals hold 10 % too much", covered[1]);
}

#[test]
fn independent_samples_have_slope_minus_one_and_no_floor() {
    let mut flagged = 0;
    for seed in 0..20 {
        let (observations, reference) = measure(vec![Synthetic::default()], Some(1024), &schedule(seed));
        let curve = curve(&observations[0], &reference, &schedule(seed));
        for trend in &curve.trends {
            let slope = trend.slope.unwrap();
            assert_eq!(trend.fitted_levels, 5);
            // Three times the interval: 40 of them are looked at.
            let half = 1.5 * (slope.high - slope.low);
            assert!((slope.estimate + 1.0).abs() < half.max(1e-3), "{slope:?}");
            assert!(half < 0.05, "a slope known to {half} says nothing");
            flagged += u32::from(trend.floor.flagged);
        }
    }
    assert_eq!(flagged, 0, "floors where there is none");
}

/// A bias of a fifth of the last level's deviation is a twenty-fifth of its squared error: seen, sized and flagged, and the slope above it is
/// still −1.
#[test]
fn a_bias_is_a_floor_and_is_flagged() {
    for bias in [0.005, 0.05] {
        let setting = Synthetic { sigma: 0.2, bias, ..Synthetic::default() };
        let (observations, reference) = measure(vec![setting], Some(2048), &schedule(3));
        let curve = curve(&observations[0], &reference, &schedule(3));
        let trend = &curve.trends[0];
        assert!(trend.floor.flagged, "{:?}", trend.floor);
        assert!(trend.floor.squared_bias.contains(bias * bias), "{:?} for {bias}", trend.floor);
        if let Some(slope) = trend.slope {
            assert!((slope.estimate + 1.0).abs() < 0.03, "{slope:?}");
        }
    }
    // The large bias keeps eight times the samples from dividing the error by eight: (σ²/64 + b²) / (σ²/8 + b²) = 0.42.
    let setting = Synthetic { sigma: 0.2, bias: 0.05, ..Synthetic::default() };
    let (observations, reference) = measure(vec![setting], Some(2048), &schedule(3));
    let levels = curve(&observations[0], &reference, &schedule(3)).levels;
    assert_relative_eq!(levels[4].mse.estimate / levels[1].mse.estimate, 0.4167, max_relative = 0.03);
}

/// A reference with an error that is taken for none shows as a floor, and says that it may be the reference's.
#[test]
fn an_unknown_reference_error_is_not_taken_for_bias_alone() {
    let (observations, mut reference) = measure(vec![Synthetic::default()], Some(64), &schedule(1));
    assert!(!curve(&observations[0], &reference, &schedule(1)).trends[0].floor.flagged);
    reference.own_error = None;
    let floor = curve(&observations[0], &reference, &schedule(1)).trends[0].floor;
    assert!(floor.flagged && floor.may_be_the_references, "{floor:?}");
}

/// Two settings that take turns on a machine whose speed drifts by half, with 2 % of noise of their own.
fn pair(slowdown: f64, sigma: f64, clock: u64) -> Vec<Synthetic> {
    let first = Synthetic { time_noise: 0.02, clock: SplitMix64::new(clock), ..Synthetic::default() };
    let second = Synthetic {
        sigma,
        seconds_per_sample: first.seconds_per_sample * slowdown,
        time_noise: 0.02,
        clock: SplitMix64::new(clock + 1000),
        machine: first.machine.clone(),
        ..Synthetic::default()
    };
    vec![first, second]
}

#[test]
fn a_slowdown_of_ten_per_cent_is_seen() {
    for seed in 0..10 {
        let schedule = SampleSchedule { replications: 15, ..schedule(seed) };
        let (observations, reference) = measure(pair(1.1, 0.2, seed.into()), None, &schedule);
        let comparison = compare_settings(&observations[1], &observations[0], &reference, Metric::Mse);
        let time = comparison.time_at_equal_samples;
        assert_eq!(time.verdict, IntervalVerdict::More, "{time:?}");
        assert!((time.interval.estimate - 1.1).abs() < 0.04, "{time:?}");
        // Equal samples have equal errors, so at equal time the slower setting is worse by its slowness.
        assert!((comparison.efficiency.interval.estimate * 1.1 - 1.0).abs() < 0.05, "{comparison:?}");
        let at_equal_time = comparison.error_at_equal_time.unwrap().ratio;
        assert!((at_equal_time.interval.estimate - 1.1).abs() < 0.06, "{at_equal_time:?}");
        let to_equal_error = comparison.time_to_equal_error.unwrap().ratio;
        assert!((to_equal_error.interval.estimate - 1.1).abs() < 0.06, "{to_equal_error:?}");
    }
}

/// The control of the slowdown, and efficiency against itself: chance alone moves the ratio out of its interval as rarely as it says.
#[test]
fn a_setting_against_itself_is_inside_the_noise() {
    let mut seen_apart = [0, 0];
    let mut confidence = 0.0;
    let measurements = 40;
    for seed in 0..measurements {
        let (observations, reference) = measure(pair(1.0, 0.2, u64::from(seed) * 7 + 3), None, &schedule(seed));
        let comparison = compare_settings(&observations[1], &observations[0], &reference, Metric::Mse);
        for (count, ratio) in seen_apart.iter_mut().zip([comparison.time_at_equal_samples, comparison.efficiency]) {
            *count += u32::from(ratio.verdict != IntervalVerdict::InsideTheNoise);
            confidence = ratio.interval.confidence;
            assert!((ratio.interval.estimate - 1.0).abs() < 0.05, "{ratio:?}");
        }
    }
    let expected = f64::from(measurements) * (1.0 - confidence);
    for count in seen_apart {
        assert!(f64::from(count) < expected + 4.0 * expected.sqrt(), "{count} of {measurements} at confidence {confidence}");
    }
}

/// A setting with half the variance that takes 1.5 times as long is worth 4/3 of the other.
#[test]
fn less_noise_for_more_time_is_weighed() {
    let (observations, reference) = measure(pair(1.5, 0.2 * 0.5_f64.sqrt(), 9), None, &schedule(2));
    let comparison = compare_settings(&observations[1], &observations[0], &reference, Metric::Mse);
    assert_relative_eq!(comparison.error_at_equal_samples.interval.estimate, 0.5, max_relative = 0.03);
    assert_relative_eq!(comparison.efficiency.interval.estimate, 4.0 / 3.0, max_relative = 0.06);
    assert_relative_eq!(comparison.time_to_equal_error.unwrap().ratio.interval.estimate, 0.75, max_relative = 0.06);
    assert_eq!(comparison.efficiency.verdict, IntervalVerdict::More);
}

#[test]
fn curves_are_straight_on_logarithmic_axes() {
    let curve: Vec<(f64, f64)> = [1.0, 2.0, 4.0].map(|x: f64| (x, 8.0 / x)).to_vec();
    assert_relative_eq!(interpolate(&curve, 3.0).unwrap(), 8.0 / 3.0, epsilon = 1e-12);
    assert_relative_eq!(interpolate(&curve, 5.0).unwrap(), 8.0 / 5.0, epsilon = 1e-12);
    assert_eq!((interpolate(&curve, 9.0), interpolate(&curve, 0.4), interpolate(&[], 1.0)), (None, None, None));
}
