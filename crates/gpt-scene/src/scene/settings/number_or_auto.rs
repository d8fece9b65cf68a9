//! A number, or left to be measured.

use serde::{Serialize, Serializer};

use super::value::{Field, Value};
use crate::choice::Named;

/// A number that a setting states, or that a trial run of some thousand paths finds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NumberOrAuto {
    /// The number that a trial run finds best, or a fixed default.
    Auto,
    /// So many.
    Number(u32),
}

/// The name that stands for [`NumberOrAuto::Auto`], with what it means for a setting.
pub(super) const fn auto(doc: &'static str) -> Named {
    Named { name: "auto", doc }
}

impl From<u32> for NumberOrAuto {
    fn from(number: u32) -> Self {
        Self::Number(number)
    }
}

impl Field for NumberOrAuto {
    fn to_value(self) -> Value {
        match self {
            Self::Auto => Value::Name(auto("").name),
            Self::Number(number) => Value::Number(number),
        }
    }

    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Number(number) => Some(Self::Number(number)),
            Value::Name(name) => (name == auto("").name).then_some(Self::Auto),
            Value::Real(_) => None,
        }
    }
}

impl Serialize for NumberOrAuto {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.to_value().serialize(serializer)
    }
}
