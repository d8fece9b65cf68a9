//! Suggestions of what was meant by a name that is not known.

use crate::load::printable::short_list;

/// Longer names are not compared, which would take time in proportion to the product of their lengths.
const LONGEST_NAME: usize = 80;

/// Suggests the closest of `choices`, which are words of the program, and lists them all.
pub fn did_you_mean(name: &str, choices: &[&str]) -> Option<String> {
    suggest(name, choices, list_of(choices)?)
}

/// Suggests the closest of names that a person has given, and lists some of them.
pub fn did_you_mean_name(name: &str, names: &[&str]) -> Option<String> {
    let list = (!names.is_empty()).then(|| format!("valid choices: {}", short_list(names)))?;
    suggest(name, names, list)
}

/// All choices, where there are some.
pub fn list_of(choices: &[&str]) -> Option<String> {
    (!choices.is_empty()).then(|| format!("valid choices: {}", choices.join(", ")))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_key_is_suggested() {
        let help = did_you_mean("reflectence", &["name", "reflectance"]);
        assert_eq!(help.as_deref(), Some("did you mean `reflectance`? valid choices: name, reflectance"));
    }

    #[test]
    fn a_name_unlike_any_is_not_guessed_at() {
        assert_eq!(did_you_mean("xyz", &["mirror", "glass"]).as_deref(), Some("valid choices: mirror, glass"));
        assert_eq!(did_you_mean("xyz", &[]), None);
    }
}
