//! Mistakes in a scene, and their places.

use std::fmt;
use std::ops::Range;
use std::path::Path;

use super::excerpt::Excerpt;
use super::printable::{printable, short};

/// Most mistakes of a file that are reported at once.
pub(crate) const MOST_ERRORS: usize = 20;

/// One mistake in a scene file or in a file it names. Displays as `file:line:column: key: message`.
#[derive(Debug, Clone)]
pub struct SceneError(Box<Details>);

#[derive(Debug, Clone)]
struct Details {
    file: String,
    message: String,
    help: Option<String>,
    key: Option<String>,
    place: Option<TextPosition>,
    others: Vec<SceneError>,
}

#[derive(Debug, Clone)]
struct TextPosition {
    line: usize,
    column: usize,
    /// None where the text is not shown.
    excerpt: Option<Excerpt>,
}

impl SceneError {
    /// A mistake that concerns the file as a whole: it is missing, it is not an image.
    pub fn in_file(file: impl fmt::Display, message: impl Into<String>) -> Self {
        let (file, message) = (printable(&file.to_string()), short(&printable(&message.into())));
        Self(Box::new(Details { file, message, help: None, key: None, place: None, others: Vec::new() }))
    }

    /// A mistake in a line of a file whose text is not shown. Lines count from 1.
    pub fn in_line(file: impl fmt::Display, line: usize, message: impl Into<String>) -> Self {
        let mut error = Self::in_file(file, message);
        error.0.place = Some(TextPosition { line, column: 1, excerpt: None });
        error
    }

    /// A mistake at the bytes `span` of `text`.
    pub fn in_text(file: &str, text: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        let start = floor_char_boundary(text, span.start);
        let end = floor_char_boundary(text, span.end.max(start));
        let before = &text[..start];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.matches('\n').count() + 1;
        let column = text[line_start..start].chars().count() + 1;
        let mut error = Self::in_file(file, message);
        error.0.place = Some(TextPosition { line, column, excerpt: Some(Excerpt::around(text, start..end)) });
        error
    }

    /// Names the key that is wrong, as `material[2].reflectance`.
    pub fn with_key(mut self, key: impl Into<String>) -> Self {
        self.0.key = Some(short(&printable(&key.into()))).filter(|key| !key.is_empty());
        self
    }

    /// Says what would be right.
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.0.help = Some(printable(&help.into()));
        self
    }

    /// Adds what else is wrong, in the order of the file. The first is this error.
    pub(crate) fn of_all(mut errors: Vec<Self>) -> Option<Self> {
        errors.sort_by_key(|error| (error.line(), error.column()));
        errors.dedup_by_key(|error| error.to_string());
        errors.truncate(MOST_ERRORS);
        let others = errors.split_off(errors.len().min(1));
        let mut first = errors.pop()?;
        first.0.others = others;
        Some(first)
    }

    /// Other mistakes in the same file, as far as they were found.
    pub fn others(&self) -> &[Self] {
        &self.0.others
    }

    /// The file as the user named it, or a built-in scene's name.
    pub fn file(&self) -> &str {
        &self.0.file
    }

    /// Line, counted from 1.
    pub fn line(&self) -> Option<usize> {
        self.0.place.as_ref().map(|place| place.line)
    }

    /// Column in characters, counted from 1.
    pub fn column(&self) -> Option<usize> {
        self.0.place.as_ref().map(|place| place.column)
    }

    /// Dotted path of the key.
    pub fn key(&self) -> Option<&str> {
        self.0.key.as_deref()
    }

    /// The mistake, without its place.
    pub fn message(&self) -> &str {
        &self.0.message
    }

    /// A hint at the right input: valid choices, a likely spelling.
    pub fn help_text(&self) -> Option<&str> {
        self.0.help.as_deref()
    }

    /// The lines around the mistake, where the file is one that a person writes.
    pub fn excerpt(&self) -> Option<&Excerpt> {
        self.0.place.as_ref()?.excerpt.as_ref()
    }
}

/// The file's name as errors show it.
pub(crate) fn show(path: &Path) -> String {
    printable(&path.display().to_string())
}

fn floor_char_boundary(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0)
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let details = &self.0;
        write!(f, "{}", details.file)?;
        if let Some(place) = &details.place {
            write!(f, ":{}:{}", place.line, place.column)?;
        }
        if let Some(key) = &details.key {
            write!(f, ": {key}")?;
        }
        write!(f, ": {}", details.message)
    }
}

impl std::error::Error for SceneError {}
