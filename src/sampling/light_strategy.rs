//! The strategy by which lights are chosen.

use super::light_sampler::LightSampler;
use super::light_tree::MOST_LIGHTS;
use crate::scene::LightChoice;

/// Lights inside a scene from which on there are many: `auto` tries cells of lights, and takes a tree where these hold too little. Of fewer, a trial run compares
/// cells with a choice by power. A guess, not a measurement.
pub const MANY_LIGHTS: usize = 24;

/// How lights are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LightStrategy {
    /// By [`super::light_sampler`].
    Power,
    /// By [`super::light_tree`] among lights inside the scene.
    Tree,
    /// By [`super::light_cells`].
    Cells,
}

impl LightStrategy {
    /// The strategy for these lights. `auto` is the tree for many lights and power for few, where nothing was
    /// [learned](crate::learn::settle).
    pub fn of(choice: LightChoice, lights: &LightSampler) -> Self {
        let local = lights.local_count();
        let can_be = |fewest: usize, strategy| if (fewest..=MOST_LIGHTS).contains(&local) { strategy } else { Self::Power };
        match choice {
            LightChoice::Power => Self::Power,
            LightChoice::Auto => can_be(MANY_LIGHTS, Self::Tree),
            LightChoice::Tree => can_be(2, Self::Tree),
            LightChoice::Cells if lights.count() > 1 => can_be(1, Self::Cells),
            LightChoice::Cells => Self::Power,
        }
    }
}
