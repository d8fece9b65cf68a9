//! `[output]`: what is written beside the picture.

use std::borrow::Cow;
use std::sync::LazyLock;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{Deserializer, Error};
use serde_json::json;

use crate::choice::Choice;
use crate::layer::Layer;

/// Files written beside the picture. Command-line flags override these.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct OutputTable {
    /// Layers that .exr files hold beside the picture; none when left out.
    #[serde(default)]
    pub aov: Vec<LayerName>,
}

static LAYER_NAMES: LazyLock<Vec<&'static str>> = LazyLock::new(|| Layer::NAMES.iter().map(|known| known.name).collect());

/// A layer by the name that `--aov` has for it.
#[derive(Debug, Clone, Copy)]
pub struct LayerName(pub Layer);

impl<'de> Deserialize<'de> for LayerName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = Cow::<str>::deserialize(deserializer)?;
        Layer::from_name(&name).map(Self).ok_or_else(|| D::Error::unknown_variant(&name, &LAYER_NAMES))
    }
}

impl JsonSchema for LayerName {
    fn schema_name() -> Cow<'static, str> {
        "LayerName".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let choice = |known: &crate::choice::Named| json!({ "description": known.help(), "type": "string", "const": known.name });
        let choices: Vec<serde_json::Value> = Layer::NAMES.iter().map(choice).collect();
        json_schema!({ "oneOf": choices })
    }
}
