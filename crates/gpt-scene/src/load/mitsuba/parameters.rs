//! Parameters of a scene: `$key` in its files, `<default>` and the command line's `-D`.

use std::cell::Cell;
use std::collections::{BTreeSet, HashMap};

use super::plugin::error_at;
use crate::load::error::SceneError;
use crate::load::place::Origin;

/// Most bytes that an attribute has once its parameters are filled in, and all of them together. Parameters may stand for others, each for two, and
/// so on: a page of them would be more text than there is memory.
const MOST_FILLED: usize = 1 << 20;
const MOST_FILLED_IN_ALL: usize = 1 << 26;

/// Values of the keys.
pub struct Parameters {
    values: HashMap<String, String>,
    /// The lengths of all keys, so that the longest one that fits is found without a look at each.
    lengths: BTreeSet<usize>,
    /// Definitions on the command line, and whether a file asked for each.
    given: Vec<(String, Cell<bool>)>,
    /// Bytes that were filled in so far.
    filled: Cell<usize>,
}

impl Parameters {
    /// Parameters with the definitions of the command line.
    pub fn new(definitions: &[(String, String)]) -> Self {
        let mut parameters = Self {
            values: HashMap::new(),
            lengths: BTreeSet::new(),
            given: definitions.iter().map(|(key, _)| (key.clone(), Cell::new(false))).collect(),
            filled: Cell::new(0),
        };
        definitions.iter().for_each(|(key, value)| {
            // The last one counts.
            parameters.values.remove(key);
            parameters.enter(key.clone(), value.clone());
        });
        parameters
    }

    /// A file names a key; it has this value unless it has one.
    pub fn declare(&mut self, key: String, value: String) {
        self.ask_for(&key);
        self.enter(key, value);
    }

    fn enter(&mut self, key: String, value: String) {
        if !key.is_empty() {
            self.lengths.insert(key.len());
        }
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
    ///
    /// # Errors
    /// A key without a value, and a text that becomes too long.
    pub fn filled(&self, place: &Origin, text: &str) -> Result<String, SceneError> {
        let mut filled = String::new();
        let mut rest = text;
        while let Some(at) = rest.find('$') {
            filled.push_str(&rest[..at]);
            rest = &rest[at + 1..];
            let mut fitting = self.lengths.iter().rev().filter_map(|length| self.values.get_key_value(rest.get(..*length)?));
            let Some((key, value)) = fitting.next() else {
                let name: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                return Err(
                    error_at(place, format!("nothing says what ${name} is")).with_help(format!("give it by -D {name}=VALUE"))
                );
            };
            self.ask_for(key);
            self.filled.set(self.filled.get() + value.len());
            if filled.len() + value.len() > MOST_FILLED || self.filled.get() > MOST_FILLED_IN_ALL {
                let message = format!(
                    "with ${key} filled in, the text is longer than the {} KiB that an attribute may have, or all of them than {} MiB",
                    MOST_FILLED >> 10,
                    MOST_FILLED_IN_ALL >> 20
                );
                return Err(error_at(place, message));
            }
            filled.push_str(value);
            rest = &rest[key.len()..];
        }
        filled.push_str(rest);
        Ok(filled)
    }
}
