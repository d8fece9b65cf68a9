//! What the modules of BSDFs hand to each other.

use crate::load::import::{Keys, Value};

/// The BSDFs within another one.
#[derive(Debug, Default)]
pub struct Parts {
    pub names: Vec<Value>,
    /// The map of normals or heights that all of them have, by its keys.
    pub relief: Keys,
}

/// The keys by which a material's normals are bent.
const RELIEF: [&str; 6] = ["normal_map", "normal_scale", "bump_map", "bump_scale", "normal_shadowing", "normal_mirroring"];

/// The keys that bend normals, and the others but the name.
pub fn without_relief(keys: Keys) -> (Keys, Keys) {
    let others = keys.0.into_iter().filter(|(key, _)| *key != "name");
    let (relief, others) = others.partition(|(key, _)| RELIEF.contains(key));
    (Keys(relief), Keys(others))
}

/// A blend's keys with those that bend the normals of all of its parts.
pub fn with_relief(mut keys: Keys, relief: Keys) -> Keys {
    keys.0.extend(relief.0);
    keys
}

/// Keys of a material and whether both sides count.
pub type Keyed = (Keys, bool);
