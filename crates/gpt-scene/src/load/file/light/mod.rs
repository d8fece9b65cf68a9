//! `[[light]]`: a file for each light that is not a surface, with the keys it is written by.

pub mod daylight;
pub mod directional;
pub mod environment;
mod keys;
pub mod point;
pub mod profile;
pub mod projector;
pub mod sky;
pub mod spot;

use std::sync::Arc;

use schemars::JsonSchema;
use serde::Deserialize;

use self::keys::LightKeys;
use super::light_group::LightGroupName;
use super::light_link::WrittenLink;
use super::reference::TextureName;
use super::resolver::Resolver;
use super::value::Located;
use super::writer::Writer;
use crate::load::error::SceneError;
use crate::scene::Light;
use crate::scene::animation::LightTrack;
use crate::scene::light::light_table;
use crate::scene::light_links::LinkMask;

/// The entries of a scene file, by the rows of the table of lights.
macro_rules! entries {
    ($($group:ident { $($variant:ident($type:ident) $module:ident $switch:ident $($needed:ident)*,)* })*) => {
        /// A light that is not a surface. Surfaces emit through their material.
        #[derive(Debug, Clone, Deserialize, JsonSchema)]
        #[serde(rename = "key:type", rename_all = "snake_case")]
        #[schemars(tag = "type", rename = "LightEntry")]
        pub enum LightEntry {
            $($($variant($module::Keys),)*)*
        }

        /// Each type with its group, and tables of it without `type`.
        const EXAMPLES: &[(&str, &str, &[&str])] = &[$($((stringify!($group), stringify!($module), $module::Keys::EXAMPLES),)*)*];

        /// The key by which keyframes state how strong a light is.
        pub fn strength_key(light: &Light) -> &'static str {
            match light { $($(Light::$variant(_) => $module::Keys::STRENGTH,)*)* }
        }

        impl LightEntry {
            /// The group that its light is in.
            fn light_group(&self) -> Option<&Located<LightGroupName>> {
                match self { $($(Self::$variant(keys) => keys.light_group.as_ref(),)*)* }
            }

            /// The keys that say what it lights.
            fn link(&self) -> WrittenLink<'_> {
                match self { $($(Self::$variant(keys) => WrittenLink { only: keys.lights_only.as_ref(), all_but: keys.lights_all_but.as_ref() },)*)* }
            }
        }

        impl Located<LightEntry> {
            fn resolve(&self, resolver: &mut Resolver<'_>) -> Result<Light, SceneError> {
                match &self.value {
                    $($(LightEntry::$variant(keys) => keys.resolve(resolver, &self.place).map(Light::$variant),)*)*
                }
            }
        }

        impl LightEntry {
            fn track(&self, resolver: &Resolver<'_>) -> Result<Option<LightTrack>, SceneError> {
                match self {
                    $($(LightEntry::$variant(keys) => keys.track(resolver),)*)*
                }
            }
        }

        /// The keys of a light, as a scene file has them.
        pub fn write_light(light: &Light, writer: &mut Writer<'_>) -> String {
            match light { $($(Light::$variant(light) => $module::Keys::write(light, writer),)*)* }
        }
    };
}
light_table!(entries);

impl LightEntry {
    pub fn is_environment(&self) -> bool {
        matches!(self, Self::Environment(_) | Self::Sky(_))
    }

    /// The sun of a sky, as a light of its own.
    fn sun(&self, resolver: &Resolver<'_>, light: &Light) -> Option<Light> {
        match (self, light) {
            (Self::Environment(keys), Light::Environment(environment)) => keys.sun(resolver, environment).map(Light::Directional),
            _ => None,
        }
    }

    /// The node that takes the light along; None of lights without a place.
    pub fn node_mut(&mut self) -> Option<&mut Option<Located<String>>> {
        match self {
            Self::Point(keys) => Some(&mut keys.node),
            Self::Spot(keys) => Some(&mut keys.node),
            Self::Directional(keys) => Some(&mut keys.node),
            Self::Environment(_) | Self::Sky(_) | Self::Projector(_) => None,
        }
    }

    /// The texture whose picture the light projects; None of lights that project none.
    pub fn texture_mut(&mut self) -> Option<&mut Located<TextureName>> {
        match self {
            Self::Spot(keys) => keys.texture.as_mut(),
            Self::Projector(keys) => keys.texture.as_mut(),
            Self::Environment(_) | Self::Sky(_) | Self::Point(_) | Self::Directional(_) => None,
        }
    }
}

/// Name of the type, and keys as TOML, of examples of every light.
pub fn examples() -> impl Iterator<Item = (&'static str, String)> {
    ["environment", "delta"].into_iter().flat_map(examples_of)
}

/// Examples of a group of the table of lights.
pub fn examples_of(group: &str) -> impl Iterator<Item = (&'static str, String)> {
    let of_type = |&(_, name, examples): &(&'static str, &'static str, &'static [&'static str])| {
        examples.iter().map(move |keys| (name, format!("[[light]]\ntype = \"{name}\"\n{keys}\n")))
    };
    EXAMPLES.iter().filter(move |(of, _, _)| *of == group).flat_map(of_type)
}

impl Resolver<'_> {
    pub(super) fn lights(&mut self, written: &[Located<LightEntry>]) {
        for entry in written {
            let light = entry.resolve(self).and_then(|light| {
                if light.is_environment() && self.scene.lights.iter().any(Light::is_environment) {
                    return Err(self.error(&entry.place, "a scene has one environment or sky, this is the second"));
                }
                Ok(light)
            });
            let track = entry.value.track(self);
            let track = self.note(track).flatten();
            Arc::make_mut(&mut self.scene.animation).lights.extend(track);
            let light = self.note(light);
            let sun = light.as_ref().and_then(|light| entry.value.sun(self, light));
            let group = self.light_group(entry.value.light_group());
            let group = self.note(group).unwrap_or(0);
            let link = self.link_mask(entry.value.link());
            let link = self.note(link).unwrap_or(LinkMask::ALL);
            for light in light.into_iter().chain(sun) {
                self.scene.light_groups.put_light(self.scene.lights.len(), group);
                self.scene.light_links.put_light(self.scene.lights.len(), link);
                self.scene.lights.push(light);
            }
        }
    }
}
