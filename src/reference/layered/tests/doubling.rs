//! Stacks against an oracle without chance: adding and doubling (van de Hulst 1980), averaged around the normal.
//!
//! Directions on either side of an interface are the nodes of a quadrature over cosines. What an interface or a slab does to light is a matrix for each
//! side: row i is seen along node i, column j is light from node j, times its weight. Two of them, one above the other, add up to one: light between them is reflected to and fro, which is a geometric
//! series of matrices. A slab is doubled from a sheet so thin that it scatters light once at most.

use std::f64::consts::PI;

use glam::DVec3;

use super::{Mean, Probe};
use crate::reference::bsdf::Density;
use crate::reference::layered::stack::Stack;
use crate::reference::phase::Scattering;
use crate::reference::tracking::Stream;
use crate::sampling::hash::mix;
use crate::spectrum::Spectrum;

const NODES: usize = 56;
const AROUND: usize = 96;
const DOUBLINGS: u32 = 18;

#[derive(Clone)]
struct Matrix(Vec<f64>);

impl Matrix {
    fn of(entry: impl Fn(usize, usize) -> f64) -> Self {
        Self((0..NODES * NODES).map(|place| entry(place / NODES, place % NODES)).collect())
    }

    fn unit() -> Self {
        Self::of(|row, column| f64::from(u8::from(row == column)))
    }

    fn at(&self, row: usize, column: usize) -> f64 {
        self.0[row * NODES + column]
    }

    fn plus(&self, other: &Self, factor: f64) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(one, other)| one + factor * other).collect())
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = vec![0.0; NODES * NODES];
        for row in 0..NODES {
            for middle in 0..NODES {
                let factor = self.at(row, middle);
                for column in 0..NODES {
                    product[row * NODES + column] += factor * other.at(middle, column);
                }
            }
        }
        Self(product)
    }

    /// The solution x of self · x = other.
    fn solve(&self, other: &Self) -> Self {
        let (mut left, mut right) = (self.clone(), other.clone());
        for pivot in 0..NODES {
            let best = (pivot..NODES).max_by(|&a, &b| left.at(a, pivot).abs().total_cmp(&left.at(b, pivot).abs())).expect("rows");
            for column in 0..NODES {
                left.0.swap(pivot * NODES + column, best * NODES + column);
                right.0.swap(pivot * NODES + column, best * NODES + column);
            }
            for row in 0..NODES {
                let factor = left.at(row, pivot) / left.at(pivot, pivot);
                if row != pivot && factor != 0.0 {
                    for column in 0..NODES {
                        left.0[row * NODES + column] -= factor * left.at(pivot, column);
                        right.0[row * NODES + column] -= factor * right.at(pivot, column);
                    }
                }
            }
        }
        Self::of(|row, column| right.at(row, column) / left.at(row, row))
    }
}

/// Reflection above, transmission down (seen from above), reflection below, transmission up (seen from below).
#[derive(Clone)]
struct Sheet {
    above: Matrix,
    down: Matrix,
    below: Matrix,
    up: Matrix,
}

impl Sheet {
    /// This sheet on another one.
    fn on(&self, other: &Self) -> Self {
        // Light that is between them and goes on up, as it is seen from above; and down, as it is seen from below.
        let rising = Matrix::unit().plus(&other.above.times(&self.below), -1.0);
        let falling = Matrix::unit().plus(&self.below.times(&other.above), -1.0);
        Self {
            above: self.above.plus(&self.down.times(&rising.solve(&other.above.times(&self.up))), 1.0),
            down: self.down.times(&rising.solve(&other.down)),
            below: other.below.plus(&other.up.times(&falling.solve(&self.below.times(&other.down))), 1.0),
            up: other.up.times(&falling.solve(&self.up)),
        }
    }
}

