//! How often next event estimation chooses each light: mostly by power, and sometimes any group of them as well as any other.
//!
//! Power alone is a poor guide where the strongest light does not reach: a point in its shadow sees the others alone, and nearly all of
//! its samples are lost. The even share bounds that. Where power was right, it costs at most 1/0.7 of the variance.

use std::collections::HashMap;

use super::alias::AliasTable;
use crate::scene::LightStrength;

/// Share of the choices in which all groups are alike (measured in `docs/strategies.md`).
const EVEN_SHARE: f64 = 0.3;

/// Groups of lights. A mesh that emits is one group, however many triangles it has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LightGroup {
    Surface {
        shape: usize,
        material: usize,
    },
    /// The light is a group of its own.
    Alone,
    /// The environment and the portals to it.
    Environment,
}

/// Weighs the lights of a scene, in their order.
#[derive(Debug, Clone, Default)]
pub struct LightSampler {
    local: Weights,
    at_infinity: Weights,
}

impl LightSampler {
    /// The next light, of a strength above 0. Those inside the scene come before those at infinity.
    pub fn add(&mut self, group: LightGroup, strength: LightStrength) {
        match strength {
            LightStrength::Power(power) => self.local.add(group, power),
            LightStrength::Irradiance(irradiance) => self.at_infinity.add(group, irradiance),
        }
    }

    /// How many lights inside the scene there are; they are numbered first.
    pub fn local_count(&self) -> usize {
        self.local.lights.len()
    }

    /// How many lights there are.
    pub fn count(&self) -> usize {
        self.local.lights.len() + self.at_infinity.lights.len()
    }

    /// How many groups they make.
    pub fn group_count(&self) -> usize {
        self.local.groups.len() + self.at_infinity.groups.len()
    }

    /// The probabilities of the lights at infinity alone; none where there are none.
    pub fn table_at_infinity(&self) -> AliasTable {
        AliasTable::new(&self.at_infinity.probabilities().collect::<Vec<f64>>())
    }

    /// The probabilities of all lights. What lights at infinity send depends on how large the scene is taken to be: together they are as
    /// likely as all others.
    pub fn table(&self) -> AliasTable {
        let weights: Vec<f64> = [&self.local, &self.at_infinity].into_iter().flat_map(Weights::probabilities).collect();
        AliasTable::new(&weights)
    }
}

/// Some lights, and the groups they are parts of.
#[derive(Debug, Clone, Default)]
struct Weights {
    /// The weight of each light and the index of its group.
    lights: Vec<(f64, usize)>,
    /// The weight of each group.
    groups: Vec<f64>,
    known: HashMap<LightGroup, usize>,
}

impl Weights {
    fn add(&mut self, group: LightGroup, weight: f64) {
        let new = self.groups.len();
        let index = if group == LightGroup::Alone { new } else { *self.known.entry(group).or_insert(new) };
        if index == new {
            self.groups.push(0.0);
        }
        self.groups[index] += weight;
        self.lights.push((weight, index));
    }

    /// They sum to 1.
    fn probabilities(&self) -> impl Iterator<Item = f64> {
        let total: f64 = self.groups.iter().sum();
        let even = 1.0 / self.groups.len() as f64;
        self.lights
            .iter()
            .map(move |&(weight, group)| (1.0 - EVEN_SHARE) * weight / total + EVEN_SHARE * even * weight / self.groups[group])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mostly_by_power_and_else_evenly_over_groups() {
        let mut sampler = LightSampler::default();
        let mesh = |material| LightGroup::Surface { shape: 3, material };
        for (group, power) in [(mesh(0), 1.0), (mesh(1), 4.0), (mesh(0), 3.0), (LightGroup::Alone, 1.0), (LightGroup::Alone, 1.0)]
        {
            sampler.add(group, LightStrength::Power(power));
        }
        let mixed = |by_power: f64, even: f64| 0.7 * by_power + 0.3 * even;
        let expected = [mixed(0.1, 0.0625), mixed(0.4, 0.25), mixed(0.3, 0.1875), mixed(0.1, 0.25), mixed(0.1, 0.25)];
        let pmf = sampler.table().pmf;
        for (pmf, expected) in pmf.iter().zip(expected) {
            assert!((pmf - expected).abs() < 1e-15, "{pmf} {expected}");
        }
        sampler.add(LightGroup::Environment, LightStrength::Irradiance(2.0));
        sampler.add(LightGroup::Alone, LightStrength::Irradiance(2.0));
        sampler.add(LightGroup::Environment, LightStrength::Irradiance(6.0));
        let with_infinity = sampler.table().pmf;
        assert!(pmf.iter().zip(&with_infinity).all(|(alone, shared)| (0.5 * alone - shared).abs() < 1e-15));
        for (pmf, expected) in with_infinity[5..].iter().zip([mixed(0.2, 0.125), mixed(0.2, 0.5), mixed(0.6, 0.375)]) {
            assert!((pmf - 0.5 * expected).abs() < 1e-15, "{with_infinity:?}");
        }
    }

    #[test]
    fn no_lights_give_an_empty_table() {
        assert!(LightSampler::default().table().pmf.is_empty());
    }
}
