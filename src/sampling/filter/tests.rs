//! The maps against the filters' formulas.

use super::*;
use crate::compare::sidak;
use crate::statistics::{chi_squared_test, random::SplitMix64};

const KINDS: [FilterKind; 4] = [FilterKind::Box, FilterKind::Tent, FilterKind::Gaussian, FilterKind::BlackmanHarris];
const BINS: usize = 64;
const DRAWS: usize = 1_000_000;

/// ∫ f over each of the bins of [−1, 1].
fn masses(f: impl Fn(f64) -> f64) -> [f64; BINS] {
    let (width, steps) = (2.0 / BINS as f64, 64);
    std::array::from_fn(|bin| {
        let at = |step: i32| f(-1.0 + (bin as f64 + (f64::from(step) + 0.5) / f64::from(steps)) * width);
        (0..steps).map(at).sum::<f64>()
    })
}

/// p of Pearson's test of samples of `map` against the density `f`, both over [−1, 1].
fn p_value(map: impl Fn(f64) -> f64, f: impl Fn(f64) -> f64, seed: u64) -> f64 {
    let mut random = SplitMix64::new(seed);
    let mut counts = [0; BINS];
    for _ in 0..DRAWS {
        let x = map(random.uniform());
        counts[(((x + 1.0) / 2.0 * BINS as f64) as usize).min(BINS - 1)] += 1;
    }
    let masses = masses(f);
    let whole: f64 = masses.iter().sum();
    chi_squared_test(&counts, &masses.map(|mass| mass / whole * DRAWS as f64)).p_value
}

#[test]
fn samples_are_distributed_as_the_filter() {
    for (seed, kind) in KINDS.into_iter().enumerate() {
        let radius = 1.7;
        let sampler = FilterSampler::new(Filter { kind, radius });
        let p = p_value(|u| sampler.offset(u) / radius, |x| height(kind, x), seed as u64);
        assert!(p > sidak(0.01, KINDS.len()), "{kind:?}: p = {p}");
    }
}

/// Each filter's samples, tested against every other filter; and a gaussian 1 % too narrow.
#[test]
fn another_filter_is_noticed() {
    for kind in KINDS {
        let sampler = FilterSampler::new(Filter { kind, radius: 1.0 });
        for other in KINDS.into_iter().filter(|other| *other != kind) {
            assert!(p_value(|u| sampler.offset(u), |x| height(other, x), 9) < 1e-6, "{kind:?} passes for {other:?}");
        }
    }
    let sampler = FilterSampler::new(Filter { kind: FilterKind::Gaussian, radius: 0.99 });
    assert!(p_value(|u| sampler.offset(u), |x| height(FilterKind::Gaussian, x), 9) < 1e-6);
}

/// Means and variances of evenly spread numbers against the filters' own, to 10⁻⁴ of the squared radius.
#[test]
fn moments_are_the_filters() {
    for kind in KINDS {
        let sampler = FilterSampler::new(Filter { kind, radius: 1.0 });
        let count = 1 << 16;
        let offsets = (0..count).map(|i| sampler.offset((f64::from(i) + 0.5) / f64::from(count)));
        let (sum, squares) = offsets.fold((0.0, 0.0), |(sum, squares), x| (sum + x, squares + x * x));
        let masses = |power: i32| masses(|x| x.powi(power) * height(kind, x)).iter().sum::<f64>();
        let variance = masses(2) / masses(0);
        assert!((sum / f64::from(count)).abs() < 1e-9, "{kind:?}");
        assert!((squares / f64::from(count) - variance).abs() < 1e-4, "{kind:?}: {} {variance}", squares / f64::from(count));
    }
    // A tent of radius 1 has 1/6, a box 1/3.
    let variance =
        |kind| masses(|x| x * x * height(kind, x)).iter().sum::<f64>() / masses(|x| height(kind, x)).iter().sum::<f64>();
    assert!((variance(FilterKind::Tent) - 1.0 / 6.0).abs() < 1e-4 && (variance(FilterKind::Box) - 1.0 / 3.0).abs() < 1e-4);
}

#[test]
fn maps_are_odd_and_rise_from_one_end_to_the_other() {
    for kind in KINDS {
        let sampler = FilterSampler::new(Filter { kind, radius: 2.5 });
        assert_eq!(sampler.offset(0.5), 0.0, "{kind:?}");
        assert!((sampler.offset(0.0) + 2.5).abs() < 1e-6, "{kind:?}");
        let count = 1 << 14;
        let mut last = f64::NEG_INFINITY;
        for i in 0..count {
            let u = f64::from(i) / f64::from(count);
            let x = sampler.offset(u);
            assert!(x >= last && x.abs() < 2.5 + 1e-6, "{kind:?} at {u}: {x} after {last}");
            assert!(i == 0 || (sampler.offset(1.0 - u) + x).abs() < 1e-12, "{kind:?} at {u}");
            last = x;
        }
    }
}
