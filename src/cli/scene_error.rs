//! Errors as people see them: what is wrong, the lines of the scene file around it, and advice.

use gpt::load::{Excerpt, SceneError, printable};
use unicode_width::UnicodeWidthStr as _;

use super::exit::Failure;

const BOLD_RED: &str = "\x1b[1;31m";
const BLUE: &str = "\x1b[34m";
const CYAN: &str = "\x1b[36m";

/// The whole text of a failure, which ends a line. It is plain, or has the colours of a terminal.
pub fn drawn(failure: &Failure, has_colours: bool) -> String {
    let drawing = Drawing { has_colours };
    match failure {
        Failure::Scene(error) => {
            let errors: Vec<String> =
                std::iter::once(error).chain(error.others()).map(|error| drawing.scene_error(error)).collect();
            errors.join("\n")
        }
        Failure::Usage { message, help } => drawing.message(message) + &drawing.help(help.as_deref()),
        other => drawing.message(&other.to_string()),
    }
}

struct Drawing {
    has_colours: bool,
}

impl Drawing {
    fn painted(&self, colour: &str, text: &str) -> String {
        if self.has_colours { format!("{colour}{text}\x1b[0m") } else { text.to_owned() }
    }

    fn message(&self, message: &str) -> String {
        format!("{} {}\n", self.painted(BOLD_RED, "Error:"), printable(message))
    }

    fn help(&self, help: Option<&str>) -> String {
        help.map_or_else(String::new, |help| format!("{} {}\n", self.painted(CYAN, " help:"), printable(help)))
    }

    fn scene_error(&self, error: &SceneError) -> String {
        let excerpt = error.excerpt().map_or_else(String::new, |excerpt| self.excerpt(excerpt));
        self.message(&error.to_string()) + &excerpt + &self.help(error.help_text())
    }

    /// The lines with their numbers. Carets stand below what is wrong.
    fn excerpt(&self, excerpt: &Excerpt) -> String {
        let Excerpt { text, span, first_line } = excerpt;
        let digits = (first_line + text.matches('\n').count()).to_string().len();
        let gutter = |number: &str| self.painted(BLUE, &format!(" {number:>digits$} |"));
        let mut drawn = gutter("") + "\n";
        let mut start = 0;
        for (line, number) in text.split('\n').zip(*first_line..) {
            let end = start + line.len();
            drawn += format!("{} {}", gutter(&number.to_string()), expanded(line)).trim_end();
            drawn.push('\n');
            let wrong = span.start.max(start)..span.end.min(end);
            // A span of several lines has the line end of each, which is not marked by itself.
            if !wrong.is_empty() || (span.is_empty() && wrong.start == wrong.end) {
                let [before, marked] = [start..wrong.start, wrong].map(|part| expanded(&text[part]).width());
                let carets = self.painted(BOLD_RED, &"^".repeat(marked.max(1)));
                drawn += &format!("{} {}{carets}\n", gutter(""), " ".repeat(before));
            }
            start = end + 1;
        }
        drawn
    }
}

/// The text with blanks for tabs, which terminals draw by their column.
fn expanded(text: &str) -> String {
    text.replace('\t', "    ")
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn drawn_of(text: &str) -> String {
        drawn(&gpt::load::load_toml_str(text, "test.toml", Path::new("")).unwrap_err().into(), false)
    }

    #[test]
    fn the_lines_of_all_mistakes_are_shown() {
        let text = "[camera]\n\tposition = \"ß中\"\t\nlook_at = [0,\n 0]\nvfov = 40\n\n\n\n[[material]]\nname = \"a\"\ntype = \"difuse\"\n";
        let expected = "Error: test.toml:2:13: camera.position: invalid type: string \"ß中\", expected an array of length 3
   |
 1 | [camera]
 2 |     position = \"ß中\"
   |                ^^^^^
 3 | look_at = [0,

Error: test.toml:3:11: camera.look_at: wrong number of values: 2, expected an array of length 3
   |
 2 |     position = \"ß中\"
 3 | look_at = [0,
   |           ^^^
 4 |  0]
   | ^^^
 5 | vfov = 40

Error: test.toml:11:8: material[0].type: `difuse` is not a valid choice
    |
 10 | name = \"a\"
 11 | type = \"difuse\"
    |        ^^^^^^^^
 12 |
 help: did you mean `diffuse`?";
        let drawn = drawn_of(text);
        assert!(drawn.starts_with(expected), "{drawn}");
    }

    #[test]
    fn tabs_and_wide_characters_keep_carets_in_place() {
        let drawn = drawn_of("[camera]\n\tposition = \"ß中\"\t\nlook_at = [0,0,0]\nvfov = 40");
        assert!(drawn.contains("\n 2 |     position = \"ß中\"\n   |                ^^^^^\n 3 | look_at"), "{drawn}");
    }

    #[test]
    fn a_mistake_at_the_end_is_marked_behind_it() {
        let drawn = drawn_of("[camera]\nposition = [0, 0, 3");
        assert!(drawn.contains("\n 2 | position = [0, 0, 3\n   |                    ^\n"), "{drawn}");
    }

    #[test]
    fn a_mistake_far_along_a_line_is_shown_in_few_words() {
        let long = "[0, 0, 0], ".repeat(20_000);
        let drawn = drawn_of(&format!(
            "[camera]\nposition = [0, 0, 3]\nlook_at = [0, 0, 0]\nvfov = 40\n[[shape]]\ntype = \"mesh\"\npositions = [{long}[0, 0, \"\x1b[2J\"], {long}]\n"
        ));
        assert!(drawn.contains("test.toml:7:220022") && drawn.contains("␛[2J") && drawn.contains('…'), "{drawn}");
        assert!(drawn.len() < 3000 && !drawn.contains('\x1b'), "{drawn}");
    }

    #[test]
    fn colours_are_the_only_escape_sequences() {
        let drawn = drawn(&Failure::Other("a\x1b[2Jb".to_owned()), true);
        assert_eq!(drawn, "\x1b[1;31mError:\x1b[0m a␛[2Jb\n");
    }
}
