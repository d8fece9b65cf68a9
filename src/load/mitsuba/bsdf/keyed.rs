//! What the modules of BSDFs hand to each other.

use crate::load::import::{Keys, Value};

/// The BSDFs within another one.
#[derive(Debug, Default)]
pub struct Parts {
    pub names: Vec<Value>,
    /// The map that all of them have.
    pub normal_map: Option<Value>,
}

/// Keys of a material and whether both sides count.
pub type Keyed = (Keys, bool);
