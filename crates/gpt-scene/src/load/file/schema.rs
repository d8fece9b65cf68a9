//! The JSON Schema of scene files, from the types that read them.

use schemars::transform::{RecursiveTransform, Transform};
use schemars::{Schema, schema_for};
use serde_json::Value;

use super::syntax::SceneFile;

/// The JSON Schema (2020-12) of scene files, as text that ends in a newline. Editors complete and check scene files with it.
pub fn json_schema() -> &'static str {
    include_str!(concat!(env!("GPT_SCENES"), "/scene.schema.json"))
}

/// The schema, made from the types. A test compares the file with it; programs contain the text alone, which
/// is a third of the code that makes it.
pub fn make_json_schema() -> String {
    let mut schema = schema_for!(SceneFile);
    RecursiveTransform(leave_out_null).transform(&mut schema);
    // A schema is a tree of strings, numbers and lists: it can always be written.
    let mut text = serde_json::to_string_pretty(&schema).unwrap_or_default();
    text.push('\n');
    text
}

/// A key that may be left out is an `Option` here, and null is one of its values for schemars. TOML has no null.
fn leave_out_null(schema: &mut Schema) {
    let Some(object) = schema.as_object_mut() else { return };
    if let Some(Value::Array(kinds)) = object.get_mut("type") {
        kinds.retain(|kind| kind != "null");
        if let [kind] = &kinds[..] {
            let kind = kind.clone();
            object.insert("type".to_owned(), kind);
        }
    }
    if let Some(Value::Array(choices)) = object.get_mut("anyOf") {
        choices.retain(|choice| choice["type"] != "null");
        if let [Value::Object(only)] = &choices[..] {
            let only = only.clone();
            object.remove("anyOf");
            object.extend(only);
        }
    }
}
