//! `[[node]]` as it is written.

use schemars::JsonSchema;
use serde::Deserialize;

use super::keyframes::{InterpolationName, TransformKeyEntry};
use super::shape::TransformEntry;
use super::value::Located;

/// A frame of reference that takes along the shapes and the camera that name it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "Node", extend("dependentRequired" = { "interpolation": ["keyframes"] }))]
pub struct NodeEntry {
    #[schemars(extend("minLength" = 1))]
    pub name: Located<String>,
    /// The node that takes this one along.
    pub parent: Option<Located<String>>,
    /// Transform in its parent without a frame: objects that name the node are moved by the change from
    /// there.
    pub transform: Option<Located<TransformEntry>>,
    /// Transforms in its parent at frames, in place of `transform`.
    #[schemars(extend("minItems" = 1))]
    pub keyframes: Option<Located<Vec<Located<TransformKeyEntry>>>>,
    /// How keyframes lead from one to the next; "linear" when left out.
    pub interpolation: Option<Located<InterpolationName>>,
}
