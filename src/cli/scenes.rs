//! `gpt scenes`.

use gpt::load::{builtin_names, builtin_text};

use super::arguments::ScenesArguments;
use super::exit::{Exit, Failure};
use super::terminal;

/// Lists the built-in scenes, each with the first line that it says of itself; or prints one as it stands.
pub fn run(arguments: &ScenesArguments) -> Result<Exit, Failure> {
    if let Some(name) = &arguments.name {
        let text = builtin_text(name).ok_or_else(|| Failure::Usage {
            message: format!("`{name}` is no built-in scene"),
            help: Some(format!("there are {}", builtin_names().collect::<Vec<_>>().join(", "))),
        })?;
        terminal::answer(text)?;
        return Ok(Exit::Done);
    }
    let widest = builtin_names().map(str::len).max().unwrap_or_default();
    let line = |name| format!("{name:widest$}  {}\n", description(builtin_text(name).unwrap_or_default()));
    terminal::answer(&builtin_names().map(line).collect::<String>())?;
    Ok(Exit::Done)
}

/// The first sentence of the comment that a scene file begins with, up to a colon if it has one.
fn description(text: &str) -> String {
    let comment = text.lines().map_while(|line| line.strip_prefix('#')).filter(|line| !line.starts_with(':'));
    let comment = comment.map(str::trim).collect::<Vec<_>>().join(" ");
    let first = comment.split(". ").next().and_then(|sentence| sentence.split(": ").next());
    first.unwrap_or_default().trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_scene_says_what_it_is() {
        for name in builtin_names() {
            let description = description(builtin_text(name).expect("it is built in"));
            assert!((8..=160).contains(&description.len()), "{name}: {description}");
        }
        assert_eq!(description("# A room. With walls.\n# And more.\nfilm = 1"), "A room");
    }
}
