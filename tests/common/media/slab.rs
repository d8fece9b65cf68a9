//! A plane layer that scatters light any number of times, by adding and doubling (van de Hulst 1963; Prahl 1995), one Fourier mode of the azimuth at a
//! time, between smooth boundaries of a dielectric or none.
//!
//! Radiances are vectors over the nodes of a quadrature of the cosine within the layer. What a layer does to them is four matrices, so what follows is
//! algebra. Outside, a node stands for the refracted direction, if there is one.

use std::f64::consts::TAU;

use super::fresnel;
use super::matrix::Matrix;
use super::phase::Phase;
use super::quadrature::gauss_legendre;

/// The weight of nodes that are there to be looked at alone. Their columns scale with it and divide it out again.
const NO_WEIGHT: f64 = 1e-30;
/// The first layer is at most this thick. Padé's approximation of order 6 leaves its error below what doubling makes of rounding.
const FIRST: f64 = 1e-3;
/// A half space that absorbs is a layer of this thickness, or of one that lets less than [`NOTHING`] through.
const DEEP: f64 = 1e6;
const NOTHING: f64 = 1e-17;

/// A layer: the scattering within it, its optical thickness (infinite for a half space that absorbs), and its index of refraction over that outside.
#[derive(Debug, Clone)]
pub struct Layer {
    pub albedo: f64,
    pub thickness: f64,
    pub phase: Phase,
    pub index: f64,
}

/// Directions: cosines within the layer, weights of the quadrature over (0, 1), and cosines outside.
#[derive(Debug, Clone)]
pub struct Nodes {
    inside: Vec<f64>,
    weights: Vec<f64>,
    outside: Vec<Option<f64>>,
    index: f64,
    /// Polynomials of a lower degree are integrated exactly.
    degrees: usize,
}

impl Nodes {
    /// A quadrature of `count` nodes, and those nodes besides whose directions outside have these cosines.
    pub fn new(count: usize, index: f64, looked_at: &[f64]) -> Self {
        let (rule, degrees) = if index > 1.0 {
            // Beyond the critical angle reflection is total; up to it, it falls like a square root, which squares of nodes make smooth. A polynomial
            // of the cosine has twice its degree and one more there.
            let critical = (1.0 - 1.0 / (index * index)).sqrt();
            let total = count / 3;
            let squared = |(x, weight): (f64, f64)| (critical + (1.0 - critical) * x * x, (1.0 - critical) * 2.0 * x * weight);
            let partial = gauss_legendre(count - total, 0.0, 1.0).into_iter().map(squared);
            (gauss_legendre(total, 0.0, critical).into_iter().chain(partial).collect(), (2 * total).min(count - total))
        } else {
            (gauss_legendre(count, 0.0, 1.0), 2 * count)
        };
        let beside = looked_at.iter().map(|&cosine| (fresnel::refracted(cosine, index).expect("light enters"), NO_WEIGHT));
        let (inside, weights): (Vec<f64>, Vec<f64>) = rule.into_iter().chain(beside).unzip();
        let outside = inside.iter().map(|&cosine| fresnel::refracted(cosine, 1.0 / index)).collect();
        Self { inside, weights, outside, index, degrees }
    }

    fn len(&self) -> usize {
        self.inside.len()
    }

    /// The node that was asked for with this cosine outside.
    fn find(&self, cosine: f64) -> usize {
        let off = |node: &usize| self.outside[*node].map_or(f64::INFINITY, |outside| (outside - cosine).abs());
        let looked_at = (0..self.len()).filter(|&node| self.weights[node] == NO_WEIGHT);
        let found = looked_at.min_by(|a, b| off(a).total_cmp(&off(b))).expect("nodes to look at were asked for");
        assert!(off(&found) < 1e-9, "no node was asked for at cosine {cosine}");
        found
    }

    /// The weight for an integral over the cosine outside; µ dµ outside is n² µ dµ within.
    fn weight_outside(&self, node: usize) -> f64 {
        let squared = self.index * self.index;
        self.outside[node].map_or(0.0, |outside| squared * self.inside[node] * self.weights[node] / outside)
    }
}

/// The effect of a layer on radiances: reflection above and below, transmission downward and upward.
#[derive(Debug, Clone)]
struct Operators {
    above: Matrix,
    below: Matrix,
    down: Matrix,
    up: Matrix,
}

impl Operators {
    /// This layer upon another one.
    fn upon(&self, lower: &Self) -> Self {
        let one = Matrix::identity(self.above.size);
        // Light between the two, downward and upward, by what comes from above and from below.
        let downward = one.plus(-1.0, &self.below.times(&lower.above));
        let upward = one.plus(-1.0, &lower.above.times(&self.below));
        let downward_from_above = downward.solve(&self.down);
        let upward_from_below = upward.solve(&lower.up);
        Self {
            down: lower.down.times(&downward_from_above),
            above: self.above.plus(1.0, &self.up.times(&lower.above.times(&downward_from_above))),
            up: self.up.times(&upward_from_below),
            below: lower.below.plus(1.0, &lower.down.times(&self.below.times(&upward_from_below))),
        }
    }

