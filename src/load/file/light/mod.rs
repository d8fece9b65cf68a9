//! `[[light]]`: a file for each light that is not a surface, with the keys it is written by.

use schemars::JsonSchema;
use serde::Deserialize;

use super::resolver::Resolver;
use super::value::Located;
use crate::load::error::SceneError;
use crate::scene::Light;
use crate::scene::light::light_table;

/// The entries of a scene file, by the rows of the table of lights.
macro_rules! entries {
    ($($group:ident { $($variant:ident($type:ident) $module:ident $switch:literal,)* })*) => {
        $($(mod $module;)*)*

        /// A light that is not a surface. Surfaces emit through their material.
        #[derive(Debug, Deserialize, JsonSchema)]
        #[serde(rename_all = "snake_case")]
        #[schemars(tag = "type")]
        pub enum LightEntry {
            $($($variant($module::Keys),)*)*
        }

        impl Located<LightEntry> {
            fn resolve(&self, resolver: &mut Resolver<'_>) -> Result<Light, SceneError> {
                match &self.value {
                    $($(LightEntry::$variant(keys) => keys.resolve(resolver, &self.span).map(Light::$variant),)*)*
                }
            }
        }
    };
}
light_table!(entries);

impl Resolver<'_> {
    pub(super) fn lights(&mut self, written: &[Located<LightEntry>]) -> Result<(), SceneError> {
        for entry in written {
            let light = entry.resolve(self)?;
            if light.is_environment() && self.scene.lights.iter().any(Light::is_environment) {
                return Err(self.error(&entry.span, "a scene has one environment or sky, this is the second"));
            }
            self.scene.lights.push(light);
        }
        Ok(())
    }
}
