//! The structure of sample sequences: evenness of every prefix, independence of pixels, samples and dimensions. No device is needed.

use std::collections::BTreeMap;

use crate::statistics::chi_squared_test;
use crate::statistics::random::SplitMix64;
use gpt::compare::{Moments, sidak};
use gpt::sampling::halton::{BASES, radical_inverse_bits};
use gpt::sampling::sobol::sobol_bits;
use gpt::sampling::{CameraDimension, Dimension, PathSampler, Sampling, SequencePoint, VertexDimension};
use gpt::scene::{PixelSampler, SamplerKind};

/// Named pairs that a path uses as one point of a square: in the pixel, on the lens, on a light, a direction; the last two at the
/// first and at the fourth vertex.
const PAIRS: [[Dimension; 2]; 6] = [
    [Dimension::camera(CameraDimension::PixelX), Dimension::camera(CameraDimension::PixelY)],
    [Dimension::camera(CameraDimension::LensU), Dimension::camera(CameraDimension::LensV)],
    [Dimension::vertex(0, VertexDimension::LightU), Dimension::vertex(0, VertexDimension::LightV)],
    [Dimension::vertex(0, VertexDimension::BsdfU), Dimension::vertex(0, VertexDimension::BsdfV)],
    [Dimension::vertex(3, VertexDimension::LightU), Dimension::vertex(3, VertexDimension::LightV)],
    [Dimension::vertex(3, VertexDimension::BsdfU), Dimension::vertex(3, VertexDimension::BsdfV)],
];

fn sampling(path: SamplerKind, samples: u32, seed: u32) -> Sampling {
    Sampling { path, pixel: PixelSampler::SameAsPath, seed, samples, light_samples: 1, light_samples_depth: 1 }
}

/// The numbers that the first `count` paths of a pixel draw for some dimensions.
fn draws<const N: usize>(sampling: &Sampling, pixel: u32, count: u32, dimensions: [Dimension; N]) -> Vec<[f64; N]> {
    let draw = |sample| {
        let point = SequencePoint::new(sampling, sample);
        let sampler = PathSampler::new(sampling, pixel, &point);
        dimensions.map(|dimension| sampler.uniform(dimension))
    };
    (0..count).map(draw).collect()
}

/// Most points in any of the elementary intervals of `parts[0]` × `parts[1]` cells.
fn fullest_cell(points: &[[f64; 2]], parts: [u32; 2]) -> u32 {
    let mut counts: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for point in points {
        *counts.entry([0, 1].map(|axis| (point[axis] * f64::from(parts[axis])) as u32)).or_default() += 1;
    }
    counts.into_values().max().unwrap_or(0)
}

/// Every aligned run of 2ᵏ points of a (0, 2)-sequence has one point in each elementary interval of area 2⁻ᵏ, whatever its shape.
/// The pixel's digital shift keeps that; the pair of second-best dimensions, which the lens has, is within a factor of 2³.
#[test]
fn sobol_fills_elementary_intervals() {
    let sobol = sampling(SamplerKind::Sobol, 1, 77);
    for (index, pair) in PAIRS.into_iter().enumerate() {
        let most = if index == 1 { 8 } else { 1 };
        for pixel in [0, 4711] {
            let points = draws(&sobol, pixel, 1024, pair);
            for k in 0..=9_u32 {
                for run in points.chunks_exact(1 << k) {
                    let fullest = (0..=k).map(|i| fullest_cell(run, [1 << i, 1 << (k - i)])).max();
                    assert!(fullest <= Some(most), "{pair:?}, {} points: {fullest:?} in one interval", run.len());
                }
            }
        }
    }
}

/// Halton's pixel dimensions fill elementary intervals too: runs of 2ᵏ 3ᵐ points, in the sequence that all
/// pixels share.
#[test]
fn halton_fills_elementary_intervals() {
    let point = |index| [0, 1].map(|d| (f64::from(radical_inverse_bits(5, d, index)) + 0.5) / 4_294_967_296.0);
    for (k, m) in [(0, 1), (1, 1), (3, 1), (2, 2), (4, 2), (1, 4), (5, 3)] {
        let (x, y) = (2_u32.pow(k), 3_u32.pow(m));
        for first in [0, x * y, 7 * x * y] {
            let points: Vec<[f64; 2]> = (first..first + x * y).map(point).collect();
            assert_eq!(fullest_cell(&points, [x, y]), 1, "2^{k} 3^{m} from {first}");
        }
    }
    assert_eq!(BASES[..2], [2, 3]);
}