    /// The smooth boundary above the layer, with the outside above it.
    fn boundary(nodes: &Nodes) -> Self {
        let reflectance: Vec<f64> = nodes.inside.iter().map(|&cosine| fresnel::reflectance(cosine, 1.0 / nodes.index)).collect();
        let outside = |value: &dyn Fn(f64) -> f64| {
            let values = reflectance.iter().zip(&nodes.outside).map(|(&part, outside)| outside.map_or(0.0, |_| value(part)));
            Matrix::diagonal(&values.collect::<Vec<_>>())
        };
        // Radiance grows by the square of the index where it enters.
        let squared = nodes.index * nodes.index;
        Self {
            above: outside(&|part| part),
            below: Matrix::diagonal(&reflectance),
            down: outside(&|part| (1.0 - part) * squared),
            up: outside(&|part| (1.0 - part) / squared),
        }
    }

    fn upside_down(self) -> Self {
        Self { above: self.below, below: self.above, down: self.up, up: self.down }
    }
}

/// Legendre functions of degrees `mode` … and of order `mode`, normalised so that phase functions are sums of (2 l + 1) times moments times products
/// of two of them.
fn legendre(mode: usize, degrees: usize, cosine: f64) -> Vec<f64> {
    let order = mode as f64;
    let sine = (1.0 - cosine * cosine).sqrt();
    let first = (1..=mode).fold(1.0, |product, k| product * sine * ((2 * k - 1) as f64 / (2 * k) as f64).sqrt());
    let mut values = vec![first];
    let mut before = 0.0;
    for degree in mode + 1..degrees {
        let (l, last) = (degree as f64, values[values.len() - 1]);
        let scale = (l * l - order * order).sqrt();
        let lower = ((l - 1.0) * (l - 1.0) - order * order).max(0.0).sqrt();
        values.push(((2.0 * l - 1.0) * cosine * last - lower * before) / scale);
        before = last;
    }
    values
}

/// Light in a layer: solved for one Fourier mode of the azimuth.
#[derive(Debug, Clone)]
struct Mode {
    operators: Operators,
}

impl Mode {
    fn new(layer: &Layer, nodes: &Nodes, mode: usize) -> Self {
        let scattering = Self::within(layer, nodes, mode);
        if layer.index == 1.0 {
            return Self { operators: scattering };
        }
        let boundary = Operators::boundary(nodes);
        Self { operators: boundary.upon(&scattering).upon(&boundary.upside_down()) }
    }

    /// The layer without its boundaries.
    fn within(layer: &Layer, nodes: &Nodes, mode: usize) -> Operators {
        // Light that the quadrature cannot tell from light straight on is taken as such (Wiscombe 1977).
        let degrees = nodes.degrees;
        let forward = layer.phase.moment(degrees);
        let albedo = layer.albedo * (1.0 - forward) / (1.0 - layer.albedo * forward);
        let thickness = layer.thickness.min(DEEP) * (1.0 - layer.albedo * forward);
        let moments: Vec<f64> = (mode..degrees)
            .map(|degree| (2 * degree + 1) as f64 * (layer.phase.moment(degree) - forward) / (1.0 - forward))
            .collect();
        let polynomials: Vec<Vec<f64>> = nodes.inside.iter().map(|&cosine| legendre(mode, degrees, cosine)).collect();
        // A polynomial of the opposite direction has the sign of degree plus order.
        let scattered = |into: usize, from: usize, opposite: bool| {
            let terms = moments.iter().zip(polynomials[into].iter().zip(&polynomials[from])).enumerate();
            let sum: f64 =
                terms.map(|(k, (moment, (a, b)))| if opposite && k % 2 == 1 { -moment * a * b } else { moment * a * b }).sum();
            0.5 * albedo * sum * nodes.weights[from]
        };
        let doublings = (thickness / FIRST).log2().ceil().max(0.0) as i32;
        let step = thickness * 0.5f64.powi(doublings);
        let mut layer = thin(nodes, step, &scattered);
        for _ in 0..doublings {
            layer = layer.upon(&layer);
            if layer.down.largest() < NOTHING {
                break;
            }
        }
        layer
    }
}

