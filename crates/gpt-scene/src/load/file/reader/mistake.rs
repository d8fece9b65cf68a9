//! A mistake in a value.

use std::fmt;
use std::ops::Range;

use serde::de::{Error, Expected, Unexpected};

use crate::load::file::suggestion::{did_you_mean, list_of};

/// A mistake in a value in the words of scene files, and the bytes of the value.
#[derive(Debug, PartialEq)]
pub struct Mistake {
    pub message: String,
    /// A hint at the right input.
    pub help: Option<String>,
    pub span: Option<Range<usize>>,
}

impl Mistake {
    pub fn new(span: Range<usize>, message: String) -> Self {
        Self { message, help: None, span: Some(span) }
    }

    /// A table lacks the key that says which of these kinds it is of.
    pub fn without_kind(key: &str, kinds: &[&str]) -> Self {
        Self { help: list_of(kinds), ..Self::custom(format_args!("the key `{key}` is missing")) }
    }

    /// The mistake, at a value around it where it has no place of its own.
    pub fn within(mut self, span: Range<usize>) -> Self {
        self.span.get_or_insert(span);
        self
    }
}

impl Error for Mistake {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self { message: message.to_string(), help: None, span: None }
    }

    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::custom(format_args!("invalid type: {}, expected {}", FoundValue(found), words(expected)))
    }

    fn invalid_value(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::custom(format_args!("invalid value: {}, expected {}", FoundValue(found), words(expected)))
    }

    fn invalid_length(length: usize, expected: &dyn Expected) -> Self {
        Self::custom(format_args!("wrong number of values: {length}, expected {}", words(expected)))
    }

    fn unknown_variant(name: &str, choices: &'static [&'static str]) -> Self {
        Self { help: did_you_mean(name, choices), ..Self::custom(format_args!("`{name}` is not a valid choice")) }
    }

    fn unknown_field(name: &str, keys: &'static [&'static str]) -> Self {
        Self { help: did_you_mean(name, keys), ..Self::custom(format_args!("unknown key `{name}`")) }
    }

    fn missing_field(key: &'static str) -> Self {
        Self::custom(format_args!("the key `{key}` is missing"))
    }

    fn duplicate_field(key: &'static str) -> Self {
        Self::custom(format_args!("the key `{key}` is there twice"))
    }
}

/// A value that is written, by its kind in TOML.
struct FoundValue<'a>(Unexpected<'a>);

impl fmt::Display for FoundValue<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Unexpected::Float(value) => write!(f, "number `{value:?}`"),
            Unexpected::Map => f.write_str("table"),
            Unexpected::Seq => f.write_str("array"),
            other => other.fmt(f),
        }
    }
}

/// The expectation in words of TOML; types of Rust that name themselves have other names there.
fn words(expected: &dyn Expected) -> String {
    match expected.to_string().as_str() {
        "a nonzero u32" => "a whole number of at least 1".to_owned(),
        "u32" => "a whole number of at least 0".to_owned(),
        "a sequence" => "an array".to_owned(),
        "a map" => "a table".to_owned(),
        "a string" => "text in quotes".to_owned(),
        other => other.to_owned(),
    }
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Mistake {}
