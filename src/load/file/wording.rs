//! Serde's messages, which speak of fields, variants and Rust types, in the words of a scene file.

use crate::load::printable::short_list;

/// Longer names are not compared, which would take time in proportion to the product of their lengths.
const LONGEST_NAME: usize = 80;

/// Begins the name that stands for a tag that is not there.
pub const MISSING: char = '\0';

/// The message in plain words, and what would be right if the message says so.
pub fn in_plain_words(message: &str) -> (String, Option<String>) {
    let quoted = quoted_words(message);
    let choices = quoted.get(1..).unwrap_or_default();
    match quoted.first() {
        Some(&name) if message.starts_with("unknown variant") => match name.strip_prefix(MISSING) {
            Some(key) => (format!("the key `{key}` is missing"), choices_help(choices)),
            None => (format!("`{name}` is not a valid choice"), did_you_mean(name, choices)),
        },
        Some(&name) if message.starts_with("unknown field") => (format!("unknown key `{name}`"), did_you_mean(name, choices)),
        Some(&name) if message.starts_with("missing field") => (format!("the key `{name}` is missing"), None),
        _ => (replace_type_names(message), None),
    }
}

/// Suggests the closest of `choices`, which are words of the program, and lists them all.
pub fn did_you_mean(name: &str, choices: &[&str]) -> Option<String> {
    suggest(name, choices, choices_help(choices)?)
}

/// Suggests the closest of names that a person has given, and lists some of them.
pub fn did_you_mean_name(name: &str, names: &[&str]) -> Option<String> {
    let list = (!names.is_empty()).then(|| format!("valid choices: {}", short_list(names)))?;
    suggest(name, names, list)
}

fn suggest(name: &str, choices: &[&str], all: String) -> Option<String> {
    let closest = choices
        .iter()
        .filter(|choice| name.len() <= LONGEST_NAME && choice.len() <= LONGEST_NAME)
        .map(|choice| (strsim::damerau_levenshtein(name, choice), choice))
        .min()
        .filter(|(distance, choice)| *distance <= (choice.len() / 3).max(1));
    Some(match closest {
        Some((_, choice)) => format!("did you mean `{choice}`? {all}"),
        None => all,
    })
}

fn choices_help(choices: &[&str]) -> Option<String> {
    (!choices.is_empty()).then(|| format!("valid choices: {}", choices.join(", ")))
}

/// What stands between pairs of backquotes.
fn quoted_words(message: &str) -> Vec<&str> {
    message.split('`').skip(1).step_by(2).collect()
}

fn replace_type_names(message: &str) -> String {
    let replacements = [
        ("a nonzero u32", "a whole number of at least 1"),
        ("expected u32", "expected a whole number of at least 0"),
        ("floating point `", "number `"),
        ("invalid type: map", "invalid type: table"),
        ("a sequence", "an array"),
        ("sequence", "array"),
        ("unit variant", "a name"),
        ("newtype variant", "a table"),
        ("invalid length ", "wrong number of values: "),
        ("a string", "text in quotes"),
    ];
    replacements.iter().fold(message.to_owned(), |text, (from, to)| text.replace(from, to))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_key_is_suggested() {
        let (message, help) = in_plain_words("unknown field `reflectence`, expected one of `name`, `reflectance`");
        assert_eq!(message, "unknown key `reflectence`");
        assert_eq!(help.as_deref(), Some("did you mean `reflectance`? valid choices: name, reflectance"));
    }

    #[test]
    fn a_name_unlike_any_is_not_guessed_at() {
        assert_eq!(did_you_mean("xyz", &["mirror", "glass"]).as_deref(), Some("valid choices: mirror, glass"));
        assert_eq!(did_you_mean("xyz", &[]), None);
    }
}
