//! Values chosen by name, as the command line reads them.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use gpt::choice::{Choice, Named};

/// Reads a value by its name. Help and errors list the names, help with their meanings.
pub fn by_name<T: Choice + Send + Sync>() -> impl TypedValueParser<Value = T> {
    names(T::NAMES).try_map(|name| T::from_name(&name).ok_or("there is no such choice"))
}

/// Reads one of these names.
pub fn names(names: &'static [Named]) -> PossibleValuesParser {
    PossibleValuesParser::new(names.iter().map(|name| PossibleValue::new(name.name).help(help(name.help()))))
}

/// A sentence as clap shows it: without the full stop at its end.
pub fn help(sentence: &str) -> &str {
    sentence.strip_suffix('.').unwrap_or(sentence)
}