/// Nodes and weights of Gauss and Legendre's quadrature over [0, 1].
fn nodes() -> Vec<(f64, f64)> {
    let count = NODES as f64;
    (0..NODES)
        .map(|index| {
            let mut x = (PI * (index as f64 + 0.75) / (count + 0.5)).cos();
            let mut slope = 0.0;
            for _ in 0..60 {
                let (mut last, mut value) = (0.0, 1.0);
                for degree in 1..=NODES {
                    let degree = degree as f64;
                    (last, value) = (value, ((2.0 * degree - 1.0) * x * value - (degree - 1.0) * last) / degree);
                }
                slope = count * (x * value - last) / (x * x - 1.0);
                x -= value / slope;
            }
            (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

fn direction(cosine: f64, around: f64) -> DVec3 {
    let sine = (1.0 - cosine * cosine).sqrt();
    DVec3::new(sine * around.cos(), sine * around.sin(), cosine)
}

/// The mean around the normal of a function of two directions.
fn mean_around(of: &dyn Fn(DVec3, DVec3) -> f64, seen: f64, light: f64) -> f64 {
    let wo = direction(seen, 0.0);
    (0..AROUND).map(|step| of(wo, direction(light, PI * (step as f64 + 0.5) / AROUND as f64))).sum::<f64>() / AROUND as f64
}

fn sheet(of: &dyn Fn(DVec3, DVec3) -> f64, nodes: &[(f64, f64)]) -> Sheet {
    let matrix = |seen: f64, light: f64| {
        Matrix::of(|row, column| 2.0 * PI * nodes[column].1 * mean_around(of, seen * nodes[row].0, light * nodes[column].0))
    };
    Sheet { above: matrix(1.0, 1.0), down: matrix(1.0, -1.0), below: matrix(-1.0, -1.0), up: matrix(-1.0, 1.0) }
}

/// One channel of an interface of the stack.
fn interface(stack: &Stack<'_>, number: usize, channel: usize, nodes: &[(f64, f64)]) -> Sheet {
    sheet(&|wo, wi| stack.interface(number, wo, Spectrum::WHITE, 0.5).evaluate(wi).value.to_rgb()[channel], nodes)
}

/// One channel of the slab in a gap.
fn slab(stack: &Stack<'_>, gap: usize, channel: usize, nodes: &[(f64, f64)]) -> Sheet {
    let slab = stack.slab(gap).expect("it is filled");
    let thickness = slab.thickness / 2.0_f64.powi(DOUBLINGS as i32);
    let [scattering, extinction] = [slab.filling.scattering, slab.filling.extinction].map(|of| of.to_rgb()[channel]);
    let once = |wo: DVec3, wi: DVec3| {
        let phase = Scattering { phase: &slab.filling.phase, wo, is_dark: false }.evaluate(wi).pdf;
        scattering * phase * thickness / wo.z.abs()
    };
    let mut thin = sheet(&once, nodes);
    let straight = Matrix::of(|row, column| if row == column { (-extinction * thickness / nodes[row].0).exp() } else { 0.0 });
    thin.down = thin.down.plus(&straight, 1.0);
    thin.up = thin.up.plus(&straight, 1.0);
    (0..DOUBLINGS).fold(thin, |sheet, _| sheet.on(&sheet))
}

#[test]
fn rough_stacks_with_slabs_are_what_adding_and_doubling_say() {
    let nodes = nodes();
    let stacks = [
        ("interfaces = ['frost', 'red']\nslabs = [{ thickness = 0.4, medium = 'pigment' }]", 0),
        (
            "interfaces = ['frost', 'wide', 'red']\nslabs = [{ thickness = 0.3, medium = 'dye' }, { thickness = 0.5, medium = 'fog' }]",
            2,
        ),
        ("interfaces = ['frost', 'wide']\nslabs = [{ thickness = 0.6, medium = 'milk' }]", 1),
    ];
    for (keys, channel) in stacks {
        let probe = Probe::new(keys);
        let whole = probe.with(DVec3::Z, |stack| {
            (0..stack.count()).rev().fold(None, |below: Option<Sheet>, number| {
                let mut sheet = interface(stack, number, channel, &nodes);
                if let Some(below) = below {
                    sheet = sheet.on(&slab(stack, number + 1, channel, &nodes).on(&below));
                }
                Some(sheet)
            })
        });
        let whole = whole.expect("it has interfaces");
        for row in [NODES / 6, NODES / 2, NODES * 4 / 5] {
            let albedo: f64 = (0..NODES).map(|column| whole.above.at(row, column)).sum();
            let wo = direction(nodes[row].0, 0.0);
            let (mut mean, mut lobes) = (Mean::default(), [Mean::default(); 8]);
            probe.with(wo, |stack| {
                for index in 0..200_000 {
                    let mut stream = Stream::new(mix(index ^ 0x5a5a_0101));
                    let first = [stream.draw(), stream.draw(), stream.draw()];
                    let sample = stack.walk(wo, first, &mut stream).filter(|sample| sample.wi.z > 0.0);
                    let weight = sample.map_or(0.0, |sample| sample.weight.to_rgb()[channel]);
                    assert!(sample.is_none_or(|sample| sample.density != Density::Delta));
                    mean.add(Spectrum::grey(weight));
                    let bin = sample.map_or(0, |sample| ((sample.wi.z * 8.0) as usize).min(7));
                    lobes
                        .iter_mut()
                        .enumerate()
                        .for_each(|(place, lobe)| lobe.add(Spectrum::grey(if place == bin { weight } else { 0.0 })));
                }
            });
            let (found, error) = (mean.value().r(), mean.error().r());
            assert!((found - albedo).abs() < 1e-3 + 3.0 * error, "{keys}: {found} ± {error} and not {albedo}");
            assert!((found - 1.04 * albedo).abs() > 1e-3 + 3.0 * error, "an albedo that is 4 % larger is noticed");
            // The quadrature has several nodes in each bin; its weights are shared by bins that a node's interval overlaps.
            let mut chi_squared = 0.0;
            for (place, lobe) in lobes.iter().enumerate() {
                let mut expected = 0.0;
                let mut start = 1.0;
                for (column, (_, weight)) in nodes.iter().enumerate() {
                    let end = start - weight;
                    let [low, high] = [place as f64 / 8.0, (place + 1) as f64 / 8.0];
                    let overlap = (start.min(high) - end.max(low)).max(0.0) / weight;
                    expected += overlap * whole.above.at(row, column);
                    start = end;
                }
                chi_squared +=
                    (lobe.value().r() - expected).powi(2) / (lobe.error().r().powi(2) + (2e-3 * expected + 1e-4).powi(2));
            }
            assert!(chi_squared < 26.1, "{keys} at {}: χ² of 8 bins {chi_squared}", nodes[row].0); // 0.1 %
        }
    }
}
