//! The lines around a mistake.

use std::ops::Range;

use super::printable::printable_character;

/// Most characters of a line that are shown.
const LINE: usize = 200;
/// Most of those characters that stand before the mistake.
const BEFORE: usize = 80;
/// Most lines that are shown.
const LINES: usize = 8;

/// A few lines of a text, cut where they are long.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Excerpt {
    pub text: String,
    /// The bytes of `text` that are wrong.
    pub span: Range<usize>,
    /// Line of the file, from 1, that the excerpt begins with.
    pub first_line: usize,
}

impl Excerpt {
    /// The lines of `span`, with the one before and the one after. Takes time in proportion to the text before and on those lines.
    pub fn around(text: &str, span: Range<usize>) -> Self {
        let line_start = |at: usize| text[..at].rfind('\n').map_or(0, |newline| newline + 1);
        let start = line_start(span.start);
        let first = if start == 0 { 0 } else { line_start(start - 1) };
        let mut excerpt =
            Self { text: String::new(), span: 0..0, first_line: 1 + text[..first].bytes().filter(|byte| *byte == b'\n').count() };
        let mut at = first;
        for _ in 0..LINES {
            let end = text[at..].find('\n').map_or(text.len(), |length| at + length);
            excerpt.push_line(text, at..end, &span);
            if end == text.len() || at > span.end {
                break;
            }
            excerpt.text.push('\n');
            at = end + 1;
        }
        excerpt.span.end = excerpt.span.end.max(excerpt.span.start);
        excerpt
    }

    fn push_line(&mut self, text: &str, line: Range<usize>, span: &Range<usize>) {
        let begins_here = line.contains(&span.start) || line.end == span.start;
        let near = span.start.clamp(line.start, line.end);
        let back = if begins_here { text[line.start..near].char_indices().rev().take(BEFORE).last() } else { None };
        let from = back.map_or(line.start, |(place, _)| line.start + place);
        if from > line.start {
            self.text.push('…');
        }
        let mut at = from;
        for character in text[from..line.end].chars().take(LINE) {
            if at <= span.start {
                self.span.start = self.text.len();
            }
            if at <= span.end {
                self.span.end = self.text.len();
            }
            self.text.push(printable_character(character));
            at += character.len_utf8();
        }
        if at <= span.start {
            self.span.start = self.text.len();
        }
        if at <= span.end {
            self.span.end = self.text.len();
        }
        if at < line.end {
            self.text.push('…');
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wrong_part(text: &str, wrong: &str) -> (Excerpt, String) {
        let start = text.find(wrong).expect("it is in the text");
        let excerpt = Excerpt::around(text, start..start + wrong.len());
        let part = excerpt.text[excerpt.span.clone()].to_owned();
        (excerpt, part)
    }

    #[test]
    fn short_lines_are_whole() {
        let (excerpt, part) = wrong_part("[a]\nx = 1\ny = -1\nz = 2\nw = 3\n", "-1");
        assert_eq!((excerpt.text.as_str(), excerpt.first_line, part.as_str()), ("x = 1\ny = -1\nz = 2", 2, "-1"));
        let (excerpt, part) = wrong_part("bad", "bad");
        assert_eq!((excerpt.text.as_str(), excerpt.first_line, part.as_str()), ("bad", 1, "bad"));
    }

    #[test]
    fn long_lines_are_cut_on_both_sides() {
        let text = format!("a\n{}WRONG{}\n{}", "ß, ".repeat(100_000), "1, ".repeat(100_000), "2, ".repeat(100_000));
        let (excerpt, part) = wrong_part(&text, "WRONG");
        assert_eq!(part, "WRONG");
        assert!(
            excerpt.text.chars().count() < 3 * LINE && excerpt.text.contains('…') && excerpt.first_line == 1,
            "{}",
            excerpt.text
        );
    }

    #[test]
    fn of_many_lines_the_first_are_shown() {
        let text = format!("before\nWRONG{}HERE\nafter", "\n1".repeat(1000));
        let end = text.find("HERE").expect("it is there") + 4;
        let excerpt = Excerpt::around(&text, 7..end);
        assert_eq!(excerpt.text.lines().count(), LINES);
        assert!(excerpt.text[excerpt.span.clone()].starts_with("WRONG\n1\n1"));
    }

    #[test]
    fn a_mistake_at_the_end_has_a_place() {
        let excerpt = Excerpt::around("a = 1\nb = ", 10..10);
        assert_eq!((excerpt.text.as_str(), excerpt.span), ("a = 1\nb = ", 10..10));
        assert_eq!(Excerpt::around("", 0..0).span, 0..0);
    }

    #[test]
    fn escapes_are_shown_and_not_sent() {
        let (excerpt, part) = wrong_part("name = \"\x1b[2J\"\n", "\x1b[2J");
        assert_eq!((excerpt.text.as_str(), part.as_str()), ("name = \"␛[2J\"\n", "␛[2J"));
    }
}
