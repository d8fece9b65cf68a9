//! Names that tell entries apart.

use std::collections::HashSet;

use crate::load::toml_text::text;

/// The name of each entry of a list; no two are equal, and none is empty.
pub struct Names(Vec<String>);

impl Names {
    /// Keeps the names that entries have, as far as no earlier one has them; `kind` begins those that are made up.
    pub fn unique<'n>(names: impl Iterator<Item = &'n str>, kind: &str) -> Self {
        let mut taken = HashSet::new();
        let mut unique = |(place, name): (usize, &str)| {
            let first = if name.is_empty() { format!("{kind} {}", place + 1) } else { name.to_owned() };
            let others = (2..).map(|number| format!("{first} ({number})"));
            let free = std::iter::once(first.clone()).chain(others).find(|name| taken.insert(name.clone()));
            // There are more numbers than names.
            free.unwrap_or(first)
        };
        Self(names.enumerate().map(&mut unique).collect())
    }

    /// The name of an entry.
    pub fn get(&self, id: usize) -> &str {
        &self.0[id]
    }

    /// A name as a scene file has it, in quotes.
    pub fn quoted(&self, id: usize) -> String {
        text(&self.0[id])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_entries_have_one_name() {
        let names = Names::unique(["a", "", "a", "a (2)", "a"].into_iter(), "material");
        assert_eq!(names.0, ["a", "material 2", "a (2)", "a (2) (2)", "a (3)"]);
    }
}
