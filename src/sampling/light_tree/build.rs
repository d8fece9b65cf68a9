//! Builds a tree of lights, from the root down, by the surface area and orientation heuristic (Conty Estévez and Kulla 2018).

use glam::{DVec3, I64Vec3};

use super::cluster::{LEAF, LightCluster, LightNode};
use super::cone::Cone;
use super::emitter::Emitter;

/// Cells of the grid that boxes are rounded to, along the longest side of the box around all lights.
const GRID: f64 = (1 << 22) as f64;
/// Least longest side, as a share of the largest coordinate.
const LEAST_EXTENT: f64 = 1e-12;
/// Rounding of centers to f32, as a share of the largest coordinate.
const CENTER_ROUNDING: f64 = 1.2e-7;
/// Most nodes on the way to a light: its trail has a bit for each.
const MOST_NODES: u32 = 32;
/// Places along an axis where a cluster may be cut, and one more.
const BUCKETS: usize = 12;

/// Some lights, or one.
#[derive(Debug, Clone, Copy)]
struct Cluster {
    low: I64Vec3,
    high: I64Vec3,
    cone: Cone,
    power: f64,
}

#[derive(Debug, Clone, Copy)]
struct Leaf {
    light: usize,
    cluster: Cluster,
}

impl Cluster {
    fn union(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            cone: self.cone.union(other.cone),
            power: self.power + other.power,
        }
    }

    /// Twice the middle of its box.
    fn doubled_center(&self) -> I64Vec3 {
        self.low + self.high
    }

    /// The cost of choosing among the lights: power times how far they lie apart and how differently they
    /// shine. The squared diagonal counts, not the area, because lights often stand in a line.
    fn cost(&self) -> f64 {
        self.power * self.cone.measure() * (self.high - self.low).as_dvec3().length_squared()
    }
}

/// The whole numbers that boxes are rounded to.
struct Grid {
    origin: DVec3,
    cell: f64,
    /// By how much spheres around boxes grow, for all rounding.
    slack: f64,
}

impl Grid {
    fn around(emitters: &[Emitter]) -> Self {
        let ends = emitters.iter().map(|emitter| emitter.bounds);
        let [low, high] =
            ends.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], [lower, upper]| [low.min(lower), high.max(upper)]);
        let largest = low.abs().max(high.abs()).max_element();
        let extent = (high - low).max_element().max(LEAST_EXTENT * largest).max(f64::from(f32::MIN_POSITIVE).sqrt());
        let cell = extent / GRID;
        Self { origin: low, cell, slack: 2.0 * cell + CENTER_ROUNDING * largest }
    }

    fn leaf(&self, (light, emitter): (usize, &Emitter)) -> Leaf {
        let [low, high] = emitter.bounds.map(|corner| ((corner - self.origin) / self.cell).round().as_i64vec3());
        // Rounded, so that it is the same however it was found.
        let power = f64::from(emitter.power as f32);
        Leaf { light, cluster: Cluster { low, high, cone: emitter.cone, power } }
    }

    fn packed(&self, cluster: &Cluster, all: f64, link: u32) -> LightCluster {
        let center = self.origin + cluster.doubled_center().as_dvec3() * (0.5 * self.cell);
        let radius = 0.5 * self.cell * (cluster.high - cluster.low).as_dvec3().length() + self.slack;
        LightCluster::new(center, radius, cluster.power / all, cluster.cone, link)
    }
}

/// The nodes, the root first and children behind their parents; and each light's trail.
pub fn build(emitters: &[Emitter]) -> (Vec<LightNode>, Vec<u32>) {
    let grid = Grid::around(emitters);
    let mut leaves: Vec<Leaf> = emitters.iter().enumerate().map(|light| grid.leaf(light)).collect();
    let mut builder = Builder { all: sum(&leaves).power, grid, nodes: Vec::new(), trails: vec![0; emitters.len()] };
    builder.add(&mut leaves, 0, 0);
    (builder.nodes, builder.trails)
}

struct Builder {
    grid: Grid,
    /// Power of all lights.
    all: f64,
    nodes: Vec<LightNode>,
    trails: Vec<u32>,
}

