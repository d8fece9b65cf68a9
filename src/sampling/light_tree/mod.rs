//! A tree over the lights inside a scene, by which next event estimation chooses the near ones that face a point more often than others
//! (Conty Estévez and Kulla 2018; as in pbrt-v4).
//!
//! A node knows, of each of its two clusters of lights, a sphere around them, their power, and a cone around the directions that they emit
//! in. From these follows how much light each can send to a point, and by that one of the two is chosen, until a single light is left. The
//! tree is built once, from numbers that are rounded first, so that the device and the reference, which find them in different ways, have
//! the same tree.
//!
//! 32 random bits choose a light as an arithmetic decoder does: a node splits its range of integers between its clusters, and the bits lie
//! in one of the two parts. So all probabilities sum to one, few bits are lost on the way down, and devices that round differently choose
//! another light only where the bits lie next to a border. `shaders/shading/light/choice/tree.wgsl` is the device's half.

mod build;
pub mod cluster;
mod cone;
mod emitter;
mod strongest;

pub use cluster::{LEAF, LightCluster, LightNode, NUMBER_MASK, TWO_SIDED};
pub use emitter::Emitter;

use glam::DVec3;

use super::alias::AliasTable;

/// Most of them: the tables of more would leave no room for anything else.
pub const MOST_LIGHTS: usize = 1 << 19;
/// All random bits but the last value, which would lie in no part.
const WHOLE_RANGE: u32 = u32::MAX;

/// How a light is chosen: by the tree among those inside the scene, which are numbered first; by irradiance among those at infinity,
/// which make half of the choices where there are both.
#[derive(Debug, Clone)]
pub struct LightTree {
    /// The root is the first; children stand behind their parents.
    pub nodes: Vec<LightNode>,
    /// The way to each light inside the scene: a bit for each node from the root on, lowest first, that names
    /// the cluster.
    pub trails: Vec<u32>,
    /// A sphere around each light inside the scene.
    spheres: Vec<(DVec3, f64)>,
    /// The table that chooses among lights at infinity.
    pub at_infinity: AliasTable,
}

impl LightTree {
    /// A tree over two or more lights inside the scene; `at_infinity` chooses among the others, and its
    /// probabilities sum to one or are none.
    pub fn new(emitters: &[Emitter], at_infinity: AliasTable) -> Self {
        let (nodes, trails) = build::build(emitters);
        let sphere = |emitter: &Emitter| {
            let [low, high] = emitter.bounds;
            (0.5 * (low + high), 0.5 * low.distance(high))
        };
        Self { nodes, trails, spheres: emitters.iter().map(sphere).collect(), at_infinity }
    }

    /// A sphere around a light inside the scene.
    pub fn sphere(&self, light: u32) -> (DVec3, f64) {
        self.spheres[light as usize]
    }

    /// Lights inside the scene by what they can send at most to a point within a distance of another if nothing is in between, the strongest first: `count`
    /// of those that `is_wanted`.
    pub fn strongest(&self, place: (DVec3, f64), count: usize, is_wanted: impl Fn(u32) -> bool) -> Vec<u32> {
        strongest::strongest(&self.nodes, place, count, is_wanted)
    }

    /// The share of the choices that goes to lights inside the scene.
    pub fn local_share(&self) -> f64 {
        if self.at_infinity.pmf.is_empty() { 1.0 } else { 0.5 }
    }

    /// The light that 32 random bits choose at a point, and the probability of that. The probability is 0 where no light is chosen.
    pub fn choose(&self, point: DVec3, bits: u32) -> (usize, f64) {
        if self.at_infinity.pmf.is_empty() {
            return self.choose_local(point, bits);
        }
        let rest = bits << 1;
        if bits >> 31 == 1 {
            let light = self.at_infinity.choose(rest);
            return (self.trails.len() + light, 0.5 * self.at_infinity.pmf[light]);
        }
        let (light, probability) = self.choose_local(point, rest);
        (light, 0.5 * probability)
    }

    fn choose_local(&self, point: DVec3, bits: u32) -> (usize, f64) {
        let (mut number, mut offset, mut range) = (0, bits.min(WHOLE_RANGE - 1), WHOLE_RANGE);
        loop {
            let node = &self.nodes[number as usize];
            let first = node.first_part(point, range);
            let second = offset >= first;
            if second {
                offset -= first;
                range -= first;
            } else {
                range = first;
            }
            let link = node.clusters[usize::from(second)].link;
            number = link & NUMBER_MASK;
            if link & LEAF != 0 {
                return (number as usize, share(range));
            }
        }
    }

    /// The probability with which [`LightTree::choose`] chooses a light inside the scene at a point.
    pub fn probability(&self, point: DVec3, light: usize) -> f64 {
        let (mut number, mut range, mut trail) = (0, WHOLE_RANGE, self.trails[light]);
        loop {
            let node = &self.nodes[number as usize];
            let first = node.first_part(point, range);
            let second = trail & 1 == 1;
            range = if second { range - first } else { first };
            trail >>= 1;
            let link = node.clusters[usize::from(second)].link;
            if link & LEAF != 0 {
                return self.local_share() * share(range);
            }
            number = link & NUMBER_MASK;
        }
    }
}

/// The part of all random bits that a range of them is.
fn share(range: u32) -> f64 {
    f64::from(range) / 4_294_967_296.0
}

#[cfg(test)]
mod tests;
