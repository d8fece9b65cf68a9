//! A decision in words.

use serde::Serialize;

use crate::sampling::light_strategy::LightStrategy;

/// One decision, in words.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Decision {
    /// The subject of the decision, for example `geometry`.
    pub about: &'static str,
    pub choice: String,
    /// The facts of scene and device that led to it.
    pub because: String,
}

impl Decision {
    /// How many light samples surfaces take, as [`crate::scene::RenderSettings::several_light_samples`] says it.
    pub fn about_light_samples([count, depth]: [u32; 2], because: &str) -> Self {
        let choice = match (count, depth) {
            (1, _) => "1".to_owned(),
            (count, 1) => format!("{count} at the first surface"),
            (count, depth) => format!("{count} at each of the first {depth} surfaces"),
        };
        Self { about: "light samples", choice, because: because.to_owned() }
    }

    /// How lights are chosen, where that was tried.
    pub fn about_light_choice(strategy: LightStrategy, because: &str) -> Self {
        let choice = match strategy {
            LightStrategy::Power => "by power",
            LightStrategy::Tree => "by a tree",
            LightStrategy::Cells => "by what reaches the place",
        };
        Self { about: "light choice", choice: choice.to_owned(), because: because.to_owned() }
    }

    /// How directions are drawn.
    pub fn about_directions(guided: bool, because: &str) -> Self {
        let choice = if guided { "by BSDFs, and by a guide to where light comes from" } else { "by BSDFs alone" };
        Self { about: "directions", choice: choice.to_owned(), because: because.to_owned() }
    }
}
