//! What Russian roulette from another depth on would do to paths that were traced.
//!
//! A path finds contributions c₁, c₂, … as if there were no roulette, and reaches the k-th with a probability Pₖ, the product of the chances to survive
//! up to there. The sample is Σ cₖ / Pₖ over what the path reaches, and its second moment is the mean of Σₖ (cₖ² + 2 cₖ Σ_{j>k} cⱼ) / Pₖ, because
//! whoever reaches j has reached k before. So the paths of one render give the variance, and the rays, of roulette from any depth on: what they find
//! counts by one over the probability that they themselves had.

use glam::DVec3;

use super::rays::Rays;
use super::sum::Sum;
use super::watched::Record;
use crate::reference::bsdf::BsdfSample;
use crate::reference::roulette;
use crate::reference::trace::LightConnection;
use crate::scene::RenderSettings;
use crate::scene::settings::DEFAULT_ROULETTE_DEPTH;

/// First depths at which roulette may end a path, and 0 for none that does. The first is that of the paths that are traced.
pub const ROULETTE_DEPTHS: [u32; 6] = [DEFAULT_ROULETTE_DEPTH, 4, 3, 2, 1, 0];
/// Which of them is that of the traced paths.
const OWN: usize = 0;

/// A number for each of [`ROULETTE_DEPTHS`].
type OfEach<T> = [T; ROULETTE_DEPTHS.len()];

/// What roulette would do to samples.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Effect {
    /// By how much a sample's variance would be larger than that of the traced paths.
    pub variance: DVec3,
    pub rays: Rays,
}

impl Sum for Effect {
    fn and(self, other: Self) -> Self {
        Self { variance: self.variance + other.variance, rays: self.rays.and(other.rays) }
    }

    fn times(self, factor: f64) -> Self {
        Self { variance: self.variance * factor, rays: self.rays.times(factor) }
    }
}

/// The effect of each depth.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Effects(pub OfEach<Effect>);

impl Sum for Effects {
    fn and(self, other: Self) -> Self {
        Self(std::array::from_fn(|index| self.0[index].and(other.0[index])))
    }

    fn times(self, factor: f64) -> Self {
        Self(self.0.map(|effect| effect.times(factor)))
    }
}

/// Follows one path.
pub struct PathRecord {
    /// The chance to come to the path's end as it stands.
    survival: OfEach<f64>,
    /// As if there were no roulette.
    throughput: DVec3,
    eta_scale: f64,
    depth: u32,
    /// Contributions as if there were no roulette, with the chances to reach them.
    found: Vec<(DVec3, OfEach<f64>)>,
    rays: OfEach<Rays>,
}

impl PathRecord {
    /// The path found light.
    fn add(&mut self, contribution: DVec3) {
        if contribution != DVec3::ZERO {
            self.found.push((contribution * self.survival[OWN], self.survival));
        }
    }
}

impl Record for PathRecord {
    type Told = Effects;

    fn new(_: &RenderSettings) -> Self {
        Self {
            survival: [1.0; ROULETTE_DEPTHS.len()],
            throughput: DVec3::ONE,
            eta_scale: 1.0,
            depth: 1,
            found: Vec::new(),
            rays: Default::default(),
        }
    }

    fn told(&self) -> Effects {
        let mut effects = Effects(self.rays.map(|rays| Effect { variance: DVec3::ZERO, rays }));
        let mut behind = DVec3::ZERO;
        for (contribution, survival) in self.found.iter().rev() {
            let own = *contribution / survival[OWN];
            let moment = *contribution * (own + 2.0 * behind);
            for (effect, chance) in effects.0.iter_mut().zip(survival) {
                effect.variance += moment * (1.0 / chance - 1.0 / survival[OWN]);
            }
            behind += own;
        }
        effects
    }

    fn traced(&mut self, rays: Rays) {
        for (sum, survival) in self.rays.iter_mut().zip(self.survival) {
            *sum = sum.and(rays.times(survival / self.survival[OWN]));
        }
    }

