//! Which way lights inside a scene are chosen.

use super::light_tree::MOST_LIGHTS;
use crate::scene::LightChoice;

/// Fewest lights inside a scene that are chosen otherwise than by power unless that is asked for: a guess, not a measurement.
pub const FEWEST_LIGHTS: usize = 24;

/// How lights inside a scene are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LightWay {
    /// By [`super::light_sampler`].
    Power,
    /// By [`super::light_tree`].
    Tree,
    /// By [`super::light_cells`].
    Cells,
}

impl LightWay {
    /// Of so many lights inside the scene. `auto` is the tree where nothing was [tried](crate::reference::light_cells::settle).
    pub fn of(choice: LightChoice, local_lights: usize) -> Self {
        let fewest = if choice == LightChoice::Auto { FEWEST_LIGHTS } else { 2 };
        if !(fewest..=MOST_LIGHTS).contains(&local_lights) {
            return Self::Power;
        }
        match choice {
            LightChoice::Power => Self::Power,
            LightChoice::Auto | LightChoice::Tree => Self::Tree,
            LightChoice::Cells => Self::Cells,
        }
    }
}
