//! Lines and words.

use std::borrow::Cow;

/// Stands between words: what Unicode calls white space, and what programs leave behind, which is NUL, the end-of-file mark of CP/M, and a
/// byte-order mark in the middle of files that were joined.
pub fn is_blank(character: char) -> bool {
    matches!(character, '\0' | '\x1a' | '\u{feff}') || character.is_whitespace()
}

pub fn trimmed(text: &str) -> &str {
    text.trim_matches(is_blank)
}

pub fn words(text: &str) -> impl Iterator<Item = &str> + Clone {
    text.split(is_blank).filter(|word| !word.is_empty())
}

/// The first word, and what follows it without the blanks between.
pub fn first_word(text: &str) -> (&str, &str) {
    let text = text.trim_start_matches(is_blank);
    let (word, rest) = text.split_once(is_blank).unwrap_or((text, ""));
    (word, rest.trim_start_matches(is_blank))
}

/// Lines of a text with their numbers, which count from 1. They end in LF, CR, both, NEL, or one of Unicode's separators; a form feed or a vertical
/// tab ends one as well, but editors count none there.
pub struct Lines<'t> {
    rest: Option<&'t str>,
    number: usize,
}

impl<'t> Lines<'t> {
    pub fn new(text: &'t str) -> Self {
        Self { rest: Some(text), number: 1 }
    }
}

impl<'t> Iterator for Lines<'t> {
    type Item = (usize, &'t str);

    fn next(&mut self) -> Option<Self::Item> {
        let rest = self.rest?;
        let number = self.number;
        let bytes = rest.as_bytes();
        let mut places = bytes.iter().enumerate();
        let found = places.find_map(|(at, byte)| match byte {
            b'\n' => Some((at, 1, 1)),
            b'\r' => Some((at, 1 + usize::from(bytes.get(at + 1) == Some(&b'\n')), 1)),
            0x0b | 0x0c => Some((at, 1, 0)),
            0xc2 if bytes.get(at + 1) == Some(&0x85) => Some((at, 2, 1)),
            0xe2 if matches!(bytes.get(at + 1..at + 3), Some([0x80, 0xa8 | 0xa9])) => Some((at, 3, 1)),
            _ => None,
        });
        match found {
            Some((at, length, lines)) => {
                self.rest = Some(&rest[at + length..]);
                self.number += lines;
                Some((number, &rest[..at]))
            }
            None => {
                self.rest = None;
                Some((number, rest))
            }
        }
    }
}

/// Statements of a text: its lines without comments of their own, those joined that a backslash continues.
///
/// A backslash continues nothing where it ends a comment, or where the next line is a statement by itself: paths and comments end in one.
pub struct Statements<'t> {
    lines: std::iter::Peekable<Lines<'t>>,
    is_statement: fn(&str) -> bool,
}

impl<'t> Statements<'t> {
    /// `is_statement` tells of a line whether it begins a statement that the format knows.
    pub fn new(text: &'t str, is_statement: fn(&str) -> bool) -> Self {
        Self { lines: Lines::new(text).peekable(), is_statement }
    }

    /// The line goes on in the next one; then without the backslash.
    fn continued<'l>(&mut self, line: &'l str) -> Option<&'l str> {
        let start = line.trim_end_matches(is_blank).strip_suffix('\\')?;
        let (_, next) = self.lines.peek()?;
        (!line.contains('#') && !(self.is_statement)(next)).then_some(start)
    }
}

impl<'t> Iterator for Statements<'t> {
    type Item = (usize, Cow<'t, str>);

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let (number, line) = self.lines.next()?;
            let line = trimmed(line);
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let Some(start) = self.continued(line) else { return Some((number, Cow::Borrowed(line))) };
            let mut joined = start.to_owned();
            while let Some((_, next)) = self.lines.next() {
                let start = self.continued(next);
                joined.push(' ');
                joined.push_str(start.unwrap_or(next));
                if start.is_none() {
                    break;
                }
            }
            return Some((number, Cow::Owned(trimmed(&joined).to_owned())));
        }
    }
}

/// The part before a comment, of statements whose words never contain its sign.
pub fn without_comment(statement: &str) -> &str {
    statement.split('#').next().unwrap_or("").trim_end_matches(is_blank)
}

/// The part before a comment, of names, which may contain its sign, but rarely behind a blank. None where there is no comment.
pub fn before_spaced_comment(name: &str) -> Option<&str> {
    let place = name.match_indices('#').map(|(place, _)| place).find(|&place| name[..place].ends_with(is_blank))?;
    Some(name[..place].trim_end_matches(is_blank))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn statements(text: &str) -> Vec<(usize, String)> {
        let known = |line: &str| matches!(first_word(line).0, "f" | "v" | "usemtl");
        Statements::new(text, known).map(|(line, text)| (line, text.into_owned())).collect()
    }

    fn expect(text: &str, expected: &[(usize, &str)]) {
        let expected: Vec<(usize, String)> = expected.iter().map(|(line, text)| (*line, (*text).to_owned())).collect();
        assert_eq!(statements(text), expected, "{text:?}");
    }

    #[test]
    fn lines_end_in_every_way() {
        for end in ["\n", "\r\n", "\r", "\u{85}", "\u{2028}", "\u{2029}"] {
            expect(&format!("v 1{end}{end}v 2{end}"), &[(1, "v 1"), (3, "v 2")]);
        }
        expect("v 1\x0cv 2\x0bv 3\nv 4", &[(1, "v 1"), (1, "v 2"), (1, "v 3"), (2, "v 4")]);
        expect("\u{feff}v 1\t\0\n\0\n\x1a", &[(1, "v 1")]);
        expect("", &[]);
    }

    #[test]
    fn a_backslash_continues_a_line_but_no_comment_and_not_over_a_statement() {
        expect("f 1 \\\n 2\\ \r\n3\nv 1", &[(1, "f 1   2 3"), (4, "v 1")]);
        expect("# a \\\nf 1\n", &[(2, "f 1")]);
        expect("v 1 # a \\\nf 1\n", &[(1, "v 1 # a \\"), (2, "f 1")]);
        expect("g C:\\models\\\nf 1\n", &[(1, "g C:\\models\\"), (2, "f 1")]);
        expect("f 1 2\\", &[(1, "f 1 2\\")]);
        expect("f 1\\\n\\\n2", &[(1, "f 1  2")]);
    }

    #[test]
    fn comments_end_what_stands_before_them() {
        assert_eq!(without_comment("1 2 # 3"), "1 2");
        assert_eq!(without_comment("1#"), "1");
        assert_eq!(before_spaced_comment("red # or so"), Some("red"));
        assert_eq!(before_spaced_comment("red#2"), None);
        assert_eq!(before_spaced_comment("red#2 #3"), Some("red#2"));
    }

    #[test]
    fn words_are_parted_by_any_blank() {
        assert_eq!(words("a\u{a0}b\tc \0 d").collect::<Vec<_>>(), ["a", "b", "c", "d"]);
        assert_eq!(first_word("\u{feff} v  1 2"), ("v", "1 2"));
    }
}