    fn met(&mut self, depth: u32, throughput: DVec3) {
        self.depth = depth;
        // Roulette has made it larger.
        self.throughput = throughput * self.survival[OWN];
    }

    fn light(&mut self, connection: &LightConnection) {
        self.add(connection.contribution);
    }

    fn found(&mut self, _weight: f64, contribution: DVec3) {
        self.add(contribution);
    }

    fn scattered(&mut self, sample: &BsdfSample) {
        self.eta_scale *= sample.eta * sample.eta;
        let throughput = self.throughput * sample.weight * self.eta_scale;
        // Null surfaces end no edge.
        if sample.is_null || throughput.max_element() <= 0.0 {
            return;
        }
        for (survival, first) in self.survival.iter_mut().zip(ROULETTE_DEPTHS) {
            if first > 0 && self.depth >= first {
                *survival *= roulette::survival(throughput / *survival, self.depth);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::bsdf::Density;

    const VERTICES: u32 = 8;

    /// A path on which each vertex takes half of the throughput, and finds light that differs from vertex to vertex.
    struct Path {
        /// Of each vertex: the chance to reach it with roulette from some depth on.
        reached: Vec<f64>,
    }

    impl Path {
        fn new(first: u32) -> Self {
            let mut reached = vec![1.0];
            for depth in 1..VERTICES {
                let before = reached[depth as usize - 1];
                let survives = if first > 0 && depth >= first { (0.5_f64.powi(depth as i32) / before).min(1.0) } else { 1.0 };
                reached.push(before * survives);
            }
            Self { reached }
        }

        /// The chance that it ends behind vertex `last`, from 0.
        fn ends_at(&self, last: usize) -> f64 {
            self.reached[last] - self.reached.get(last + 1).copied().unwrap_or(0.0)
        }

        fn second_moment(&self) -> f64 {
            let sample = |last: usize| (0..=last).map(|vertex| light(vertex) / self.reached[vertex]).sum::<f64>();
            (0..self.reached.len()).map(|last| self.ends_at(last) * sample(last).powi(2)).sum()
        }
    }

    /// What is found at a vertex, times the throughput there.
    fn light(vertex: usize) -> f64 {
        [0.3, 3.0, 2.0, 1.0, 7.0, 0.1, 4.0, 9.0][vertex] * 0.5_f64.powi(vertex as i32)
    }

    /// All ends that roulette may give a path, weighed by their chance, tell what roulette from any other depth on does.
    #[test]
    fn effects_are_those_of_every_other_roulette() {
        let own = Path::new(ROULETTE_DEPTHS[OWN]);
        let half =
            BsdfSample { wi: DVec3::Y, weight: DVec3::splat(0.5), density: Density::SolidAngle(1.0), eta: 1.0, is_null: false };
        let mut mean = Effects::default();
        for last in 0..VERTICES as usize {
            let mut record = PathRecord::new(&RenderSettings::default());
            for vertex in 0..=last {
                let chance = own.reached[vertex];
                record.traced(Rays::PATH);
                record.met(vertex as u32 + 1, DVec3::splat(0.5_f64.powi(vertex as i32) / chance));
                record.found(1.0, DVec3::splat(light(vertex) / chance));
                record.scattered(&half);
            }
            mean = mean.and(record.told().times(own.ends_at(last)));
        }
        for (first, effect) in ROULETTE_DEPTHS.into_iter().zip(mean.0) {
            let path = Path::new(first);
            let more = path.second_moment() - own.second_moment();
            assert!((effect.variance.x - more).abs() < 1e-9, "from {first} on: {} and {more}", effect.variance.x);
            let rays: f64 = path.reached.iter().sum();
            assert!((effect.rays.path - rays).abs() < 1e-9, "from {first} on: {} and {rays}", effect.rays.path);
        }
        // The depths differ, so that one taken for another would show.
        let variances = mean.0.map(|effect| effect.variance.x);
        assert!(variances[1..].windows(2).all(|pair| (pair[0] - pair[1]).abs() > 0.1), "{variances:?}");
    }
}
