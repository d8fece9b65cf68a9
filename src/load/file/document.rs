//! TOML text as a tree that remembers where everything is written, and serde's complaints turned into scene errors.

use std::ops::Range;

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::wording;
use crate::load::error::{MOST_ERRORS, SceneError};
use crate::load::import::Origin;

/// Keys at the top whose values are lists of tables of several types.
const LISTS: [&str; 4] = ["texture", "material", "shape", "light"];
/// Such keys whose tables are all of one type.
const PLAIN_LISTS: [&str; 2] = ["group", "instance"];

/// A scene file's text.
#[derive(Clone, Copy)]
pub struct Document<'a> {
    /// How errors call the file.
    pub name: &'a str,
    pub text: &'a str,
    /// What parts of the text were made from, where no person wrote it.
    pub origins: &'a [Origin],
}

impl<'a> Document<'a> {
    /// Reads the text into the types of what is written.
    pub fn read<T: DeserializeOwned>(self) -> Result<T, SceneError> {
        let mut root = self.parse()?;
        self.name_variants(root.get_mut())?;
        T::deserialize(toml::Deserializer::from(root)).map_err(|error| self.translate(&error))
    }

    /// Reads one key of the text, and nothing else.
    pub fn read_key<T: DeserializeOwned>(self, key: &str) -> Result<T, SceneError> {
        let mut alone = Spanned::new(0..self.text.len(), DeTable::new());
        for (name, value) in self.parse()?.into_inner() {
            if name.get_ref() == key {
                alone.get_mut().insert(name, value);
            }
        }
        T::deserialize(toml::Deserializer::from(alone)).map_err(|error| self.translate(&error))
    }

    /// All that keeps the text from being read, of each table and each entry of a list the first mistake. `first` is what the whole text was
    /// refused for; `Part` is a file of which anything may be missing.
    pub fn all_mistakes<Part: DeserializeOwned>(self, first: SceneError) -> SceneError {
        let Ok(root) = self.parse() else { return first };
        let mut parts = Vec::new();
        for (key, value) in root.into_inner() {
            let is_list = LISTS.iter().chain(&PLAIN_LISTS).any(|list| key.get_ref() == list);
            let span = value.span();
            match value.into_inner() {
                DeValue::Array(entries) if is_list => parts.extend(entries.into_iter().map(|entry| {
                    let at = entry.span().start;
                    (at, key.clone(), Spanned::new(span.clone(), DeValue::Array([entry].into_iter().collect())))
                })),
                value => parts.push((span.start, key, Spanned::new(span, value))),
            }
        }
        // In the order of the file, and no more than are told: finding the place of each takes as long as reading the file does.
        parts.sort_by_key(|(at, ..)| *at);
        let mistakes = parts.into_iter().filter_map(|(_, key, part)| {
            let mut alone = Spanned::new(0..self.text.len(), DeTable::new());
            alone.get_mut().insert(key, part);
            let named = self.name_variants(alone.get_mut());
            named.and_then(|()| Part::deserialize(toml::Deserializer::from(alone)).map_err(|error| self.translate(&error))).err()
        });
        let mut found: Vec<SceneError> = mistakes.take(MOST_ERRORS).collect();
        found.push(first.clone());
        SceneError::of_all(found).unwrap_or(first)
    }

    /// An error about the value written at `span`.
    pub fn error(self, span: Range<usize>, message: impl Into<String>) -> SceneError {
        if let Some(origin) = self.origin_at(span.start) {
            let error = match (origin.place.line, origin.place.file.as_str()) {
                (Some(line), file) => SceneError::in_line(file, line, message),
                (None, "") => SceneError::in_file(self.name, message),
                (None, file) => SceneError::in_file(file, message),
            };
            let key = if origin.place.key.is_empty() { self.key_at(&span) } else { origin.place.key.clone() };
            return error.with_key(key);
        }
        let key = self.key_at(&span);
        SceneError::in_text(self.name, self.text, span, message).with_key(key)
    }

