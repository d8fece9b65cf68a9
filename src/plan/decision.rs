//! A decision in words.

use serde::Serialize;

/// One decision, in words.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Decision {
    /// What is decided, for example `geometry`.
    pub about: &'static str,
    pub choice: String,
    /// The facts of scene and device that led to it.
    pub because: String,
}

impl Decision {
    /// How directions are drawn.
    pub fn about_directions(guided: bool, because: &str) -> Self {
        let choice = if guided { "by BSDFs, and by a guide to where light comes from" } else { "by BSDFs alone" };
        Self { about: "directions", choice: choice.to_owned(), because: because.to_owned() }
    }
}
