//! Which way lights inside a scene are chosen.

use super::light_tree::MOST_LIGHTS;
use crate::scene::{LightChoice, Scene, SceneSummary};

/// Fewest lights inside a scene that are chosen otherwise than by power unless that is asked for: a guess, not a measurement.
pub const FEWEST_LIGHTS: usize = 24;
/// Pixels of a film below which learning which lights reach which place would take longer than it saves.
pub const FEWEST_PIXELS: u64 = 1 << 13;
/// Triangles above which the reference's hierarchy, by which that is learned, takes seconds to build.
pub const MOST_TRIANGLES: usize = 1 << 20;

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
    /// Of a scene with so many lights inside.
    pub fn of(scene: &Scene, local_lights: usize) -> Self {
        let fewest = if scene.render.light_choice == LightChoice::Auto { FEWEST_LIGHTS } else { 2 };
        if !(fewest..=MOST_LIGHTS).contains(&local_lights) {
            return Self::Power;
        }
        match scene.render.light_choice {
            LightChoice::Power => Self::Power,
            LightChoice::Tree => Self::Tree,
            LightChoice::Cells => Self::Cells,
            LightChoice::Auto if is_worth_learning(scene) => Self::Cells,
            LightChoice::Auto => Self::Tree,
        }
    }
}

fn is_worth_learning(scene: &Scene) -> bool {
    let pixels: u64 = scene.film.size.map(u64::from).iter().product();
    let SceneSummary { triangles, group_triangles, .. } = SceneSummary::of(scene);
    pixels >= FEWEST_PIXELS && triangles + group_triangles <= MOST_TRIANGLES
}
