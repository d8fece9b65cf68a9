//! How often next event estimation chooses each light: mostly by power, and sometimes any lamp as well as any other.
//!
//! Power alone is a poor guide where the strongest lamp does not reach: a point in its shadow sees the others alone, and nearly all of
//! its samples are lost. The even share bounds that. Where power was right, it costs at most 1/0.7 of the variance.

use std::collections::HashMap;

use super::alias::AliasTable;

/// Share of the choices in which all lamps are alike (measured in `docs/strategies.md`).
const EVEN_SHARE: f64 = 0.3;

/// What lights are parts of. A mesh that emits is one lamp, however many triangles it has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Lamp {
    Surface {
        shape: usize,
        material: usize,
    },
    /// The light is one of its own.
    Alone,
    /// The environment and the portals to it.
    Environment,
}

/// Weighs the lights of a scene, in their order.
#[derive(Debug, Clone, Default)]
pub struct LightChoice {
    local: Weights,
    at_infinity: Weights,
}

impl LightChoice {
    /// A light inside the scene, by its luminous power; above 0. All of these come before those at infinity.
    pub fn add(&mut self, lamp: Lamp, power: f64) {
        self.local.add(lamp, power);
    }

    /// A light at infinity, by the irradiance that it could make; above 0.
    pub fn add_at_infinity(&mut self, lamp: Lamp, irradiance: f64) {
        self.at_infinity.add(lamp, irradiance);
    }

    /// The probabilities of all lights. What lights at infinity send depends on how large the scene is taken to be: together they are as
    /// likely as all others.
    pub fn table(&self) -> AliasTable {
        let weights: Vec<f64> = [&self.local, &self.at_infinity].into_iter().flat_map(Weights::probabilities).collect();
        AliasTable::new(&weights)
    }
}

/// Some lights, and the lamps they are parts of.
#[derive(Debug, Clone, Default)]
struct Weights {
    /// The weight of each light and its place among the lamps.
    lights: Vec<(f64, usize)>,
    /// The weight of each lamp.
    lamps: Vec<f64>,
    of_surface: HashMap<Lamp, usize>,
}

impl Weights {
    fn add(&mut self, lamp: Lamp, weight: f64) {
        let new = self.lamps.len();
        let place = if lamp == Lamp::Alone { new } else { *self.of_surface.entry(lamp).or_insert(new) };
        if place == new {
            self.lamps.push(0.0);
        }
        self.lamps[place] += weight;
        self.lights.push((weight, place));
    }

    /// They sum to 1.
    fn probabilities(&self) -> impl Iterator<Item = f64> {
        let total: f64 = self.lamps.iter().sum();
        let even = 1.0 / self.lamps.len() as f64;
        self.lights
            .iter()
            .map(move |&(weight, lamp)| (1.0 - EVEN_SHARE) * weight / total + EVEN_SHARE * even * weight / self.lamps[lamp])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mostly_by_power_and_else_evenly_over_lamps() {
        let mut choice = LightChoice::default();
        let mesh = |material| Lamp::Surface { shape: 3, material };
        for (lamp, power) in [(mesh(0), 1.0), (mesh(1), 4.0), (mesh(0), 3.0), (Lamp::Alone, 1.0), (Lamp::Alone, 1.0)] {
            choice.add(lamp, power);
        }
        let mixed = |by_power: f64, even: f64| 0.7 * by_power + 0.3 * even;
        let expected = [mixed(0.1, 0.0625), mixed(0.4, 0.25), mixed(0.3, 0.1875), mixed(0.1, 0.25), mixed(0.1, 0.25)];
        let pmf = choice.table().pmf;
        for (pmf, expected) in pmf.iter().zip(expected) {
            assert!((pmf - expected).abs() < 1e-15, "{pmf} {expected}");
        }
        choice.add_at_infinity(Lamp::Environment, 2.0);
        choice.add_at_infinity(Lamp::Alone, 2.0);
        choice.add_at_infinity(Lamp::Environment, 6.0);
        let with_infinity = choice.table().pmf;
        assert!(pmf.iter().zip(&with_infinity).all(|(alone, shared)| (0.5 * alone - shared).abs() < 1e-15));
        for (pmf, expected) in with_infinity[5..].iter().zip([mixed(0.2, 0.125), mixed(0.2, 0.5), mixed(0.6, 0.375)]) {
            assert!((pmf - 0.5 * expected).abs() < 1e-15, "{with_infinity:?}");
        }
    }

    #[test]
    fn no_lights_give_an_empty_table() {
        assert!(LightChoice::default().table().pmf.is_empty());
    }
}
