//! Reasons of the choices that learning makes.

/// Why settings are what they are; None where the scene states them, or where nothing was tried.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Reasons {
    /// The reason for the way in which lights are chosen.
    pub light_choice: Option<String>,
    /// The reason for the number of light samples.
    pub light_samples: Option<String>,
    /// The reason why directions are drawn by a guide, or are not, where the scene asks for one.
    pub directions: Option<String>,
    /// The reason why no trial run was made, where paths take too much work.
    pub left_out: Option<String>,
}
