//! Texts of scene files, and places in them.

use std::fmt;
use std::rc::Rc;

use crate::load::error::SceneError;
use crate::load::place::{Origin, Place};

/// A file that is read.
#[derive(Debug)]
pub struct SourceText {
    /// The file as errors show it.
    pub name: String,
    pub text: String,
}

/// Bytes of a text, and the line in which they begin, counted from 1.
#[derive(Debug, Clone)]
pub struct Spot {
    pub source: Rc<SourceText>,
    pub start: u32,
    pub end: u32,
    pub line: u32,
}

impl Spot {
    /// An error that shows this part of the text.
    pub fn error(&self, message: impl Into<String>) -> SceneError {
        SceneError::in_text(&self.source.name, &self.source.text, self.start as usize..self.end as usize, message)
    }

    /// The place, which entries made of it have.
    pub fn place(&self) -> Place {
        Place::from(Origin { file: self.source.name.clone(), line: Some(self.line as usize), key: String::new() })
    }

    /// A value of an entry, or the error about one that is not possible.
    pub fn possible<T>(&self, made: Result<T, String>) -> Result<T, SceneError> {
        made.map_err(|message| self.error(message))
    }
}

impl fmt::Display for Spot {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}:{}", self.source.name, self.line)
    }
}
