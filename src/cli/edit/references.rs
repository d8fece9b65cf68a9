//! Keys of scene files that name other entries. The schema says that they are texts; this table says what they name.

/// A key, and the list of the scene in which what it names stands.
pub const REFERENCES: [(&str, &str); 9] = [
    ("materials", "material"),
    ("interfaces", "material"),
    ("texture", "texture"),
    ("normal_map", "texture"),
    ("bump_map", "texture"),
    ("coat_normal_map", "texture"),
    ("anisotropy_direction", "texture"),
    ("interior", "medium"),
    ("medium", "medium"),
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use serde_json::Value;

    use super::*;

    /// Texts that name no entry.
    const OTHER_TEXTS: [&str; 3] = ["name", "file", "grid"];

    /// Notes the keys whose values are free texts, or lists of them.
    fn free_texts(node: &Value, definitions: &Value, seen: &mut BTreeSet<String>, keys: &mut BTreeSet<String>) {
        let is_free =
            |node: &Value| node["type"] == "string" && ["const", "enum", "pattern"].iter().all(|limit| node.get(limit).is_none());
        let resolved = |node: &Value| {
            let name = node["$ref"].as_str().and_then(|reference| reference.rsplit('/').next());
            name.map_or_else(|| node.clone(), |name| definitions[name].clone())
        };
        if let Some(properties) = node["properties"].as_object() {
            for (key, property) in properties {
                let property = resolved(property);
                if is_free(&property) || is_free(&property["items"]) {
                    keys.insert(key.clone());
                }
            }
        }
        if let Some(reference) = node["$ref"].as_str()
            && seen.insert(reference.to_owned())
        {
            free_texts(&resolved(node), definitions, seen, keys);
        }
        let children: Vec<&Value> = match node {
            Value::Object(fields) => fields.values().collect(),
            Value::Array(items) => items.iter().collect(),
            _ => Vec::new(),
        };
        for child in children {
            free_texts(child, definitions, seen, keys);
        }
    }

    #[test]
    fn every_key_that_is_a_text_names_an_entry_or_is_known_to_name_none() {
        let schema: Value = serde_json::from_str(gpt::load::json_schema()).expect("the schema is JSON");
        let (mut seen, mut keys) = Default::default();
        for entry in ["MaterialEntry", "MediumEntry"] {
            free_texts(&schema["$defs"][entry], &schema["$defs"], &mut seen, &mut keys);
        }
        let known = REFERENCES.iter().map(|(key, _)| *key).chain(OTHER_TEXTS).map(str::to_owned);
        assert_eq!(keys, known.collect());
        assert!(REFERENCES.iter().all(|(_, list)| schema["properties"].get(list).is_some()));
    }
}
