//! `[[import]]` as it is written.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::light_link::ReceiverName;
use super::shape::TransformEntry;
use super::value::Located;

/// A scene of another program: all of its shapes, materials and lights, besides those of this file. Its picture size and settings are left out.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "Import")]
pub struct ImportEntry {
    /// Path of a `.gltf`, `.glb`, Mitsuba `.xml` or `.pbrt` file, relative to the scene file.
    #[schemars(extend("pattern" = "\\.([gG][lL][tT][fF]|[gG][lL][bB]|[xX][mM][lL])$"))]
    pub file: Located<String>,
    /// The name of the file's camera that stands for `[camera]`; the first one where neither is written.
    pub camera: Option<Located<String>>,
    /// The name of the variant of a glTF's materials that is shown.
    pub variant: Option<Located<String>>,
    /// Steps applied in this order to all of it, or a matrix.
    pub transform: Option<Located<TransformEntry>>,
    /// The imported file's materials, by their names, that materials of this file take the place of.
    #[serde(default)]
    pub materials: BTreeMap<String, Located<String>>,
    /// The group of receivers that all of its shapes belong to, which lamps name in `lights_only` and `lights_all_but`; "rest" when left out.
    pub receiver: Option<Located<ReceiverName>>,
    /// Values of `$key` in a Mitsuba file.
    #[serde(default)]
    pub define: BTreeMap<String, String>,
}