impl Builder {
    /// Adds the node of two lights or more, to which `depth` nodes lead by `trail`, and those below it. Returns its number.
    fn add(&mut self, leaves: &mut [Leaf], depth: u32, trail: u32) -> u32 {
        let number = self.nodes.len() as u32;
        let middle = cut(leaves, MOST_NODES - depth - 1);
        let (first, second) = leaves.split_at_mut(middle);
        let clusters = [sum(first), sum(second)];
        let empty = self.grid.packed(&clusters[0], self.all, 0);
        self.nodes.push(LightNode { clusters: [empty; 2] });
        for (side, part) in [first, second].into_iter().enumerate() {
            let trail = trail | (side as u32) << depth;
            let link = if let [leaf] = part {
                self.trails[leaf.light] = trail;
                LEAF | leaf.light as u32
            } else {
                self.add(part, depth + 1, trail)
            };
            self.nodes[number as usize].clusters[side] = self.grid.packed(&clusters[side], self.all, link);
        }
        number
    }
}

/// All of some leaves, of which there is one at least.
fn sum(leaves: &[Leaf]) -> Cluster {
    leaves[1..].iter().fold(leaves[0].cluster, |sum, leaf| sum.union(leaf.cluster))
}

/// Puts those that go to the first cluster first, and returns how many. `nodes` more may stand on the way to each of them.
fn cut(leaves: &mut [Leaf], nodes: u32) -> usize {
    let most = 1_usize << nodes.min(40);
    if let Some((axis, bucket, range)) = cheapest_cut(leaves) {
        // Stable, so that the order of lights stays what it was.
        leaves.sort_by_key(|leaf| bucket_of(leaf, axis, range) >= bucket);
        let first = leaves.partition_point(|leaf| bucket_of(leaf, axis, range) < bucket);
        if first.max(leaves.len() - first) <= most {
            return first;
        }
    }
    // Lights that all lie in one place, or so many that the rest of the trail does not tell them apart.
    let center = |leaf: &Leaf| leaf.cluster.doubled_center();
    let (low, high) =
        leaves.iter().fold((I64Vec3::MAX, I64Vec3::MIN), |(low, high), leaf| (low.min(center(leaf)), high.max(center(leaf))));
    let extent = (high - low).to_array();
    let axis = (0..3).max_by_key(|&axis| extent[axis]).unwrap_or(0);
    leaves.sort_by_key(|leaf| center(leaf)[axis]);
    leaves.len() / 2
}

fn bucket_of(leaf: &Leaf, axis: usize, [low, high]: [i64; 2]) -> usize {
    let place = i128::from(leaf.cluster.doubled_center()[axis] - low) * BUCKETS as i128 / i128::from(high - low + 1);
    place as usize
}

/// An axis, the bucket at which the second cluster begins, and what the buckets lie between.
type Cut = (usize, usize, [i64; 2]);

/// None: all centers lie in one place.
fn cheapest_cut(leaves: &[Leaf]) -> Option<Cut> {
    let mut best: Option<(f64, Cut)> = None;
    let (mut low, mut high) = (I64Vec3::MAX, I64Vec3::MIN);
    for leaf in leaves {
        (low, high) = (low.min(leaf.cluster.doubled_center()), high.max(leaf.cluster.doubled_center()));
    }
    let longest = (high - low).max_element();
    for axis in 0..3 {
        let range = [low[axis], high[axis]];
        if range[0] == range[1] {
            continue;
        }
        let mut buckets: [Option<Cluster>; BUCKETS] = [None; BUCKETS];
        for leaf in leaves {
            let bucket = &mut buckets[bucket_of(leaf, axis, range)];
            *bucket = join(*bucket, Some(leaf.cluster));
        }
        // The union of all buckets from each one on.
        let mut behind = [None; BUCKETS];
        for bucket in (1..BUCKETS).rev() {
            behind[bucket] = join(buckets[bucket], behind.get(bucket + 1).copied().flatten());
        }
        // Thin clusters cost more.
        let thinness = longest as f64 / (range[1] - range[0]) as f64;
        let mut before = None;
        for bucket in 1..BUCKETS {
            before = join(before, buckets[bucket - 1]);
            let (Some(first), Some(second)) = (before, behind[bucket]) else { continue };
            let cost = thinness * (first.cost() + second.cost());
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, (axis, bucket, range)));
            }
        }
    }
    best.map(|(_, cut)| cut)
}

fn join(a: Option<Cluster>, b: Option<Cluster>) -> Option<Cluster> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.union(b)),
        (one, None) | (None, one) => one,
    }
}
