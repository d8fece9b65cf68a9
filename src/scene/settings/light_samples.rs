//! The number of light samples: a number, or left to be measured.

use serde::{Serialize, Serializer};

use super::value::{Field, Value};
use crate::choice::Named;

/// How many light samples a path's first surfaces take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LightSamples {
    /// As many as a pilot of some thousand paths finds best, and at as many surfaces.
    Auto,
    /// So many.
    Count(u32),
}

impl LightSamples {
    pub(super) const AUTO: Named =
        Named { name: "auto", doc: "As many as a pilot of some thousand paths finds best, and at as many surfaces." };
}

impl From<u32> for LightSamples {
    fn from(count: u32) -> Self {
        Self::Count(count)
    }
}

impl Field for LightSamples {
    fn to_value(self) -> Value {
        match self {
            Self::Auto => Value::Name(Self::AUTO.name),
            Self::Count(count) => Value::Number(count),
        }
    }

    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Number(count) => Some(Self::Count(count)),
            Value::Name(name) => (name == Self::AUTO.name).then_some(Self::Auto),
            Value::Real(_) => None,
        }
    }
}

impl Serialize for LightSamples {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.to_value().serialize(serializer)
    }
}