/// Random points fail the tests above.
#[test]
fn random_points_do_not_fill_elementary_intervals() {
    let independent = sampling(SamplerKind::Independent, 1, 77);
    assert!(fullest_cell(&draws(&independent, 0, 256, PAIRS[0]), [16, 16]) > 3);
}

/// Star discrepancy of points in the unit square: the largest difference between the share of points in a box [0, x) × [0, y) and
/// its area, open and closed boxes, over all boxes that points can bound (Niederreiter 1972).
fn star_discrepancy(points: &[[f64; 2]]) -> f64 {
    let count = points.len() as f64;
    let mut by_x = points.to_vec();
    by_x.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut heights: Vec<f64> = Vec::new();
    let mut worst: f64 = 0.0;
    for index in 0..=by_x.len() {
        // Boxes that end between this point and the one before hold the points so far.
        let (left, right) = (if index == 0 { 0.0 } else { by_x[index - 1][0] }, by_x.get(index).map_or(1.0, |point| point[0]));
        for inside in 0..=heights.len() {
            let below = if inside == 0 { 0.0 } else { heights[inside - 1] };
            let above = heights.get(inside).copied().unwrap_or(1.0);
            let share = inside as f64 / count;
            worst = worst.max(share - left * below).max(right * above - share);
        }
        if let Some(point) = by_x.get(index) {
            heights.insert(heights.partition_point(|&height| height < point[1]), point[1]);
        }
    }
    worst
}

#[test]
fn star_discrepancy_in_closed_form() {
    assert!((star_discrepancy(&[[0.5, 0.5]]) - 0.75).abs() < 1e-12);
    assert!((star_discrepancy(&[[1.0, 1.0]]) - 1.0).abs() < 1e-12);
    // Boxes as thin as one likes hold both points.
    assert!((star_discrepancy(&[[0.25, 0.0], [0.75, 0.0]]) - 1.0).abs() < 1e-12);
    // The largest box that reaches up to both and holds none is ¾ × ¾; with both in it, 1 − ¾² is less.
    assert!((star_discrepancy(&[[0.25, 0.75], [0.75, 0.25]]) - 9.0 / 16.0).abs() < 1e-12);
}

/// Every prefix of a low-discrepancy sequence is far evener than random points, in every pair that a path uses; of strata, every whole
/// set. The bounds are ratios to random points, averaged over lengths and seeds.
#[test]
#[ignore = "slow"]
fn prefixes_are_evener_than_random_points() {
    let counts = [16, 50, 100, 256, 777];
    let ratio = |sampler, pair| {
        let mean = |kind, count, pair| {
            let over_seeds = (0..6).map(|seed| star_discrepancy(&draws(&sampling(kind, count, seed), 99, count, pair)));
            over_seeds.sum::<f64>() / 6.0
        };
        let ratios = counts.map(|count| mean(sampler, count, pair) / mean(SamplerKind::Independent, count, PAIRS[0]));
        ratios.iter().sum::<f64>() / ratios.len() as f64
    };
    for (index, pair) in PAIRS.into_iter().enumerate() {
        for (sampler, pairs, bound) in [
            // Halton's later bases are too large to be even after so few samples.
            (SamplerKind::Halton, 1, 0.5),
            (SamplerKind::Sobol, 6, 0.5),
            (SamplerKind::Hammersley, 1, 0.45),
            (SamplerKind::Stratified, 6, 0.7),
            (SamplerKind::Quadrant, 6, 0.8),
        ] {
            let found = ratio(sampler, pair);
            println!("{sampler:?}, {pair:?}: {found:.3}");
            assert!(index >= pairs || found < bound, "{sampler:?}, {pair:?}: {found}");
        }
        let random = ratio(SamplerKind::Independent, pair);
        assert!((0.8..1.25).contains(&random), "random points, {pair:?}: {random}");
    }
}

/// A number depends on nothing but pixel, sample and dimension: not on what was drawn before, nor in which order.
#[test]
fn order_does_not_matter() {
    for kind in SamplerKind::ALL {
        let settings = sampling(kind, 64, 3);
        let mut wanted: Vec<(u32, u32, u32)> = (0..3000_u32).map(|i| (i % 7 * 1000, i % 64, i * 31 % 70)).collect();
        let draw = |(pixel, sample, dimension): (u32, u32, u32)| {
            let point = SequencePoint::new(&settings, sample);
            PathSampler::new(&settings, pixel, &point).bits(Dimension(dimension))
        };
        let forward: BTreeMap<_, _> = wanted.iter().map(|&key| (key, draw(key))).collect();
        wanted.reverse();
        assert!(wanted.into_iter().all(|key| forward[&key] == draw(key)), "{kind:?}");
    }
}