    /// What the text at a byte was made from.
    fn origin_at(self, at: usize) -> Option<&'a Origin> {
        self.origins[..self.origins.partition_point(|origin| origin.start <= at)].last()
    }

    fn parse(self) -> Result<Spanned<DeTable<'a>>, SceneError> {
        DeTable::parse(self.text).map_err(|error| self.translate(&error))
    }

    fn translate(self, error: &toml::de::Error) -> SceneError {
        let span = error.span().unwrap_or(0..self.text.len().min(1));
        let (mut message, help) = wording::in_plain_words(error.message());
        if message == "duplicate key" {
            // A text that does not parse has no tree to find the key in.
            message = format!("duplicate key `{}`", self.text.get(span.clone()).unwrap_or_default());
        }
        let located = self.error(span, message);
        match help {
            Some(help) => located.with_help(help),
            None => located,
        }
    }

    /// Rewrites every table whose shape depends on a key, `{ type = "mirror", … }`, to `{ mirror = { … } }`.
    fn name_variants(self, root: &mut DeTable<'a>) -> Result<(), SceneError> {
        for list in LISTS {
            let Some(entries) = root.get_mut(list) else { continue };
            let DeValue::Array(entries) = entries.get_mut() else { continue };
            for entry in entries.iter_mut() {
                if let DeValue::Table(table) = entry.get_mut()
                    && let Some(weight) = table.get_mut("weight")
                {
                    self.name_heuristic(weight)?;
                }
                self.name_variant(entry, "type")?;
            }
        }
        if let Some(DeValue::Array(groups)) = root.get_mut("group").map(Spanned::get_mut) {
            for group in groups.iter_mut() {
                if let DeValue::Table(group) = group.get_mut()
                    && let Some(DeValue::Array(shapes)) = group.get_mut("shape").map(Spanned::get_mut)
                {
                    shapes.iter_mut().try_for_each(|shape| self.name_variant(shape, "type"))?;
                }
            }
        }
        for (table, key, tag) in [("film", "filter", "type"), ("camera", "aperture", "shape")] {
            let Some(table) = root.get_mut(table) else { continue };
            let DeValue::Table(table) = table.get_mut() else { continue };
            if let Some(value) = table.get_mut(key) {
                self.name_variant(value, tag)?;
            }
        }
        Ok(())
    }

    /// Weights of blends nest by the key `of`; the parser bounds how deep.
    fn name_heuristic(self, weight: &mut Spanned<DeValue<'a>>) -> Result<(), SceneError> {
        if let DeValue::Table(table) = weight.get_mut()
            && let Some(inner) = table.get_mut("of")
        {
            self.name_heuristic(inner)?;
        }
        self.name_variant(weight, "type")
    }

    fn name_variant(self, entry: &mut Spanned<DeValue<'a>>, tag: &str) -> Result<(), SceneError> {
        let span = entry.span();
        let DeValue::Table(table) = entry.get_mut() else {
            let found = entry.get_ref().type_str();
            return Err(self.error(span, format!("expected a table with the key `{tag}`, found {found}")));
        };
        // A missing tag becomes a name that is no choice, so that serde's complaint lists the choices.
        let name = match table.remove(tag) {
            None => Spanned::new(span.clone(), format!("{}{tag}", wording::MISSING).into()),
            Some(value) => {
                let at = value.span();
                match value.into_inner() {
                    DeValue::String(name) => Spanned::new(at, name),
                    other => return Err(self.error(at, format!("expected a name in quotes, found {}", other.type_str()))),
                }
            }
        };
        let keys = Spanned::new(span, DeValue::Table(std::mem::take(table)));
        table.insert(name, keys);
        Ok(())
    }

    /// The bytes of a key's value in a table at the top; none where it is not written.
    pub fn span_of(self, table: &str, key: &str) -> Range<usize> {
        let Ok(root) = DeTable::parse(self.text) else { return 0..0 };
        let value = root.get_ref().get(table).and_then(|table| table.get_ref().get(key));
        value.map_or(0..0, Spanned::span)
    }

    /// The dotted path of the innermost key or value around `span`; empty at the top.
    fn key_at(self, span: &Range<usize>) -> String {
        let Ok(root) = DeTable::parse(self.text) else { return String::new() };
        let mut innermost = Innermost { wanted: span, path: String::new(), width: usize::MAX };
        innermost.search_table(root.get_ref(), "");
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
