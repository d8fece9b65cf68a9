//! The key `light_group`, by which emitters name the group that their light is in.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error;
use serde::{Deserialize, Deserializer};

use super::resolver::Resolver;
use super::value::Located;
use super::writer::{Writer, line, text};
use crate::load::error::SceneError;
use crate::scene::light_groups::{LightGroupId, check_group_name};

/// The name of a light group.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LightGroupName(pub String);

impl<'de> Deserialize<'de> for LightGroupName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        check_group_name(&name).map_err(D::Error::custom)?;
        Ok(Self(name))
    }
}

impl JsonSchema for LightGroupName {
    fn schema_name() -> Cow<'static, str> {
        "LightGroupName".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string", "pattern": "^[a-z][A-Za-z0-9_-]{0,30}$" })
    }
}

impl Resolver<'_> {
    /// The number of the group that an emitter names; that of the rest where it names none.
    pub(super) fn light_group(&mut self, written: Option<&Located<LightGroupName>>) -> Result<LightGroupId, SceneError> {
        let Some(written) = written else { return Ok(0) };
        let number = self.scene.light_groups.named(&written.value.0);
        number.map_err(|message| self.error(&written.place, message))
    }

    /// That of an emitter which has to give light.
    pub(super) fn light_group_of(
        &mut self,
        written: Option<&Located<LightGroupName>>,
        gives_light: bool,
        help: &str,
    ) -> Result<LightGroupId, SceneError> {
        if let Some(written) = written.filter(|_| !gives_light) {
            return Err(self.error(&written.place, format!("`light_group` is of what gives light: {help}")));
        }
        self.light_group(written)
    }
}

/// The line of a group, as a scene file has it; nothing for that of the rest.
pub fn write_light_group(group: LightGroupId, writer: &Writer<'_>) -> String {
    if group == 0 { String::new() } else { line("light_group", &text(writer.scene.light_groups.name(group))) }
}