/// p of Pearson's test that pairs of numbers fill an 8 × 8 grid evenly, as independent uniform numbers do.
fn independence(pairs: impl Iterator<Item = [f64; 2]>) -> f64 {
    let mut counts = [0; 64];
    for [x, y] in pairs {
        counts[(y * 8.0) as usize * 8 + (x * 8.0) as usize] += 1;
    }
    let expected = counts.iter().sum::<u64>() as f64 / 64.0;
    chi_squared_test(&counts, &[expected; 64]).p_value
}

const WIDTH: u32 = 512;

/// The number that a sampler gives a pixel for one dimension at one sample.
fn number(settings: &Sampling, point: &SequencePoint, pixel: u32, dimension: u32) -> f64 {
    PathSampler::new(settings, pixel, point).uniform(Dimension(dimension))
}

/// The test compares one sample of neighbouring pixels, to the right and below, and two dimensions of one
/// pixel, over many pixels.
#[test]
fn neighbouring_pixels_and_dimensions_are_independent() {
    let pixels = 0..40_000_u32;
    let dimensions = [0, 1, 2, 3, 4, 9, 12, 13, 14, 39, 40, 55];
    let mut results = Vec::new();
    for kind in SamplerKind::ALL {
        let settings = sampling(kind, 64, 1);
        let point = SequencePoint::new(&settings, 13);
        for (index, &d) in dimensions.iter().enumerate() {
            for distance in [1, WIDTH] {
                let pairs = pixels.clone().map(|pixel| [pixel, pixel + distance].map(|p| number(&settings, &point, p, d)));
                results.push((format!("{kind:?}, dimension {d}, pixels {distance} apart"), independence(pairs)));
            }
            let other = dimensions[(index + 1) % dimensions.len()];
            let pairs = pixels.clone().map(|pixel| [d, other].map(|d| number(&settings, &point, pixel, d)));
            results.push((format!("{kind:?}, dimensions {d} and {other}"), independence(pairs)));
        }
    }
    let level = sidak(0.01, results.len());
    let rejected: Vec<_> = results.iter().filter(|(_, p)| *p < level).collect();
    assert!(rejected.is_empty(), "{rejected:?}");
}

/// The test fails on pixels whose keys are neighbours themselves, and on a sequence that nothing
/// decorrelates.
#[test]
fn correlations_are_noticed() {
    let settings = sampling(SamplerKind::Halton, 64, 1);
    let point = SequencePoint::new(&settings, 13);
    let copied = (0..40_000).map(|pixel| [0, 0].map(|_| number(&settings, &point, pixel, 0)));
    assert!(independence(copied) < 1e-6);
    let mut random = SplitMix64::new(2);
    let slightly = (0..40_000).map(|_| {
        let [x, y] = [random.uniform(), random.uniform()];
        if random.uniform() < 0.05 { [x, x] } else { [x, y] }
    });
    assert!(independence(slightly) < 1e-6);
}

/// Pairs of dimensions over the samples of one pixel: no grid cell is empty or crowded, as with dimensions that run in step.
#[test]
#[ignore = "slow"]
fn samples_of_a_pixel_do_not_run_in_step() {
    let count = 1024;
    // The first dimensions; later ones of Halton need more samples.
    for kind in [SamplerKind::Sobol, SamplerKind::Stratified, SamplerKind::Quadrant, SamplerKind::Halton, SamplerKind::Hammersley]
    {
        let dimensions: Vec<u32> = (0..5).chain(8..16).collect();
        for (index, &a) in dimensions.iter().enumerate() {
            for &b in &dimensions[index + 1..] {
                let points = draws(&sampling(kind, count, 21), 5, count, [Dimension(a), Dimension(b)]);
                let fullest = fullest_cell(&points, [8, 8]);
                // 16 are expected; random points stay below 36 in all but one of 10⁴ cases.
                assert!(fullest < 40, "{kind:?}, dimensions {a} and {b}: {fullest} of {count} points in one of 64 cells");
            }
        }
    }
    let in_step: Vec<[f64; 2]> = draws(&sampling(SamplerKind::Halton, count, 21), 5, count, [Dimension(0), Dimension(0)]);
    assert!(fullest_cell(&in_step, [8, 8]) > 100);
}

