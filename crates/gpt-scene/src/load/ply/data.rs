//! The numbers behind the header of a PLY file, in binary or in text.

use std::io::{self, BufRead, ErrorKind, Read as _};

use super::header::{Kind, Type};
use crate::load::mends::Mends;
use crate::load::spelling::lines::{Lines, first_word, trimmed};
use crate::load::spelling::numbers::number;

/// The source of numbers. `None` of what it reads means that the file ended; what is no number is not finite.
pub enum Data<'d> {
    Binary { reader: &'d mut dyn BufRead, big_endian: bool, failure: Option<io::Error> },
    Text(Text<'d>),
}

/// Words of a text.
pub struct Text<'t> {
    lines: Lines<'t>,
    /// Lines before the text.
    before: usize,
    layout: Layout,
    /// The line's number, the line, and what is left of it.
    line: (usize, &'t str, &'t str),
    /// Numbers of the element are missing, or what should be one is none.
    is_spoiled: bool,
}

/// How elements lie in lines. The specification wants a line for each; readers differ in whether they care.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Layout {
    /// There are as many lines as elements: numbers that a line has too many or too few are its own fault.
    Lines,
    /// More lines: an element may go on in the next one.
    Continued,
    /// Fewer lines: some have several elements.
    Words,
}

const BEHIND_AN_ELEMENT: &str = "what follows the numbers of an element is left out";

/// A line with numbers in it: not blank, and no comment.
fn has_data(line: &str) -> bool {
    let word = first_word(line).0;
    !(word.is_empty() || word.starts_with('#') || word.eq_ignore_ascii_case("comment") || word.eq_ignore_ascii_case("obj_info"))
}

impl<'t> Text<'t> {
    /// `elements`: how many there are said to be; None where that is not known.
    pub fn new(text: &'t str, before: usize, elements: Option<u64>) -> Self {
        let lines = Lines::new(text).filter(|(_, line)| has_data(line)).count() as u64;
        let layout = match elements.map_or(std::cmp::Ordering::Equal, |elements| lines.cmp(&elements)) {
            std::cmp::Ordering::Less => Layout::Words,
            std::cmp::Ordering::Equal => Layout::Lines,
            std::cmp::Ordering::Greater => Layout::Continued,
        };
        Self { lines: Lines::new(text), before, layout, line: (0, "", ""), is_spoiled: false }
    }

    /// Goes to the next line. False where there is none.
    fn next_line(&mut self) -> bool {
        match self.lines.find(|(_, line)| has_data(line)) {
            Some((number, line)) => {
                self.line = (number, line, line.trim_start_matches(crate::load::spelling::lines::is_blank));
                true
            }
            None => false,
        }
    }

    fn word(&mut self) -> Option<&'t str> {
        while self.line.2.is_empty() {
            if self.layout == Layout::Lines {
                self.is_spoiled = true;
                return Some("");
            }
            if !self.next_line() {
                return None;
            }
        }
        let (word, rest) = first_word(self.line.2);
        self.line.2 = rest;
        Some(word)
    }

    fn number(&mut self, mends: &mut Mends) -> Option<f64> {
        let word = self.word()?;
        let Some(number) = number::<f64>(word) else { return Some(f64::NAN) };
        if number.is_odd {
            self.mend(mends, "numbers in an odd spelling are read as what they most likely are");
        }
        Some(number.value)
    }

    fn mend(&self, mends: &mut Mends, what: &'static str) {
        mends.add(what, self.before + self.line.0, trimmed(self.line.1));
    }
}

impl Data<'_> {
    /// Goes to the next element. False where the file ends before it.
    pub fn begin(&mut self, mends: &mut Mends) -> bool {
        match self {
            Self::Binary { reader, failure, .. } => match reader.fill_buf() {
                Ok(bytes) => !bytes.is_empty(),
                Err(error) => {
                    *failure = Some(error);
                    false
                }
            },
            Self::Text(text) => {
                text.is_spoiled = false;
                if text.layout == Layout::Words {
                    return !text.line.2.is_empty() || text.next_line();
                }
                if !text.line.2.is_empty() {
                    text.mend(mends, BEHIND_AN_ELEMENT);
                }
                text.next_line()
            }
        }
    }

    /// Numbers of the element are missing.
    pub fn is_spoiled(&self) -> bool {
        matches!(self, Self::Text(text) if text.is_spoiled)
    }

    pub fn scalar(&mut self, of: Type, mends: &mut Mends) -> Option<f64> {
        match self {
            Self::Text(text) => text.number(mends),
            Self::Binary { reader, big_endian, failure } => {
                let mut bytes = [0; 8];
                let size = of.size();
                if let Err(error) = reader.read_exact(&mut bytes[..size]) {
                    if error.kind() != ErrorKind::UnexpectedEof {
                        *failure = Some(error);
                    }
                    return None;
                }
                if *big_endian {
                    bytes[..size].reverse();
                }
                Some(of.decode(bytes))
            }
        }
    }

    /// Reads a list into `into`, which then has nothing else.
    pub fn list(&mut self, count: Type, item: Type, into: &mut Vec<f64>, mends: &mut Mends) -> Option<()> {
        into.clear();
        let length = self.scalar(count, mends)?;
        if !(length >= 0.0 && length.fract() == 0.0) {
            // Nobody knows how many numbers follow.
            if let Self::Text(text) = self {
                text.is_spoiled = true;
                text.line.2 = "";
                return Some(());
            }
            return (length < 0.0).then_some(());
        }
        let mut left = length as u64;
        while left > 0 && !self.is_spoiled() {
            into.push(self.scalar(item, mends)?);
            left -= 1;
        }
        Some(())
    }

    /// Reads over a property.
    pub fn skip(&mut self, kind: Kind, mends: &mut Mends) -> Option<()> {
        match kind {
            Kind::Scalar(of) => self.scalar(of, mends).map(drop),
            Kind::List { count, item } => self.list(count, item, &mut Vec::new(), mends),
        }
    }

    /// Tells of what is mended in the element of this name and number, which count from 0.
    pub fn mend(&self, mends: &mut Mends, what: &'static str, element: &str, index: u64) {
        match self {
            Self::Text(text) => text.mend(mends, what),
            Self::Binary { .. } => mends.add_at(what, || format!("{element} {index}")),
        }
    }

    /// Tells of what stands behind the last element, and why reading failed.
    pub fn finish(self, mends: &mut Mends) -> io::Result<()> {
        let what = "what follows the last element is left out";
        match self {
            Self::Binary { failure: Some(error), .. } => return Err(error),
            Self::Binary { reader, .. } => {
                // A line end, or what fills a block up, is nothing.
                let more = reader.fill_buf().is_ok_and(|bytes| bytes.iter().any(|byte| !b"\0\n\r\t \x1a".contains(byte)));
                if more {
                    mends.add_at(what, String::new);
                }
            }
            Self::Text(mut text) => {
                if !text.line.2.is_empty() && text.layout != Layout::Words {
                    text.mend(mends, BEHIND_AN_ELEMENT);
                    text.line.2 = "";
                }
                if !text.line.2.is_empty() || text.next_line() {
                    text.mend(mends, what);
                }
            }
        }
        Ok(())
    }
}
