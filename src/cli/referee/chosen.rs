//! The tests that arguments name.

use gpt::referee::{Test, all_tests};

use crate::cli::exit::Failure;

/// The tests of these names and families; all where none is named.
pub fn chosen(names: &[String]) -> Result<Vec<Test>, Failure> {
    let tests = all_tests();
    for name in names {
        if !tests.iter().any(|test| test.name == name || test.family() == name) {
            let message = format!("there is no test and no family `{name}`");
            return Err(Failure::Usage { message, help: Some("`gpt referee list` lists them".to_owned()) });
        }
    }
    let is_chosen = |test: &Test| names.is_empty() || names.iter().any(|name| test.name == name || test.family() == name);
    Ok(tests.into_iter().filter(is_chosen).collect())
}
