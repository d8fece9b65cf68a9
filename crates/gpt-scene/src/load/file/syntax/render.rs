//! `[render]`, read and described by the table of settings.

use std::borrow::Cow;
use std::fmt;
use std::sync::LazyLock;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, DeserializeSeed, Deserializer, Error, MapAccess, Unexpected, Visitor};
use serde_json::{Map, json};

use crate::scene::settings::{Assignment, SETTINGS, Setting, Values};

/// Content of `[render]`.
#[derive(Debug, Clone, Default)]
pub struct RenderTable(pub Vec<Assignment>);

impl RenderTable {
    /// Sets a setting to a number or a name, as text.
    ///
    /// # Errors
    /// A sentence about a value that the setting cannot have.
    pub fn set(&mut self, name: &'static str, value: &str) -> Result<(), String> {
        let setting = Setting::find(name).ok_or_else(|| format!("there is no setting `{name}`"))?;
        let assignment = setting.text(value).map_err(|expected| format!("`{name}`: expected {expected}, found {value}"))?;
        self.0.push(assignment);
        Ok(())
    }
}

impl<'de> Deserialize<'de> for RenderTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(TableVisitor).map(Self)
    }
}

struct TableVisitor;

impl<'de> Visitor<'de> for TableVisitor {
    type Value = Vec<Assignment>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a table")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut written = Vec::new();
        while let Some(setting) = map.next_key_seed(Key)? {
            written.push(map.next_value_seed(Written(setting))?);
        }
        Ok(written)
    }
}

/// Reads a setting's name.
struct Key;

impl<'de> DeserializeSeed<'de> for Key {
    type Value = &'static Setting;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

impl Visitor<'_> for Key {
    type Value = &'static Setting;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a setting")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<Self::Value, E> {
        Setting::find(name).ok_or_else(|| E::unknown_field(name, &SETTING_NAMES))
    }
}

/// Reads a value of this setting.
struct Written(&'static Setting);

impl<'de> DeserializeSeed<'de> for Written {
    type Value = Assignment;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl Visitor<'_> for Written {
    type Value = Assignment;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}", self.0.values)
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Self::Value, E> {
        let wrong = match self.0.values {
            Values::Whole(..) | Values::WholeOr(..) | Values::Real(..) => E::invalid_value,
            Values::Names(_) => E::invalid_type,
        };
        self.0.number(number).map_err(|expected| wrong(Unexpected::Signed(number), &expected.as_str()))
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Self::Value, E> {
        let wrong = match self.0.values {
            Values::Real(..) => E::invalid_value,
            Values::Whole(..) | Values::WholeOr(..) | Values::Names(_) => E::invalid_type,
        };
        self.0.real(number).map_err(|expected| wrong(Unexpected::Float(number), &expected.as_str()))
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<Self::Value, E> {
        self.0.name(name).map_err(|expected| match self.0.values {
            Values::Names(_) => E::unknown_variant(name, choices(self.0)),
            Values::WholeOr(..) => E::invalid_value(Unexpected::Str(name), &expected.as_str()),
            Values::Whole(..) | Values::Real(..) => E::invalid_type(Unexpected::Str(name), &expected.as_str()),
        })
    }
}

static SETTING_NAMES: LazyLock<Vec<&'static str>> = LazyLock::new(|| SETTINGS.iter().map(|setting| setting.name).collect());

/// The names of all values of settings that have names, in the order of the settings.
static CHOICES: LazyLock<Vec<Vec<&'static str>>> = LazyLock::new(|| {
    let names = |values: &Values| {
        if let Values::Names(names) = values { names.iter().map(|name| name.name).collect() } else { Vec::new() }
    };
    SETTINGS.iter().map(|setting| names(&setting.values)).collect()
});

/// The names of a setting's values.
fn choices(setting: &Setting) -> &'static [&'static str] {
    SETTING_NAMES.iter().position(|name| *name == setting.name).map_or(&[], |index| &CHOICES[index])
}

impl JsonSchema for RenderTable {
    fn schema_name() -> Cow<'static, str> {
        "RenderTable".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let properties: Map<String, serde_json::Value> =
            SETTINGS.iter().map(|setting| (setting.name.to_owned(), grouped_property(setting))).collect();
        json_schema!({
            "description": "How radiance is estimated. Command-line flags override these.",
            "type": "object",
            "properties": properties,
            "additionalProperties": false,
        })
    }
}

/// The property; settings that serve comparison alone say so, for the page that is made of the schema.
fn grouped_property(setting: &Setting) -> serde_json::Value {
    let mut property = property(setting);
    if setting.study {
        property[GROUP] = "study".into();
    }
    property
}

/// The key of a property that names its group.
const GROUP: &str = "x-group";

fn property(setting: &Setting) -> serde_json::Value {
    let description = setting.help();
    let default = setting.default();
    match setting.values {
        Values::Whole(least, most) => json!({
            "description": description, "type": "integer", "minimum": least, "maximum": most, "default": default,
        }),
        Values::WholeOr(least, most, name) => json!({
            "description": description, "default": default, "oneOf": [
                { "description": "So many.", "type": "integer", "minimum": least, "maximum": most },
                { "description": name.help(), "type": "string", "const": name.name },
            ],
        }),
        Values::Real(least, most) => json!({
            "description": description, "type": "number", "minimum": least, "maximum": most, "default": default,
        }),
        Values::Names(names) => {
            let choices: Vec<serde_json::Value> =
                names.iter().map(|name| json!({ "description": name.help(), "type": "string", "const": name.name })).collect();
            json!({ "description": description, "oneOf": choices, "default": default })
        }
    }
}
