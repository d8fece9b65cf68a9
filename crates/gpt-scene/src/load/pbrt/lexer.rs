//! From text to tokens: words, texts in quotes, and brackets.

use std::rc::Rc;

use super::text::{SourceText, Spot};
use crate::load::error::SceneError;

/// A token; where it stands is asked of the lexer once that is needed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Token {
    /// A directive's name, a number, `true` or `false`.
    Word,
    /// A text with its quotes.
    Quoted,
    Open,
    Close,
}

/// A token with its bytes.
#[derive(Debug, Clone, Copy)]
pub struct Lexeme {
    pub token: Token,
    start: u32,
    end: u32,
    line: u32,
}

/// Reads the tokens of one text.
pub struct Lexer {
    source: Rc<SourceText>,
    at: usize,
    line: u32,
}

impl Lexer {
    pub fn new(source: Rc<SourceText>) -> Self {
        Self { source, at: 0, line: 1 }
    }

    /// The next token, which is read; None at the end.
    ///
    /// # Errors
    /// A text without an end.
    pub fn next(&mut self) -> Result<Option<Lexeme>, SceneError> {
        let bytes = self.source.text.as_bytes();
        while let Some(&byte) = bytes.get(self.at) {
            match byte {
                b'\n' => self.line += 1,
                b'#' => {
                    let rest = &bytes[self.at..];
                    // The line's end is looked at next.
                    self.at += rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(rest.len());
                    continue;
                }
                _ if is_blank(byte) => {}
                _ => break,
            }
            self.at += 1;
        }
        let (start, line) = (self.at, self.line);
        let Some(&first) = bytes.get(start) else { return Ok(None) };
        let token = match first {
            b'[' | b']' => {
                self.at += 1;
                if first == b'[' { Token::Open } else { Token::Close }
            }
            b'"' => {
                self.at = end_of_quoted(bytes, start).ok_or_else(|| {
                    let end = bytes[start..].iter().position(|byte| *byte == b'\n').map_or(bytes.len(), |at| start + at);
                    self.spot_of(start, end, line).error("a text in quotes ends in the line in which it begins")
                })?;
                Token::Quoted
            }
            _ => {
                let ends = |byte: &u8| is_blank(*byte) || matches!(byte, b'\n' | b'"' | b'[' | b']');
                self.at = bytes[start..].iter().position(ends).map_or(bytes.len(), |at| start + at);
                Token::Word
            }
        };
        Ok(Some(Lexeme { token, start: start as u32, end: self.at as u32, line }))
    }

    /// The next token, which is still to be read.
    ///
    /// # Errors
    /// A text without an end.
    pub fn peek(&mut self) -> Result<Option<Lexeme>, SceneError> {
        let before = (self.at, self.line);
        let next = self.next();
        (self.at, self.line) = before;
        next
    }

    /// The bytes of a token as they are written.
    pub fn word(&self, lexeme: Lexeme) -> &str {
        &self.source.text[lexeme.start as usize..lexeme.end as usize]
    }

    /// The text between the quotes.
    ///
    /// # Errors
    /// A backslash before a character that has no meaning with it.
    pub fn text(&self, lexeme: Lexeme) -> Result<String, SceneError> {
        let written = self.word(lexeme);
        let within = written.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).unwrap_or(written);
        if !within.contains('\\') {
            return Ok(within.to_owned());
        }
        let mut text = String::with_capacity(within.len());
        let mut characters = within.chars();
        while let Some(character) = characters.next() {
            if character != '\\' {
                text.push(character);
                continue;
            }
            text.push(match characters.next() {
                Some('b') => '\u{8}',
                Some('f') => '\u{c}',
                Some('n') => '\n',
                Some('r') => '\r',
                Some('t') => '\t',
                Some(same @ ('\\' | '\'' | '"')) => same,
                other => {
                    let what = other.map_or_else(String::new, |other| format!("\\{other}"));
                    let error = self.spot(lexeme).error(format!("`{what}` in a text in quotes means nothing"));
                    return Err(error.with_help("a backslash itself is written as \\\\, and folders may be separated by /"));
                }
            });
        }
        Ok(text)
    }

    /// The place of a token.
    pub fn spot(&self, lexeme: Lexeme) -> Spot {
        self.spot_of(lexeme.start as usize, lexeme.end as usize, lexeme.line)
    }

    /// The place behind all that was read.
    pub fn here(&self) -> Spot {
        self.spot_of(self.at, self.at, self.line)
    }

    fn spot_of(&self, start: usize, end: usize, line: u32) -> Spot {
        Spot { source: self.source.clone(), start: start as u32, end: end as u32, line }
    }
}

/// A mark at the file's begin counts as a blank, byte by byte; no word begins with one.
fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | 0x0b | 0x0c)
}

/// The byte behind the closing quote.
fn end_of_quoted(bytes: &[u8], start: usize) -> Option<usize> {
    let mut at = start + 1;
    loop {
        match bytes.get(at)? {
            b'"' => return Some(at + 1),
            b'\n' => return None,
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lexer(text: &str) -> Lexer {
        Lexer::new(Rc::new(SourceText { name: "a.pbrt".to_owned(), text: text.to_owned() }))
    }

    fn words(text: &str) -> Vec<(Token, String, u32)> {
        let mut lexer = lexer(text);
        std::iter::from_fn(|| {
            let lexeme = lexer.next().expect("it is well-formed")?;
            Some((lexeme.token, lexer.word(lexeme).to_owned(), lexeme.line))
        })
        .collect()
    }

    #[test]
    fn tokens_stand_in_their_lines() {
        let found = words("# a comment \"[\r\nShape\"sphere\" \"float radius\"[1 .5]\n-1e3#x");
        let expected = [
            (Token::Word, "Shape", 2),
            (Token::Quoted, "\"sphere\"", 2),
            (Token::Quoted, "\"float radius\"", 2),
            (Token::Open, "[", 2),
            (Token::Word, "1", 2),
            (Token::Word, ".5", 2),
            (Token::Close, "]", 2),
            (Token::Word, "-1e3#x", 3),
        ];
        assert_eq!(found, expected.map(|(token, word, line)| (token, word.to_owned(), line)));
    }

    #[test]
    fn texts_are_taken_out_of_their_quotes() {
        let text = |written: &str| {
            let mut lexer = lexer(written);
            let lexeme = lexer.next()?.expect("a token");
            lexer.text(lexeme)
        };
        assert_eq!(text(r#""a \"b\" \\ c""#).unwrap(), r#"a "b" \ c"#);
        assert_eq!(text("\"\"").unwrap(), "");
        let error = text(r#""C:\models""#).unwrap_err();
        assert_eq!((error.line(), error.column()), (Some(1), Some(1)));
        for bad in ["\"", "\"a\nb\"", "\"a\\"] {
            let error = lexer(bad).next().unwrap_err();
            assert!(error.message().contains("quotes"), "{bad}: {error}");
        }
    }

    #[test]
    fn what_was_peeked_at_is_read_again() {
        let mut lexer = lexer("\n a b");
        let first = lexer.peek().unwrap().expect("a word");
        let again = lexer.next().unwrap().expect("a word");
        assert_eq!((lexer.word(first), lexer.word(again), again.line), ("a", "a", 2));
        assert_eq!(lexer.next().unwrap().map(|lexeme| lexer.word(lexeme).to_owned()), Some("b".to_owned()));
        assert!(lexer.next().unwrap().is_none());
    }
}
