//! Parameters of a scene: `$key` in its files, `<default>` and the command line's `-D`.

use std::cell::Cell;
use std::collections::HashMap;

use super::plugin::error_at;
use crate::load::error::SceneError;
use crate::load::import::Place;

/// What each key stands for.
pub struct Parameters {
    values: HashMap<String, String>,
    /// Those of the command line, and whether a file asked for them.
    given: Vec<(String, Cell<bool>)>,
}

impl Parameters {
    /// Those of the command line.
    pub fn new(definitions: &[(String, String)]) -> Self {
        Self {
            values: definitions.iter().cloned().collect(),
            given: definitions.iter().map(|(key, _)| (key.clone(), Cell::new(false))).collect(),
        }
    }

    /// A file names a key; it has this value unless it has one.
    pub fn declare(&mut self, key: String, value: String) {
        self.ask_for(&key);
        self.values.entry(key).or_insert(value);
    }

    /// One of the command line that no file asked for.
    pub fn unknown(&self) -> Option<&str> {
        self.given.iter().find(|(_, asked)| !asked.get()).map(|(key, _)| key.as_str())
    }

    fn ask_for(&self, key: &str) {
        self.given.iter().filter(|(given, _)| given == key).for_each(|(_, asked)| asked.set(true));
    }

    /// `$key` stands for the value of the longest parameter whose name follows.
    pub fn filled(&self, place: &Place, text: &str) -> Result<String, SceneError> {
        let mut filled = String::new();
        let mut rest = text;
        while let Some(at) = rest.find('$') {
            filled.push_str(&rest[..at]);
            rest = &rest[at + 1..];
            let fitting = self.values.keys().filter(|key| !key.is_empty() && rest.starts_with(key.as_str()));
            let Some(key) = fitting.max_by_key(|key| key.len()) else {
                let name: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                return Err(
                    error_at(place, format!("nothing says what ${name} is")).with_help(format!("give it by -D {name}=VALUE"))
                );
            };
            self.ask_for(key);
            filled.push_str(&self.values[key]);
            rest = &rest[key.len()..];
        }
        filled.push_str(rest);
        Ok(filled)
    }
}