/// Honsdorf's figure 43: ∫ x³ over [0, 1] is ¼, drawn with density 1 and with density 2x, at 25, 100, 400 and 1000 samples.
#[test]
#[ignore = "slow"]
fn the_integral_of_x_cubed() {
    // By uniform x and by x = √u, with the same numbers.
    let estimates = |kind, count, seed| {
        // A dimension that is stratified alone; or that of the smallest base.
        let alone = matches!(kind, SamplerKind::Stratified | SamplerKind::Quadrant);
        let dimension = if alone { CameraDimension::Time } else { CameraDimension::PixelX };
        let numbers = draws(&sampling(kind, count, seed), 7, count, [Dimension::camera(dimension)]);
        [|u: f64| u.powi(3), |u: f64| u / 2.0]
            .map(|term: fn(f64) -> f64| numbers.iter().map(|[u]| term(*u)).sum::<f64>() / f64::from(count))
    };
    for count in [25, 100, 400, 1000] {
        let deviations = |kind| -> [Moments; 2] {
            let found: Vec<[f64; 2]> = (0..64).map(|seed| estimates(kind, count, seed)).collect();
            [0, 1].map(|way: usize| found.iter().map(|estimates| estimates[way]).collect())
        };
        // 1/7 − 1/16; x³ / 2x = u / 2, of variance 1/48.
        let standard_errors = [1.0 / 7.0 - 1.0 / 16.0, 1.0 / 48.0_f64].map(|variance: f64| (variance / f64::from(count)).sqrt());
        for (random, standard_error) in deviations(SamplerKind::Independent).iter().zip(standard_errors) {
            assert!((random.mean() - 0.25).abs() < 4.0 * standard_error / 8.0, "{count}: {}", random.mean());
            // 63 degrees of freedom: a standard deviation is within 35 % of its estimate in all but 1 of 10⁴ cases.
            assert!((random.variance().sqrt() / standard_error - 1.0).abs() < 0.35, "{count}: {}", random.variance().sqrt());
        }
        // Strata that are shared are those of directions alone.
        let random = [SamplerKind::Independent, SamplerKind::Congruential, SamplerKind::SharedStrata];
        for kind in SamplerKind::ALL.into_iter().filter(|kind| !random.contains(kind)) {
            for (even, standard_error) in deviations(kind).iter().zip(standard_errors) {
                assert!((even.mean() - 0.25).abs() < 4.0 * standard_error / 8.0, "{kind:?}, {count}: {}", even.mean());
                assert!(even.variance().sqrt() < 0.5 * standard_error, "{kind:?}, {count}: {}", even.variance().sqrt());
            }
        }
    }
}

/// Sobol' points in their own order, before the pixel moves them, are what `sobol_bits` says: the device and the tests see the same.
#[test]
fn the_shared_point_is_the_sequence() {
    let settings = sampling(SamplerKind::Sobol, 1, 9);
    let point = SequencePoint::new(&settings, 1234);
    assert!((0..40).all(|d| point.bits[d as usize] == sobol_bits(9, d, 1234)));
}

/// The light samples of a pixel at a surface that takes several are one sequence: those of four samples with four each are as even as of sixteen with
/// one each, and no two pixels or samples share them.
#[test]
fn light_samples_of_a_pixel_are_one_sequence() {
    use SamplerKind::{Independent, Sobol, Stratified};
    // The pixel moves strata by a rotation, which may put points into a cell that is not theirs: at most four cells overlap one.
    for (kind, most) in [(Sobol, 1), (Stratified, 4), (Independent, 64)] {
        let mut several = sampling(kind, 16, 77);
        (several.light_samples, several.light_samples_depth) = (4, 2);
        let light_points = |pixel, vertex| -> Vec<[f64; 2]> {
            let point_of = |sample, number| {
                let point = SequencePoint::new(&several, sample);
                let [_, u, v] = PathSampler::new(&several, pixel, &point).light_bits(vertex, vertex + 1, number);
                [u, v].map(gpt::sampling::sampler::uniform)
            };
            (0..16).flat_map(|sample| (0..4).map(move |number| (sample, number))).map(|(s, n)| point_of(s, n)).collect()
        };
        let [points, later] = [0, 1].map(|vertex| light_points(4711, vertex));
        assert_eq!([points.len(), later.len()], [64; 2]);
        let shapes: &[[u32; 2]] = if kind == Sobol { &[[64, 1], [16, 4], [8, 8], [2, 32]] } else { &[[8, 8]] };
        for &parts in shapes {
            for points in [&points, &later] {
                let fullest = fullest_cell(points, parts);
                // Independent points are the control: they are not even.
                assert!(fullest <= most && (kind != Independent || fullest > 1), "{kind:?}, {parts:?}: {fullest}");
            }
        }
        let distinct: std::collections::BTreeSet<[u64; 2]> =
            points.iter().chain(&later).chain(&light_points(4712, 0)).map(|point| point.map(f64::to_bits)).collect();
        assert_eq!(distinct.len(), 192);
    }
}
