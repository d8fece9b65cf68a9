//! TOML text as a tree that remembers where everything is written, and serde's complaints turned into scene errors.

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::reader::{self, Mistake, Node};
use crate::load::error::{MOST_ERRORS, SceneError};
use crate::load::place::Place;

/// The version of the scene format that is read and written.
pub const FORMAT_VERSION: u32 = 1;

/// A scene file's text.
#[derive(Clone)]
pub struct Document<'a> {
    /// How errors call the file.
    pub name: &'a str,
    pub text: &'a str,
    /// The tree that the text was parsed into, if it was: large texts take long.
    tree: Arc<OnceLock<Node<'a>>>,
}

impl<'a> Document<'a> {
    pub fn new(name: &'a str, text: &'a str) -> Self {
        Self { name, text, tree: Arc::default() }
    }

    /// Reads the text into the types of what is written.
    pub fn read<T: DeserializeOwned>(&self) -> Result<T, SceneError> {
        reader::read(self.parsed()?).map_err(|mistake| self.translate(mistake))
    }

    /// The document without its tree, which takes several times the text's memory. The tree is made again
    /// where a mistake is found.
    pub fn without_tree(self) -> Self {
        Self { tree: Arc::default(), ..self }
    }

    /// Reads the text into the types of what is written.
    ///
    /// # Errors
    /// All mistakes of the text, as [`reader::mistakes`] finds them.
    pub fn read_whole<T: DeserializeOwned>(&self) -> Result<T, SceneError> {
        self.check_version()?;
        self.read().map_err(|first| self.all_mistakes::<T>(first))
    }

    /// Refuses a file of a newer version of the format, whose keys may be others.
    fn check_version(&self) -> Result<(), SceneError> {
        let Some(value) = self.root()?.get("version") else { return Ok(()) };
        let version = value.get_ref().as_integer().and_then(|digits| u64::from_str_radix(digits.as_str(), digits.radix()).ok());
        match version.filter(|version| *version > FORMAT_VERSION.into()) {
            None => Ok(()),
            Some(version) => {
                let message = format!(
                    "the file is of version {version} of the scene format, and this gpt reads version {FORMAT_VERSION}: take a newer gpt"
                );
                Err(self.error_in_text(value.span(), message))
            }
        }
    }

    /// All that keeps the text from being read; `first` is what the whole text was refused for.
    fn all_mistakes<T: DeserializeOwned>(&self, first: SceneError) -> SceneError {
        let Ok(root) = self.parsed() else { return first };
        // To find the key of a mistake takes as long as the text is: no more mistakes are translated than are reported.
        let mistakes = reader::mistakes::<T>(root).into_iter().take(MOST_ERRORS);
        SceneError::of_all(mistakes.map(|mistake| self.translate(mistake)).collect()).unwrap_or(first)
    }

    /// An error about what is stated at a place.
    pub fn error(&self, place: &Place, message: impl Into<String>) -> SceneError {
        match place {
            Place::Text { .. } => self.error_in_text(place.span(), message),
            Place::Imported(origin) => origin.error(message),
        }
    }

    /// An error about the value written at `span`.
    fn error_in_text(&self, span: Range<usize>, message: impl Into<String>) -> SceneError {
        let key = self.key_at(&span);
        SceneError::in_text(self.name, self.text, span, message).with_key(key)
    }

    fn parsed(&self) -> Result<&Node<'a>, SceneError> {
        if let Some(tree) = self.tree.get() {
            return Ok(tree);
        }
        let root = DeTable::parse(self.text).map_err(|error| self.syntax_error(&error))?;
        Ok(self.tree.get_or_init(|| Spanned::new(root.span(), DeValue::Table(root.into_inner()))))
    }

    /// The table of the whole text.
    pub fn root(&self) -> Result<&DeTable<'a>, SceneError> {
        self.parsed()?.get_ref().as_table().ok_or_else(|| SceneError::in_file(self.name, "the file is no table"))
    }

    /// A text that does not parse has no tree, in which the key would be looked up.
    fn syntax_error(&self, error: &toml::de::Error) -> SceneError {
        let span = error.span().unwrap_or(0..self.text.len().min(1));
        let message = match error.message() {
            "duplicate key" => format!("duplicate key `{}`", self.text.get(span.clone()).unwrap_or_default()),
            other => other.to_owned(),
        };
        SceneError::in_text(self.name, self.text, span, message)
    }

    fn translate(&self, mistake: Mistake) -> SceneError {
        let span = mistake.span.unwrap_or(0..self.text.len().min(1));
        let located = self.error_in_text(span, mistake.message);
        match mistake.help {
            Some(help) => located.with_help(help),
            None => located,
        }
    }

    /// The place of a key's value in a table at the top; no bytes where it is not written.
    pub fn place_of(&self, table: &str, key: &str) -> Place {
        let Ok(root) = self.root() else { return Place::default() };
        let value = root.get(table).and_then(|table| table.get_ref().get(key));
        value.map_or_else(Place::default, |value| value.span().into())
    }

    /// The dotted path of the innermost key or value around `span`; empty at the top.
    fn key_at(&self, span: &Range<usize>) -> String {
        let Ok(root) = self.root() else { return String::new() };
        let mut innermost = Innermost { wanted: span, path: String::new(), width: usize::MAX };
        innermost.search_table(root, "");
        innermost.path
    }
}

/// Looks for the narrowest key or value that contains a span.
struct Innermost<'s> {
    wanted: &'s Range<usize>,
    path: String,
    width: usize,
}

impl Innermost<'_> {
    fn search_table(&mut self, table: &DeTable, path: &str) {
        for (key, value) in table {
            let dot = if path.is_empty() { "" } else { "." };
            let path = format!("{path}{dot}{}", key.get_ref());
            self.consider(&key.span(), &path);
            self.search_value(value, &path);
        }
    }

    fn search_value(&mut self, value: &Spanned<DeValue>, path: &str) {
        self.consider(&value.span(), path);
        match value.get_ref() {
            DeValue::Table(table) => self.search_table(table, path),
            DeValue::Array(items) => {
                for (index, item) in items.iter().enumerate() {
                    // Numbers of long arrays are not named one by one: only what can contain the span is looked at.
                    if matches!(item.get_ref(), DeValue::Table(_)) || contains(&item.span(), self.wanted) {
                        self.search_value(item, &format!("{path}[{index}]"));
                    }
                }
            }
            _ => {}
        }
    }

    fn consider(&mut self, span: &Range<usize>, path: &str) {
        let width = span.end - span.start;
        if contains(span, self.wanted) && width <= self.width {
            self.width = width;
            self.path = path.to_owned();
        }
    }
}

fn contains(outer: &Range<usize>, inner: &Range<usize>) -> bool {
    outer.start <= inner.start && inner.end <= outer.end
}

/// A file's name without folder and ending.
pub fn stem(name: &str) -> String {
    let path = std::path::Path::new(name);
    path.file_stem().map_or_else(|| name.to_owned(), |stem| stem.to_string_lossy().into_owned())
}
