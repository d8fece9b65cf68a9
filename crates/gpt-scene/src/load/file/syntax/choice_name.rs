//! Values that are chosen by name.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{Deserializer, Error};
use serde_json::json;

use crate::choice::{Choice, Named};

/// A value by its name.
#[derive(Debug, Clone, Copy)]
pub struct ChoiceName<T>(pub T);

impl<'de, T: Choice> Deserialize<'de> for ChoiceName<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = Cow::<str>::deserialize(deserializer)?;
        T::from_name(&name).map(Self).ok_or_else(|| D::Error::unknown_variant(&name, T::WORDS))
    }
}

impl<T: Choice> JsonSchema for ChoiceName<T> {
    fn schema_name() -> Cow<'static, str> {
        // Each stands where it is used, so no name is looked up.
        std::any::type_name::<T>().rsplit("::").next().unwrap_or_default().into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let choice = |known: &Named| json!({ "description": known.help(), "type": "string", "const": known.name });
        let choices: Vec<serde_json::Value> = T::NAMES.iter().map(choice).collect();
        json_schema!({ "oneOf": choices })
    }
}
