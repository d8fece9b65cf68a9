//! From a scene to finished bands: which renderer takes it, and how long it goes on.

pub mod choice;
pub mod progressive;
