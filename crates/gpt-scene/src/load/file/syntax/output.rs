//! `[output]`: what is written beside the picture.

use schemars::JsonSchema;
use serde::Deserialize;

use super::choice_name::ChoiceName;
use crate::layer::Layer;

/// Files written beside the picture. Command-line flags override these.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct OutputTable {
    /// Layers that .exr files hold beside the picture; none when left out.
    #[serde(default)]
    pub aov: Vec<ChoiceName<Layer>>,
}
