//! What is wrong with a value.

use std::fmt;
use std::ops::Range;

use serde::de::Error;

/// What is wrong with a value, in serde's words, and the bytes of the value.
#[derive(Debug)]
pub struct Mistake {
    pub message: String,
    pub span: Option<Range<usize>>,
}

impl Mistake {
    pub fn new(span: Range<usize>, message: String) -> Self {
        Self { message, span: Some(span) }
    }

    /// The mistake, at a value around it where it has no place of its own.
    pub fn within(mut self, span: Range<usize>) -> Self {
        self.span.get_or_insert(span);
        self
    }
}

impl Error for Mistake {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self { message: message.to_string(), span: None }
    }
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Mistake {}
