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