/// A thin layer, by Padé's approximation of order 6 of exp(A d) for dI/dτ = A I, downward radiances first.
fn thin(nodes: &Nodes, thickness: f64, scattered: &dyn Fn(usize, usize, bool) -> f64) -> Operators {
    let size = nodes.len();
    let generator = Matrix::new(2 * size, |row, column| {
        let (into, from) = (row % size, column % size);
        let opposite = (row < size) != (column < size);
        let gained = scattered(into, from, opposite) - if row == column { 1.0 } else { 0.0 };
        // Upward radiances are followed against their direction.
        let direction = if row < size { 1.0 } else { -1.0 };
        direction * gained * thickness / nodes.inside[into]
    });
    let one = Matrix::identity(2 * size);
    let square = generator.times(&generator);
    let even = one.plus(0.1, &square);
    let odd = generator.plus(1.0 / 60.0, &generator.times(&square));
    let (forward, backward) = (even.plus(0.5, &odd), even.plus(-0.5, &odd));
    // `backward` · I(bottom) = `forward` · I(top), solved for what leaves: downward at the bottom, upward at the top.
    let leaving =
        Matrix::new(2 * size, |row, column| if column < size { backward.at(row, column) } else { -forward.at(row, column) });
    let entering =
        Matrix::new(2 * size, |row, column| if column < size { forward.at(row, column) } else { -backward.at(row, column) });
    let response = leaving.solve(&entering);
    let part = |low: usize, right: usize| Matrix::new(size, |row, column| response.at(low * size + row, right * size + column));
    Operators { down: part(0, 0), below: part(0, 1), above: part(1, 0), up: part(1, 1) }
}

/// A layer whose modes are solved.
#[derive(Debug, Clone)]
pub struct Solution {
    nodes: Nodes,
    modes: Vec<Mode>,
}

/// A part of the light that is reflected, and one that is transmitted.
#[derive(Debug, Clone, Copy)]
pub struct Parts {
    pub reflected: f64,
    pub transmitted: f64,
}

impl Solution {
    /// Solves the layer on `count` nodes, and makes it ready to be looked at from directions with these cosines outside. One mode is enough for what
    /// does not ask for the azimuth; a phase function whose moments end at degree l has l + 1.
    pub fn new(layer: &Layer, count: usize, modes: usize, looked_at: &[f64]) -> Self {
        let nodes = Nodes::new(count, layer.index, looked_at);
        let modes = (0..modes).map(|mode| Mode::new(layer, &nodes, mode)).collect();
        Self { nodes, modes }
    }

    /// The radiances above and below, towards a direction, where light of radiance 1 comes from all of the sky above. By reciprocity these are the
    /// parts of light from that direction that are reflected and transmitted.
    pub fn parts(&self, cosine: f64) -> Parts {
        let node = self.nodes.find(cosine);
        let [reflected, transmitted] = [&self.modes[0].operators.above, &self.modes[0].operators.down].map(|matrix| {
            // Directions that are none outside send nothing.
            (0..self.nodes.len()).filter(|&from| self.nodes.outside[from].is_some()).map(|from| matrix.at(node, from)).sum()
        });
        Parts { reflected, transmitted }
    }

    /// The parts by the flux that leaves of light from one direction: those of [`Self::parts`] by another way.
    pub fn parts_by_flux(&self, cosine: f64) -> Parts {
        let node = self.nodes.find(cosine);
        let entering = cosine * self.nodes.weight_outside(node);
        let [reflected, transmitted] = [&self.modes[0].operators.above, &self.modes[0].operators.down].map(|matrix| {
            let leaving = |to: usize| {
                self.nodes.outside[to].map_or(0.0, |outside| outside * self.nodes.weight_outside(to) * matrix.at(to, node))
            };
            (0..self.nodes.len()).map(leaving).sum::<f64>() / entering
        });
        Parts { reflected, transmitted }
    }

    /// The parts of light that comes from all of the sky alike.
    pub fn parts_of_diffuse_light(&self) -> Parts {
        let [reflected, transmitted] = [&self.modes[0].operators.above, &self.modes[0].operators.down].map(|matrix| {
            let sums = matrix.row_sums();
            let flux = |to: usize| {
                self.nodes.outside[to].map_or(0.0, |outside| 2.0 * outside * self.nodes.weight_outside(to) * sums[to])
            };
            (0..self.nodes.len()).map(flux).sum()
        });
        Parts { reflected, transmitted }
    }

    /// The radiances above and below of light from afar whose irradiance perpendicular to itself is 1, from and towards directions with these
    /// cosines outside; the azimuth is that between the directions of travel, 0 where the light goes on. The same cosine twice has no meaning
    /// where light comes straight through or is mirrored.
    pub fn radiance(&self, [light, eye]: [f64; 2], azimuth: f64) -> Parts {
        let [from, to] = [light, eye].map(|cosine| self.nodes.find(cosine));
        let scale = 1.0 / (TAU * self.nodes.weight_outside(from));
        let modes = self.modes.iter().enumerate().map(|(mode, solved)| {
            let factor = if mode == 0 { scale } else { 2.0 * scale * (mode as f64 * azimuth).cos() };
            [solved.operators.above.at(to, from) * factor, solved.operators.down.at(to, from) * factor]
        });
        let [reflected, transmitted] = modes.fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d]);
        Parts { reflected, transmitted }
    }
}
