//! A description as the text of a scene file.

use super::description::{Description, Entry};
use super::keys::{FileReference, Keys, Value};
use crate::load::place::Origin;
use crate::load::toml_text::{line, list, number, table, text};

/// Text of a scene file, and what its parts were made from.
#[derive(Debug, Default)]
pub struct Text {
    pub text: String,
    /// In the order of the text.
    pub origins: Vec<PlacedText>,
}

/// From this byte on, up to the next origin, the text was made from what stands there.
#[derive(Debug, Clone)]
pub struct PlacedText {
    pub start: usize,
    pub place: Origin,
}

impl Text {
    /// Appends the description. `file_name` says how files are written.
    pub fn push(&mut self, description: &Description, file_name: &dyn Fn(&FileReference) -> String) {
        let whole = Origin::default();
        for (name, keys) in [("film", &description.film), ("render", &description.render)] {
            if !keys.is_empty() {
                self.table(&format!("[{name}]"), &whole, keys, file_name);
            }
        }
        if let Some(camera) = &description.camera {
            self.entry("[camera]", camera, file_name);
        }
        let mut lists = |lists: &[(&str, &Vec<Entry>)]| {
            for (heading, entries) in lists {
                for entry in *entries {
                    self.entry(heading, entry, file_name);
                }
            }
        };
        lists(&[
            ("[[node]]", &description.nodes),
            ("[[texture]]", &description.textures),
            ("[[material]]", &description.materials),
            ("[[shape]]", &description.shapes),
        ]);
        for group in &description.groups {
            self.table("[[group]]", &group.place, &Keys::new().with("name", group.name.as_str()), file_name);
            for shape in &group.shapes {
                self.entry("[[group.shape]]", shape, file_name);
            }
        }
        for (heading, entries) in [("[[instance]]", &description.instances), ("[[light]]", &description.lights)] {
            for entry in entries {
                self.entry(heading, entry, file_name);
            }
        }
    }

    fn entry(&mut self, heading: &str, entry: &Entry, file_name: &dyn Fn(&FileReference) -> String) {
        self.table(heading, &entry.place, &entry.keys, file_name);
    }

    fn table(&mut self, heading: &str, place: &Origin, keys: &Keys, file_name: &dyn Fn(&FileReference) -> String) {
        if !self.text.is_empty() {
            self.text.push('\n');
        }
        self.origins.push(PlacedText { start: self.text.len(), place: place.clone() });
        self.text.push_str(heading);
        self.text.push('\n');
        for (key, value) in &keys.0 {
            self.text.push_str(&line(key, &written(value, file_name)));
        }
    }
}

/// A value as a scene file has it.
fn written(value: &Value, file_name: &dyn Fn(&FileReference) -> String) -> String {
    match value {
        Value::Number(value) => number(*value),
        Value::Integer(value) => value.to_string(),
        Value::Flag(flag) => flag.to_string(),
        Value::Text(value) => text(value),
        Value::File(file) => text(&file_name(file)),
        Value::List(values) => list(values.iter().map(|value| written(value, file_name))),
        Value::Table(keys) => table(keys.0.iter().map(|(key, value)| (*key, written(value, file_name)))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_come_back_the_same() {
        let numbers = [0.1, -0.0, 5.0];
        let keys = Keys::new().with("numbers", super::super::list(numbers)).with("text", "a \"b\"");
        let description = Description { render: keys, ..Description::default() };
        let mut text = Text::default();
        text.push(&description, &|_| String::new());
        let read: toml::Table = text.text.parse().expect("it is TOML");
        let read = read["render"].as_table().expect("a table");
        assert_eq!(read["text"].as_str(), Some("a \"b\""));
        let back = read["numbers"].as_array().expect("a list").iter();
        let back: Vec<u64> =
            back.map(|number| number.as_float().unwrap_or_else(|| number.as_integer().unwrap_or(0) as f64).to_bits()).collect();
        assert_eq!(back, numbers.map(f64::to_bits));
    }
}
