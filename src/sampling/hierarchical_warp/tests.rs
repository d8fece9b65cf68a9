use super::*;
use crate::statistics::chi_squared_test;
use crate::statistics::random::SplitMix64;

fn warp(width: u32, height: u32, weights: &[f64]) -> HierarchicalWarp {
    HierarchicalWarp::new(width, height, weights).expect("some weight is positive")
}

/// Largest difference between a cell's share and its weight's, relative to the weight's.
fn deviation(warp: &HierarchicalWarp, weights: &[f64]) -> f64 {
    let (total, cells) = (weights.iter().sum::<f64>(), weights.len() as f64);
    let apart =
        |(density, weight): (&f64, &f64)| if *weight > 0.0 { (density / cells * total / weight - 1.0).abs() } else { *density };
    warp.densities.iter().zip(weights).map(apart).fold(0.0, f64::max)
}

/// Checks what holds for any weights.
fn check(width: u32, height: u32, weights: &[f64]) -> HierarchicalWarp {
    let warp = warp(width, height, weights);
    assert_eq!(warp.densities.len(), weights.len());
    for (density, weight) in warp.densities.iter().zip(weights) {
        assert!(density.is_finite() && (*density > 0.0) == (*weight > 0.0), "{density} for {weight}");
    }
    let integral = warp.densities.iter().sum::<f64>() / weights.len() as f64;
    assert!((integral - 1.0).abs() < 1e-10, "{integral}");
    let everywhere = (0..=u32::MAX).step_by(9_999_991).map(|bits| [bits, bits.wrapping_mul(0x9e37_79b9)]);
    let corners = [[0, 0], [0, u32::MAX], [u32::MAX, 0], [u32::MAX; 2]];
    for [bits_u, bits_v] in everywhere.chain(corners) {
        let point = warp.sample(bits_u, bits_v);
        assert_eq!(point.density, warp.density(point.u, point.v), "{point:?}");
        assert!(point.density > 0.0 && (0.0..1.0).contains(&point.u) && (0.0..1.0).contains(&point.v), "{point:?}");
    }
    warp
}

fn noise(width: u32, height: u32) -> Vec<f64> {
    (0..width * height).map(|i| f64::from(i * 7919 % 1000)).collect()
}

#[test]
fn shares_are_those_of_the_weights_at_any_resolution() {
    let cases: [(u32, u32, Vec<f64>); 9] = [
        (1, 1, vec![3.0]),
        (2, 1, vec![1.0, 2.0]),
        (1, 2, vec![0.0, 2.0]),
        (1, 3, vec![0.0, 2.0, 0.0]),
        (5, 3, (1..16).map(f64::from).collect()),
        (3, 5, (1..16).map(|i| f64::from(i * i)).collect()),
        (40, 30, noise(40, 30)),
        (129, 64, noise(129, 64)),
        (8, 8, (0..64).map(|i| if i == 37 { 1e-300 } else { 0.0 }).collect()),
    ];
    for (width, height, weights) in cases {
        let apart = deviation(&check(width, height, &weights), &weights);
        assert!(apart < 1e-4, "{width} x {height}: {apart}");
        // Negative control: they are not the shares of other weights.
        let mut others = weights.clone();
        if let Some(weight) = others.iter_mut().rev().find(|weight| **weight > 0.0)
            && weights.iter().filter(|weight| **weight > 0.0).count() > 1
        {
            *weight *= 1.001;
            assert!(deviation(&warp(width, height, &weights), &others) > 1e-4, "{width} x {height}");
        }
    }
    assert_eq!(HierarchicalWarp::new(2, 2, &[0.0; 4]), None);
}

/// Whatever has a weight has points, and no division is by 0.
#[test]
fn extreme_contrasts_leave_every_cell_its_points() {
    for (width, height) in [(2, 2), (5, 3), (64, 33), (1024, 512)] {
        for contrast in [1e6, 1e12, 1e300] {
            for bright in [0, width * height / 2 + 1, width * height - 1] {
                let weights: Vec<f64> = (0..width * height).map(|i| if i == bright { contrast } else { 1.0 }).collect();
                let warp = check(width, height, &weights);
                let cells = f64::from(width) * f64::from(height);
                // The other rows and columns get, at the least, no more than 2⁻³¹ of the square for each of
                // theirs.
                let expected = contrast / (contrast + cells - 1.0);
                let found = warp.densities[bright as usize] / cells;
                assert!((found / expected - 1.0).abs() < 2e-6, "{width} x {height}, {contrast:e}: {found} of {expected}");
            }
        }
    }
}

/// How often cells are drawn, beside weights that may be others than the warp's.
fn test_frequencies(warp: &HierarchicalWarp, weights: &[f64]) -> f64 {
    let samples = 200_000;
    let mut random = SplitMix64::new(7);
    let mut observed = vec![0; weights.len()];
    for _ in 0..samples {
        let bits = random.next_u64();
        let point = warp.sample(bits as u32, (bits >> 32) as u32);
        let cell = |x: f64, count: u32| (x * f64::from(count)) as usize;
        observed[cell(point.v, warp.height) * warp.width as usize + cell(point.u, warp.width)] += 1;
    }
    let total: f64 = weights.iter().sum();
    let expected: Vec<f64> = weights.iter().map(|weight| weight / total * f64::from(samples)).collect();
    chi_squared_test(&observed, &expected).p_value
}

#[test]
fn frequencies_follow_the_weights() {
    for (width, height, weights) in
        [(3, 2, vec![1.0, 0.0, 5.0, 0.25, 0.0, 3.75]), (5, 3, (1..16).map(f64::from).collect()), (20, 9, noise(20, 9))]
    {
        let warp = warp(width, height, &weights);
        assert!(test_frequencies(&warp, &weights) > 1e-3, "{width} x {height}");
        let wrong: Vec<f64> =
            weights.iter().enumerate().map(|(i, weight)| weight * if i % 2 == 0 { 1.0 } else { 1.05 }).collect();
        assert!(test_frequencies(&warp, &wrong) < 1e-3, "{width} x {height}, wrong weights");
    }
}

/// Points of the primary square that go to one node at some level fill a rectangle: strata stay together, which is what the warp is for.
#[test]
fn a_node_of_any_level_has_a_rectangle_for_its_own() {
    let warp = warp(16, 8, &noise(16, 8));
    for level in 0..=warp.levels() {
        let [columns, rows] = level_size(16, 8, level);
        let nodes = (columns * rows) as usize;
        let (mut bounds, mut counts) = (vec![[u32::MAX, 0, u32::MAX, 0]; nodes], vec![0_u32; nodes]);
        let lattice = 256;
        for (x, y) in (0..lattice).flat_map(|y| (0..lattice).map(move |x| (x, y))) {
            let point = warp.sample(x << 24, y << 24);
            let node = ((point.v * 8.0) as u32 >> level) * columns + ((point.u * 16.0) as u32 >> level);
            let bound = &mut bounds[node as usize];
            *bound = [bound[0].min(x), bound[1].max(x), bound[2].min(y), bound[3].max(y)];
            counts[node as usize] += 1;
        }
        for (bound, count) in bounds.into_iter().zip(counts).filter(|(_, count)| *count > 0) {
            assert_eq!((bound[1] - bound[0] + 1) * (bound[3] - bound[2] + 1), count, "level {level}: {bound:?}");
        }
    }
}
